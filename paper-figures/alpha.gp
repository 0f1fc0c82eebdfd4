# experiments: alpha
# Variance and |bias| of the average of N iterations against N, one curve an alpha. Points: measured
# over runs with 95 % intervals; lines: the predicted average (no slope is fitted to these points).
# Where theory has no closed form (the box) a line has theory's exponent and fitted constants.
# A bias below two standard errors is drawn hollow at its upper limit, with an arrow down.
#   gnuplot -c paper-figures/alpha.gp RESULTS_DIR     reads curves.csv, writes figures/alpha.*
scenes = "plane-uniform-beam plane-quadratic-beam plane-point-light cornell-box"
names = "'Uniform light' 'Quadratic light' 'Point light' 'Cornell box'"

# ---- inputs: gnuplot itself exits 0 when data are missing ----
if (ARGC != 1) { print "usage: gnuplot -c alpha.gp RESULTS_DIR"; exit status 2 }
data = ARG1."/curves.csv"
figures = ARG1."/figures"
quoted(path) = "'".system("printf %s \"".path."\" | sed \"s/'/'\\\\\\\\''/g\"")."'"
header = system("head -n 1 ".quoted(data)." 2>/dev/null")
wanted = "cell,scene,integrator,kernel,law,alpha,radius,photons,iterations,runs,seed,direct,depth,pixel,x,y,quantity,N,measured,lower,upper,pooled,predicted"
if (header ne wanted) {
  print data.": missing, or its columns are not ".wanted
  exit status 1
}
if (system("mkdir -p ".quoted(figures)." && echo made") ne "made") {
  print figures.": cannot make this directory"
  exit status 1
}

set datafile separator comma
set datafile columnheaders

# Each scene is shown at the first of its probes in the file; the alphas are those of the file.
probe = ""; alphas = ""; rows = ""; lines = ""; biased = ""; n_max = 1
alpha_text(a) = abs(a - 2./3) < 1e-9 ? "2/3" : sprintf("%g", a)
add_probe(s, x, y) = strstrt(probe, "|".s.":") ? 0 : (probe = probe."|".s.":".x.",".y."|", 1)
shown(s, x, y) = strstrt(probe, "|".s.":".x.",".y."|") > 0
add_alpha(a) = strstrt(alphas, " ".alpha_text(a)." ") ? 0 : (alphas = alphas." ".alpha_text(a)." ", 1)
row_name(s, q, a) = "|".s.":".q.":".a."|"
add_row(r) = !strstrt(rows, r) ? (rows = rows.r, 1) : 0
add_line(r, p) = p != p || strstrt(lines, r) ? 0 : (lines = lines.r, 1) # NaN is not itself
set xrange [-1:1]
set yrange [-1:1]
add_biased(s, q, p) = q eq "variance" || p == 0 || strstrt(biased, s) ? 0 : (biased = biased." ".s, 1)
set table $seen
plot data using (add_probe(strcol("scene"), strcol("x"), strcol("y")), \
  add_alpha(column("alpha")), !shown(strcol("scene"), strcol("x"), strcol("y")) ? 0 : \
    add_row(row_name(strcol("scene"), strcol("quantity"), alpha_text(column("alpha")))) + \
    add_line(row_name(strcol("scene"), strcol("quantity"), alpha_text(column("alpha"))), \
      column("predicted")), \
  add_biased(strcol("scene"), strcol("quantity"), column("predicted")), \
  n_max = column("N") > n_max ? column("N") : n_max, 0):(0) with points
unset table
if (words(alphas) == 0) { print data.": has no rows"; exit status 1 }
# A scene without any curve is an error; a curve the fit could not predict is named in its panel.
do for [scene in scenes] { do for [quantity in "variance bias"] {
  if (!strstrt(rows, "|".scene.":".quantity.":")) {
    print sprintf("%s: no %s of %s", data, quantity, scene)
    exit status 1
  }
} }
if (words(alphas) > 6) { print data.": more than 6 alphas; the palette has 6 colours"; exit status 1 }

# ---- the series of a panel: blocks $series1, ... of N, size, lower, upper, predicted, found ----
mine(s, a, q) = strcol("scene") eq s && strcol("quantity") eq q && \
  alpha_text(column("alpha")) eq a && shown(s, strcol("x"), strcol("y"))
# A variance is drawn as it stands, a bias by its size.
z = 1.959963984540054
error(q) = (column("upper") - column("lower")) / (2 * z)
found(q) = q eq "variance" || abs(column("measured")) >= 2 * error(q)
lower(q) = q eq "variance" ? column("lower") : abs(column("measured")) - z * error(q)
upper(q) = q eq "variance" ? column("upper") : abs(column("measured")) + z * error(q)
drawn(p) = p == 0 ? NaN : abs(p)
series(j) = "$series".j

# ---- looks: Okabe and Ito's colours; shapes differ too ----
colour(j) = word("#0072B2 #D55E00 #009E73 #CC79A7 #E69F00 #56B4E9", j)
full(j) = int(word("7 5 9 13 11 15", j))
hollow(j) = full(j) - 1
slope(a, q) = q eq "variance" ? -real(value_of(a)) : real(value_of(a)) - 1
value_of(a) = a eq "2/3" ? 2./3 : real(a)
slope_text(a, q) = a eq "2/3" ? (q eq "variance" ? "N^{−2/3}" : "N^{−1/3}") : \
  sprintf("N^{−%g}", q eq "variance" ? value_of(a) : 1 - value_of(a))

