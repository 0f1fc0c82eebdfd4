# experiments: averaging
# Noise (variance) and |bias| with a fixed and with a shrinking radius, of single iterations above, of
# their average below; both relative to the exact radiance, so that they share an axis.
#   gnuplot -c paper-figures/averaging.gp RESULTS_DIR   reads curves.csv, writes figures/averaging.*
results = ARG1
if (results eq "") { print "usage: gnuplot -c averaging.gp RESULTS_DIR"; exit status 2 }
data = results."/curves.csv"
quoted(path) = "'".system("printf %s \"".path."\" | sed \"s/'/'\\\\\\\\''/g\"")."'"
radiance = 1 / pi**2 # on the axis of the quadratic beam: reflectance 0.5, irradiance 2/pi

# ---- inputs: gnuplot itself exits 0 when data are missing ----
header = system("head -n 1 ".quoted(data)." 2>/dev/null")
do for [name in "law quantity series first N measured lower upper predicted"] {
  if (!strstrt(",".header.",", ",".name.",")) {
    print data.": missing, or without a column ".name
    exit status 1
  }
}
if (system("mkdir -p ".quoted(results."/figures")." && echo made") ne "made") {
  print results."/figures: cannot make this directory"
  exit status 1
}

# ---- panels: a row for each series, a column for each law, two curves ----
kinds = "iteration average"
laws = "fixed knaus-zwicker"
titles = "'Fixed radius' 'Shrinking radius, α = 2/3'"
quantities = "variance bias"
number(row, c, q) = 4 * (row - 1) + 2 * (c - 1) + q
# Theory's powers of i and of N.
array power[8] = [0, 0, 1. / 3, -1. / 3, -1, 0, -2. / 3, -1. / 3]
powers = "'constant' 'constant' '∝i^{1/3}' '∝i^{−1/3}' '∝N^{−1}' 'constant' '∝N^{−2/3}' '∝N^{−1/3}'"

# ---- blocks: place on the axis, |measured|, lower, upper, |predicted|, last iteration ----
set datafile separator comma
set datafile columnheaders
block(row, c, q) = sprintf("$%s_%d_%d", word(kinds, row), c, q)
is_mine(row, c, q) = strcol("law") eq word(laws, c) && strcol("quantity") eq word(quantities, q) && \
  strcol("series") eq word(kinds, row)
unit(q) = q == 1 ? radiance**2 : radiance
relative(name, q) = abs(column(name)) / unit(q)
low(q) = (column("measured") < 0 ? -column("upper") : column("lower")) / unit(q)
high(q) = (column("measured") < 0 ? -column("lower") : column("upper")) / unit(q)
array end_x[8]; array end_y[8] # of the lines
keep_most(n) = (n_max = n > n_max ? n : n_max, n)
n_max = 1
do for [row = 1:2] { do for [c = 1:2] { do for [q = 1:2] {
  place(first, n) = row == 1 ? sqrt(first * n) : n
  eval "set table ".block(row, c, q)
  plot data using (place(column("first"), column("N"))):(relative("measured", q)):(low(q)):(high(q)):\
    (relative("predicted", q)):(keep_most(column("N"))) with table if (is_mine(row, c, q))
  unset table
  eval "lines = |".block(row, c, q)."|"
  if (lines == 0) {
    print sprintf("%s: no %s of %s, %s radius", data, word(quantities, q), word(kinds, row), word(laws, c))
    exit status 1
  }
  eval sprintf("last = %s[lines]", block(row, c, q))
  end_x[number(row, c, q)] = real(word(last, 1)); end_y[number(row, c, q)] = real(word(last, 5))
} } }
set datafile separator whitespace
unset datafile columnheaders

# ---- page, in inches ----
paper_x = 6.4; paper_y = 4.6
left = 0.62 / paper_x; right = 1 - 0.12 / paper_x; gap = 0.2 / paper_x
width = (right - left - gap) / 2
top(row) = 1 - (row == 1 ? 0.25 : 2.3) / paper_y
height = 1.55 / paper_y
colour(q) = word("#0072B2 #D55E00", q)
shape(q) = int(word("7 5", q))
set pointsize 0.42
set errorbars 0
set samples 2

