# experiments: parallel
# Time against threads: speed-up and efficiency of whole commands, an experiment's runs and two pictures.
#   gnuplot -c paper-figures/parallel.gp RESULTS_DIR   reads threads.csv, writes figures/parallel.*
results = ARG1
if (results eq "") { print "usage: gnuplot -c parallel.gp RESULTS_DIR"; exit status 2 }
data = results."/threads.csv"
quoted(path) = "'".system("printf %s \"".path."\" | sed \"s/'/'\\\\\\\\''/g\"")."'"
if (system("head -n 1 ".quoted(data)." 2>/dev/null") ne \
    "what,threads,repetition,wall_s,cpu_s,load,cores,cpu") {
  print data.": missing, or not as experiments/parallel.sh writes it"
  exit status 1
}
if (system("mkdir -p ".quoted(results."/figures")." && echo made") ne "made") {
  print results."/figures: cannot make this directory"
  exit status 1
}
kinds = "experiment probabilistic sppm"
titles = "'an experiment: runs side by side' 'a picture, probabilistic: iterations side by side' ".\
  "'a picture, sppm: one iteration after another'"
n_kinds = words(kinds)
field(name) = system("tail -n +2 ".quoted(data)." | cut -d, -f".name." | sort -nu")
counts = field("2"); most = int(word(counts, words(counts)))
repetitions = words(field("3"))
machine = system("tail -n 1 ".quoted(data)." | cut -d, -f8")
cores = int(word(field("7"), words(field("7"))))
loads = field("6")

# ---- medians over repetitions, least and most ----
set datafile separator comma
array wall1[n_kinds]; array least1[n_kinds]; array cpu1[n_kinds]
slowest = 1; fastest = 1; best = 1 # speed-ups; efficiency
do for [k = 1:n_kinds] {
  eval "set print $times_".k
  do for [n in counts] {
    rows = sprintf("< grep '^%s,%s,' %s", word(kinds, k), n, quoted(data))
    stats rows using 4 name "wall" nooutput
    stats rows using 5 name "cpu" nooutput
    if (wall_records != repetitions) {
      print sprintf("%s: %d repetitions of %s by %s threads, not %d", data, wall_records, \
        word(kinds, k), n, repetitions)
      exit status 1
    }
    if (n eq "1") { wall1[k] = wall_median; least1[k] = wall_min; cpu1[k] = cpu_median }
    low = wall1[k] / wall_max; high = wall1[k] / wall_min
    slowest = low < slowest ? low : slowest
    fastest = high > fastest ? high : fastest
    best = high / n > best ? high / n : best
    best = cpu1[k] / cpu_min > best ? cpu1[k] / cpu_min : best
    print sprintf("%s %.9g %.9g %.9g %.9g %.9g %.9g %.9g", n, wall1[k] / wall_median, low, high, \
      cpu1[k] / cpu_median, cpu1[k] / cpu_max, cpu1[k] / cpu_min, least1[k] / wall_min)
  }
  unset print
}
set datafile separator whitespace

