# experiments: reference-radius
# A row for each scene: path tracing, the average of the most iterations with each reference radius, and
# its relative error (root mean square over pixels, by the mean of path tracing) against N.
#   gnuplot -c paper-figures/reference-radius.gp RESULTS_DIR   reads images/*.csv, writes
#   figures/reference-radius.*
results = ARG1
if (results eq "") { print "usage: gnuplot -c reference-radius.gp RESULTS_DIR"; exit status 2 }
scenes = "box cornell-box torus"
titles = "'Long box' 'Cornell box' 'Metal ring'"
kinds = "global knn ray-differentials"
kind_titles = "'global' 'k nearest photons' 'ray differentials'"
n_kinds = 3
quoted(path) = "'".system("printf %s \"".path."\" | sed \"s/'/'\\\\\\\\''/g\"")."'"
# Cells in the order of the experiment: kinds, then path; scenes within each.
cell(kind, scene) = 3 * (kind - 1) + scene - 1
name(kind, scene, n) = sprintf("%s/images/%s-cell%03d-%s.csv", results, word(scenes, scene), \
  cell(kind, scene), n)
counts(kind, scene) = system(sprintf("cd %s/images && ls %s-cell%03d-*.csv | sed 's/.*-//; s/.csv//' | sort -n", \
  quoted(results), word(scenes, scene), cell(kind, scene)))
last(text) = word(text, words(text))

# ---- errors: gnuplot itself exits 0 when data are missing ----
set datafile separator comma
array mean[3]
array truth[3]
array most[3]
do for [s = 1:3] {
  of_path = counts(4, s)
  if (words(of_path) < 1) { print results."/images: no path tracing of ".word(scenes, s); exit status 1 }
  truth[s] = name(4, s, last(of_path))
  stats truth[s] skip 1 using 4 nooutput
  mean[s] = STATS_mean
  do for [k = 1:n_kinds] {
    ns = counts(k, s)
    if (words(ns) < 1) { print results."/images: nothing of ".word(scenes, s).", ".word(kinds, k); exit status 1 }
    most[s] = last(ns)
    block = sprintf("$error_%d_%d", s, k)
    eval "set print ".block
    do for [n in ns] {
      pair = sprintf("< paste -d, %s %s", quoted(name(k, s, n)), quoted(truth[s]))
      stats pair skip 1 using (($4 - $9)**2) nooutput
      print sprintf("%s,%.9g", n, sqrt(STATS_mean) / mean[s])
    }
    unset print
  }
}
stats truth[1] skip 1 using 1 nooutput
width = STATS_max + 1

# Mean radiance is shown as a third; sRGB's curve.
curve(c) = c <= 0.0031308 ? 12.92 * c : 1.055 * c**(1 / 2.4) - 0.055
shown(c, s) = 255 * curve(c / mean[s] / 3 > 1 ? 1 : c / mean[s] / 3)

if (system("mkdir -p ".quoted(results."/figures")." && echo made") ne "made") {
  print results."/figures: cannot make this directory"
  exit status 1
}
paper_x = 7.2; paper_y = 4.65
side_x = 1.3 / paper_x; side_y = 1.3 / paper_y
left(column) = (0.22 + 1.36 * (column - 1)) / paper_x
top(row) = 1 - (0.25 + 1.36 * (row - 1)) / paper_y
colour(k) = word("#0072B2 #D55E00 #009E73", k)
shape(k) = int(word("7 5 9", k))

do for [terminal_name in "pdf svg png"] {
  if (terminal_name eq "pdf") { set terminal pdfcairo enhanced font "Helvetica,8" size paper_x,paper_y }
  if (terminal_name eq "svg") { set terminal svg enhanced font "Helvetica,11" \
    size 140 * paper_x,140 * paper_y background "white" }
  if (terminal_name eq "png") { set terminal pngcairo enhanced font "Helvetica,8" \
    size 300 * paper_x,300 * paper_y fontscale 2.6 linewidth 2.6 pointscale 2.6 }
  set output results."/figures/reference-radius.".terminal_name
  set pointsize 0.4
  set multiplot
  do for [s = 1:3] {
    set tmargin at screen top(s)
    set bmargin at screen top(s) - side_y
    # ---- pictures ----
    unset logscale
    set yrange [-0.5:width - 0.5]
    unset key
    unset xlabel
    unset ylabel
    unset tics
    set border 0
    set size noratio
    set xrange [-0.5:width - 0.5]
    set yrange [-0.5:width - 0.5]
    do for [column = 1:n_kinds + 1] {
      set lmargin at screen left(column)
      set rmargin at screen left(column) + side_x
      if (s == 1) {
        set title (column == 1 ? "path tracing" : word(kind_titles, column - 1)) offset 0,-0.8
      } else { unset title }
      if (column == 1) { set label 1 word(titles, s) at graph -0.06,0.5 center rotate by 90
      } else { unset label 1 }
      picture = column == 1 ? truth[s] : name(column - 1, s, most[s])
      plot picture skip 1 using 1:(width - 1 - $2):(shown($3, s)):(shown($4, s)):(shown($5, s)) with rgbimage
    }
    unset label 1
    # ---- error ----
    set lmargin at screen left(n_kinds + 2) + 0.3 / paper_x
    set rmargin at screen left(n_kinds + 2) + 0.3 / paper_x + side_x * 0.83
    set bmargin at screen top(s) - side_y + 0.02 / paper_y
    set border 3 linewidth 0.6 linecolor "#444444"
    set xrange [0.8:1.25 * most[s]]
    set yrange [*:*] noextend
    set logscale xy
    set xtics 1,10 scale 0.6,0.3 nomirror
    set ytics (0.02, 0.05, 0.1, 0.2, 0.5, 1, 2) scale 0.6 nomirror
    set format x (s == 3 ? "10^{%T}" : "")
    set format y "%g"
    set offsets 0,0,graph 0.05,graph 0.05
    set grid xtics ytics linecolor "#DDDDDD" linewidth 0.4 linetype 1, linetype 1
    if (s == 1) { set title "relative error" offset 0,-0.8 } else { unset title }
    if (s == 3) { set xlabel "iterations N" offset 0,0.7 } else { unset xlabel }
    plot for [k = 1:n_kinds] sprintf("$error_%d_%d", s, k) using 1:2 with linespoints \
      linewidth 0.9 pointtype shape(k) linecolor rgb colour(k)
    unset grid
    unset offsets
  }
  # ---- one legend ----
  set lmargin at screen 0.1
  set rmargin at screen 0.9
  set tmargin at screen 0.06
  set bmargin at screen 0.005
  unset logscale
  unset tics
  unset xlabel
  set border 0
  set key center center horizontal samplen 2 width 2
  plot [0:1] [0:1] for [k = 1:n_kinds] NaN with linespoints linewidth 0.9 pointtype shape(k) \
    linecolor rgb colour(k) title word(kind_titles, k)
  unset key
  unset multiplot
  set output
}
