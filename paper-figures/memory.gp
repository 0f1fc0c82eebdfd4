# experiments: memory
# Bytes of photons held and the error against the photons emitted in all, and against each other: photon
# maps of one iteration, and the progressive methods.
#   gnuplot -c paper-figures/memory.gp RESULTS_DIR   reads timing.csv, images/*.csv, writes figures/memory.*
results = ARG1
if (results eq "") { print "usage: gnuplot -c memory.gp RESULTS_DIR"; exit status 2 }
quoted(path) = "'".system("printf %s \"".path."\" | sed \"s/'/'\\\\\\\\''/g\"")."'"

# ---- one line a row of timing.csv; every group is one cell, with an image at each of its rows ----
columns = "group scene integrator photons iterations photon_bytes"
rows = system("awk -F, -v names='".columns."' ' \
  NR == 1 { n = split(names, name, \" \"); for (k = 1; k <= NF; k++) at[$k] = k; next } \
  { for (k = 1; k <= n; k++) printf \"%s%s\", $at[name[k]], k < n ? \",\" : \" \" }' ".quoted(results."/timing.csv"))
field(row, k) = system(sprintf("echo '%s' | cut -d, -f%d", row, k))
image(row) = sprintf("%s/images/%s-cell%03d-%s.csv", results, field(row, 2), int(field(row, 1)), field(row, 5))
truths = ""
do for [row in rows] { if (field(row, 3) eq "path") { truths = truths." ".quoted(image(row)) } }
if (words(truths) != 2) { print results."/timing.csv: not two path tracings, but ".words(truths); exit status 1 }
if (system("mkdir -p ".quoted(results."/figures")." && echo made") ne "made") {
  print results."/figures: cannot make this directory"
  exit status 1
}

# ---- series: an integrator with so many photons an iteration, the map with all it has ----
series = "photonmap ppm:1000 sppm:1000 probabilistic:1000 ppm:16000 sppm:16000 probabilistic:16000"
n_series = words(series)
array points[n_series]
least = 1; largest = 0; most = 0
do for [s = 1:n_series] { points[s] = "" }
set datafile separator comma
do for [row in rows] { if (field(row, 3) ne "path") {
  name = field(row, 3) eq "photonmap" ? "photonmap" : field(row, 3).":".field(row, 4)
  # The scene is gray: one channel is all. The noise of the two truths has nothing in common.
  both = sprintf("< paste -d, %s %s", quoted(image(row)), truths)
  stats both skip 1 using (($4 - $9) * ($4 - $14)) name "square" nooutput
  stats both skip 1 using (0.5 * ($9 + $14)) name "truth" nooutput
  if (!exists("square_records")) { print image(row).", or path tracing: is not there"; exit status 1 }
  error = square_mean > 0 ? sprintf("%.9g", sqrt(square_mean) / truth_mean) : "NaN"
  emitted = real(field(row, 4)) * real(field(row, 5))
  most = emitted > most ? emitted : most
  if (square_mean > 0) {
    least = real(error) < least ? real(error) : least
    largest = real(error) > largest ? real(error) : largest
  }
  do for [s = 1:n_series] { if (word(series, s) eq name) {
    points[s] = points[s].sprintf("%.9g %s %s\n", emitted, field(row, 6), error)
  } }
} }
set datafile separator whitespace
do for [s = 1:n_series] {
  if (points[s] eq "") { print results."/timing.csv: nothing of ".word(series, s); exit status 1 }
  eval sprintf("set print $series_%d", s)
  print points[s]
  unset print
}

colour(s) = word("#000000 #D55E00 #009E73 #0072B2", s > 4 ? s - 3 : s)
shape(s) = int(word("7 5 9 13 4 8 12", s))
aside(s) = word("1 0.86 1 1.16", s > 4 ? s - 3 : s) + 0. # the three hold the same
paper_x = 7.2; paper_y = 2.6
do for [terminal_name in "pdf svg png"] {
  if (terminal_name eq "pdf") { set terminal pdfcairo enhanced font "Helvetica,8" size paper_x,paper_y }
  if (terminal_name eq "svg") { set terminal svg enhanced font "Helvetica,11" \
    size 140 * paper_x,140 * paper_y background "white" }
  if (terminal_name eq "png") { set terminal pngcairo enhanced font "Helvetica,8" \
    size 300 * paper_x,300 * paper_y fontscale 2.6 linewidth 2.6 pointscale 2.6 }
  set output results."/figures/memory.".terminal_name
  set pointsize 0.5
  set multiplot
  set border 3 linewidth 0.6 linecolor "#444444"
  set grid xtics ytics linecolor "#DDDDDD" linewidth 0.4 linetype 1, linetype 1
  set tics scale 0.6,0.3 nomirror
  set logscale xy
  set tmargin at screen 0.9
  set bmargin at screen 0.38
  set key off
  do for [panel = 1:3] {
    set lmargin at screen (0.5 + 2.37 * (panel - 1)) / paper_x
    set rmargin at screen (0.5 + 2.37 * (panel - 1) + 1.88) / paper_x
    set title panel == 1 ? "photons held at once [bytes]" : "relative error of the picture" offset 0,-0.6
    set xlabel panel == 3 ? "photons held at once [bytes]" : "photons emitted in all" offset 0,0.5
    if (panel == 1) { set yrange [5e4:5e8]; set format y "10^{%T}"; set ytics auto }
    if (panel > 1) {
      set yrange [least / 1.25:largest * 1.25]
      set format y "%g"
      set ytics (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2)
    }
    set xtics auto
    if (panel == 3) { set xrange [5e4:5e8]; set format x "10^{%T}"
    } else { set xrange [500:3 * most]; set format x "10^{%T}" }
    plot for [s = n_series:1:-1] sprintf("$series_%d", s) using \
      ((panel < 3 ? $1 : $2) * (panel == 2 ? 1 : aside(s))):(panel == 1 ? $2 : $3) with linespoints linewidth 0.9 \
      pointtype shape(s) linecolor rgb colour(s)
  }
  # ---- one legend ----
  unset logscale
  unset tics; unset xlabel; unset title; unset grid
  set border 0
  set lmargin at screen 0.02
  set rmargin at screen 0.94
  set tmargin at screen 0.26
  set bmargin at screen 0.12
  set xrange [0:1]
  set yrange [0:1]
  set key center center samplen 2 maxrows 2 width -1
  set label 1 "error: root mean square over pixels against path tracing, by the mean; bytes: ".\
    "photons and the grids that find them," at screen 0.5,0.085 center textcolor "#444444" font ",7"
  set label 2 "of which ppm and sppm have one for each factor of two in radius; symbols that would ".\
    "cover each other stand side by side" at screen 0.5,0.035 center textcolor "#444444" font ",7"
  entry(s) = s == 1 ? "one map of all photons" : s == 0 ? " " : \
    system(sprintf("echo %s an iteration | sed 's/:/, /'", word(series, s)))
  plot for [s in "1 0 2 5 3 6 4 7"] NaN with linespoints linewidth 0.9 pointtype (s > 0 ? shape(int(s)) : -2) \
    linecolor rgb (s > 0 ? colour(int(s)) : "#FFFFFF") title entry(int(s))
  unset label
  unset multiplot
  set output
}