columns = words(scenes)
n_alphas = words(alphas)
left = 0.065; right = 0.955; gap = 0.075
width = (right - left - gap * (columns - 1)) / columns
set pointsize 0.42
set errorbars 0

do for [terminal_name in "pdf svg png"] {
  if (terminal_name eq "pdf") { set terminal pdfcairo enhanced font "Helvetica,8" size 7.4in,4.2in }
  if (terminal_name eq "svg") { set terminal svg enhanced font "Helvetica,11" size 1036,588 background "white" }
  if (terminal_name eq "png") { set terminal pngcairo enhanced font "Helvetica,8" size 2220,1260 \
    fontscale 2.6 linewidth 2.6 pointscale 2.6 }
  set output figures."/alpha.".terminal_name
  set multiplot
  set logscale xy
  set xrange [0.8:n_max * 1.25]
  set yrange [*:*]
  set format xy "10^{%T}"
  set xtics scale 0.6, 0.3 nomirror
  set ytics scale 0.6, 0.3 nomirror
  set border 3 linewidth 0.6 linecolor "#444444"
  set grid xtics ytics linecolor "#DDDDDD" linewidth 0.4 linetype 1, linetype 1
  unset key
  do for [row = 1:2] {
    quantity = word("variance bias", row)
    top = row == 1 ? 0.94 : 0.53
    do for [c = 1:columns] {
      scene = word(scenes, c)
      set lmargin at screen left + (c - 1) * (width + gap)
      set rmargin at screen left + (c - 1) * (width + gap) + width
      set tmargin at screen top
      set bmargin at screen top - 0.35
      if (row == 1) { set title word(names, c) offset 0,-0.4 } else { unset title }
      if (row == 2) { set xlabel "iterations N" offset 0,0.6 } else { unset xlabel }
      if (c == 1) {
        set ylabel row == 1 ? "variance of the average" : "|bias| of the average" offset 1.2,0
      } else { unset ylabel }
      here = ""; absent = ""; unresolved = ""
      do for [j = 1:n_alphas] {
        if (strstrt(rows, row_name(scene, quantity, word(alphas, j)))) {
          here = here." ".j
          if (!strstrt(lines, row_name(scene, quantity, word(alphas, j)))) {
            unresolved = unresolved." ".word(alphas, j)
          }
          eval "set table ".series(j)
          plot data using (column("N")):(abs(column("measured"))):(lower(quantity)):(upper(quantity)):\
            (drawn(column("predicted"))):(found(quantity)) \
            with table if (mine(scene, word(alphas, j), quantity))
          unset table
        } else { absent = absent." ".word(alphas, j) }
      }
      note = row == 2 && !strstrt(biased, scene) ? "predicted: no bias" : ""
      if (unresolved ne "") { note = "rate not resolved: α =".unresolved }
      if (absent ne "") { note = "not resolvable: α =".absent }
      set label 1 note at graph 0.05,0.07 left textcolor "#666666" font ",7"
      set datafile separator whitespace
      unset datafile columnheaders
      plot \
        for [j in here] series(j) using 1:5 with lines linewidth 0.9 linecolor rgb colour(int(j)), \
        for [j in here] series(j) using 1:($6 == 1 ? $2 : NaN):3:4 with yerrorbars linewidth 0.6 \
          pointtype full(int(j)) linecolor rgb colour(int(j)), \
        for [j in here] series(j) using 1:($6 == 1 ? NaN : $4):(0):(-0.35 * $4) with vectors \
          head size screen 0.003,25 filled linewidth 0.4 linecolor rgb colour(int(j)), \
        for [j in here] series(j) using 1:($6 == 1 ? NaN : $4) with points pointtype hollow(int(j)) \
          linewidth 0.6 linecolor rgb colour(int(j)), \
        for [j in here] series(j) using 1:($1 == n_max ? $5 : NaN):\
          (slope_text(word(alphas, int(j)), quantity)) with labels left offset 0.5,0 font ",7" \
          textcolor rgb colour(int(j))
      set datafile separator comma
      set datafile columnheaders
    }
  }
  # One legend for all panels.
  set lmargin at screen left
  set rmargin at screen right
  set tmargin at screen 0.09
  set bmargin at screen 0.04
  unset logscale; unset border; unset xtics; unset ytics; unset xlabel; unset ylabel; unset title; unset grid
  set label 1 "points: measured, 95 % intervals; hollow: |bias| < 2 SE, upper limit; lines: predicted (box: constants fitted)" \
    at screen 0.5,0.02 center textcolor "#444444" font ",7"
  set key center center horizontal samplen 2.2 width 2
  plot [0:1] [0:1] for [j = 1:n_alphas] NaN with linespoints linewidth 0.9 pointtype full(j) \
    linecolor rgb colour(j) title "α = ".word(alphas, j)
  unset label 1
  unset multiplot
  set output
}