do for [terminal_name in "pdf svg png"] {
  if (terminal_name eq "pdf") { set terminal pdfcairo enhanced font "Helvetica,8" size paper_x,paper_y }
  if (terminal_name eq "svg") { set terminal svg enhanced font "Helvetica,11" \
    size 140 * paper_x,140 * paper_y background "white" }
  if (terminal_name eq "png") { set terminal pngcairo enhanced font "Helvetica,8" \
    size 300 * paper_x,300 * paper_y fontscale 2.6 linewidth 2.6 pointscale 2.6 }
  set output results."/figures/averaging.".terminal_name
  set multiplot
  set logscale xy
  set xrange [0.8:n_max * 1.25]
  set format x "10^{%T}"
  set xtics scale 0.6, 0.3 nomirror
  set ytics scale 0.6, 0.3 nomirror
  set border 3 linewidth 0.6 linecolor "#444444"
  set grid xtics ytics linecolor "#DDDDDD" linewidth 0.4 linetype 1, linetype 1
  unset key
  do for [row = 1:2] { do for [c = 1:2] {
    set lmargin at screen left + (c - 1) * (width + gap)
    set rmargin at screen left + (c - 1) * (width + gap) + width
    set tmargin at screen top(row)
    set bmargin at screen top(row) - height
    set yrange [row == 1 ? 1e-3 : 1e-6:1]
    set format y c == 1 ? "10^{%T}" : ""
    if (row == 1) { set title word(titles, c) offset 0,-0.5 } else { unset title }
    if (row == 1) { set xlabel "iteration i" offset 0,0.5 } else { set xlabel "iterations N" offset 0,0.5 }
    if (c == 1) { set ylabel row == 1 ? "of one iteration" : "of the average" offset 0.6,0 } else { unset ylabel }
    plot \
      for [q = 1:2] [1:n_max] end_y[number(row, c, q)] * (x / end_x[number(row, c, q)])**power[number(row, c, q)] \
        with lines linewidth 0.7 dashtype 3 linecolor "#555555", \
      for [q = 1:2] block(row, c, q) using 1:5 with lines linewidth 0.9 linecolor rgb colour(q), \
      for [q = 1:2] block(row, c, q) using 1:2:3:4 with yerrorbars linewidth 0.6 pointtype shape(q) \
        linecolor rgb colour(q), \
      for [q = 1:2] block(row, c, q) using ($6 == 25 ? $1 : NaN):5:(word(powers, number(row, c, q))) \
        with labels offset 0.3,(number(row, c, q) == 3 ? -1.1 : 1.1) textcolor rgb colour(q)
  } }
  # ---- one legend ----
  set lmargin at screen left
  set rmargin at screen right
  set tmargin at screen 0.37 / paper_y
  set bmargin at screen 0.25 / paper_y
  unset logscale; unset border; unset xtics; unset ytics; unset xlabel; unset ylabel; unset title; unset grid
  set label 1 "points: measured over runs, 95 % intervals (above: means over bins of iterations; below: neighbours share most" \
    at screen 0.5,0.17 / paper_y center textcolor "#444444" font ",7"
  set label 2 "of their iterations, so that they stray together); lines: theory, nothing fitted; dotted: its power alone" \
    at screen 0.5,0.06 / paper_y center textcolor "#444444" font ",7"
  set key center center horizontal samplen 2.2 width 2
  plot [0:1] [0:1] \
    NaN with linespoints linewidth 0.9 pointtype shape(1) linecolor rgb colour(1) title "noise: variance / radiance²", \
    NaN with linespoints linewidth 0.9 pointtype shape(2) linecolor rgb colour(2) title "|bias| / radiance"
  unset label
  unset key
  unset multiplot
  set output
}