colour(k) = word("#0072B2 #009E73 #D55E00", k)
full(k) = int(word("7 9 5", k))
paper_x = 5.2; paper_y = 3
beside(k) = 1 + 0.06 * (k - 2) * (most > 4 ? 1 : most / 8.) # so that bars do not cover each other
do for [terminal_name in "pdf svg png"] {
  if (terminal_name eq "pdf") { set terminal pdfcairo enhanced font "Helvetica,8" size paper_x,paper_y }
  if (terminal_name eq "svg") { set terminal svg enhanced font "Helvetica,11" \
    size 140 * paper_x,140 * paper_y background "white" }
  if (terminal_name eq "png") { set terminal pngcairo enhanced font "Helvetica,8" \
    size 300 * paper_x,300 * paper_y fontscale 2.6 linewidth 2.6 pointscale 2.6 }
  set output results."/figures/parallel.".terminal_name
  set pointsize 0.45
  set errorbars 0
  set multiplot
  set border 3 linewidth 0.6 linecolor "#444444"
  set grid ytics linecolor "#DDDDDD" linewidth 0.4 linetype 1
  set tics scale 0.6 nomirror
  set logscale x 2
  set xrange [0.85:most * 1.18]
  set xtics (1)
  do for [n in counts] { set xtics add (int(n)) }
  set tmargin at screen 0.92
  set bmargin at screen 0.44
  set key off
  set xlabel "threads" offset 0,0.5
  # ---- speed-up ----
  set lmargin at screen 0.09
  set rmargin at screen 0.47
  set title "speed-up of the wall clock" offset 0,-0.6
  set logscale y 2
  set yrange [slowest / 1.1:(fastest > most ? fastest : most) * 1.1]
  set ytics 2
  plot x linecolor "#888888" linewidth 0.8 dashtype 2, \
    for [k = 1:n_kinds] "$times_".k using ($1 * beside(k)):2:3:4 with yerrorbars linewidth 0.8 \
      pointtype full(k) linecolor rgb colour(k), \
    for [k = 1:n_kinds] "$times_".k using ($1 * beside(k)):2 with lines linewidth 0.8 linecolor rgb colour(k), \
    for [k = 1:n_kinds] "$times_".k using ($1 * beside(k)):8 with points pointtype 2 pointsize 0.6 linewidth 1.2 \
      linecolor rgb colour(k)
  # ---- efficiency ----
  unset logscale y
  set lmargin at screen 0.59
  set rmargin at screen 0.97
  set title "efficiency" offset 0,-0.6
  set yrange [0:best * 1.05]
  set ytics 0.2
  plot 1 linecolor "#888888" linewidth 0.8 dashtype 2, \
    for [k = 1:n_kinds] "$times_".k using ($1 * beside(k)):($2 / $1):($3 / $1):($4 / $1) with yerrorbars \
      linewidth 0.8 pointtype full(k) linecolor rgb colour(k), \
    for [k = 1:n_kinds] "$times_".k using ($1 * beside(k)):($2 / $1) with lines linewidth 0.8 \
      linecolor rgb colour(k), \
    for [k = 1:n_kinds] "$times_".k using ($1 * beside(k)):5:6:7 with yerrorbars \
      linewidth 0.6 pointtype full(k) - 1 linecolor rgb colour(k), \
    for [k = 1:n_kinds] "$times_".k using ($1 * beside(k)):5 with lines linewidth 0.6 dashtype 3 \
      linecolor rgb colour(k), \
    for [k = 1:n_kinds] "$times_".k using ($1 * beside(k)):($8 / $1) with points pointtype 2 pointsize 0.6 \
      linewidth 1.2 linecolor rgb colour(k)
  # ---- one legend ----
  unset logscale
  unset tics; unset xlabel; unset title; unset grid
  set border 0
  set lmargin at screen 0.05
  set rmargin at screen 0.95
  set tmargin at screen 0.35
  set bmargin at screen 0.16
  set key center center samplen 2.2 maxcols 1
  set label 1 sprintf("filled: wall clock, t_1 / t_n and t_1 / (n t_n), medians and ranges of %d interleaved repetitions;", \
    repetitions) at screen 0.5,0.135 center textcolor "#444444" font ",7"
  set label 2 "crosses: the same of the least times; hollow: CPU seconds of 1 thread / those of n; dashed: ideal" \
    at screen 0.5,0.085 center textcolor "#444444" font ",7"
  set label 3 sprintf("%s, %d core%s; load average before the measurements: %s to %s; ".\
    "log and images are the same bytes", machine, cores, cores == 1 ? "" : "s", word(loads, 1), \
    word(loads, words(loads))) at screen 0.5,0.035 center textcolor "#444444" font ",7" noenhanced
  plot [0:1] [0:1] for [k = 1:n_kinds] NaN with linespoints linewidth 0.8 pointtype full(k) \
    linecolor rgb colour(k) title word(titles, k)
  unset label
  unset multiplot
  set output
}
