# experiments: kernels
# The same photons through every kernel. Above: variance and |bias| of the average times theory's power
# of N, so that a rate is a level and a constant its height, and the constants, measured against theory.
# Below: images of one iteration at equal radius and at equal variance, their errors, and what is left of
# the constants at equal variance.
#   gnuplot -c paper-figures/kernels.gp RESULTS_DIR   reads manifest.json, curves.csv, fit.json and
#   images/*.csv, writes figures/kernels.*
results = ARG1
figure = "kernels"
load system("dirname \"".ARG0."\"")."/pictures.part.gp"
analytic = "scene:plane-quadratic-beam "
pictures = "scene:cornell-box integrator:probabilistic "
radiance = 1 / pi**2 # on the axis of the quadratic beam: reflectance 0.5, irradiance 2/pi

# ---- which kernels; of two cells with one kernel the first has the box's radius, the last its variance ----
kernels = found(system("cat ".here."/manifest.json 2>/dev/null | awk '/\"kernel\":/ { gsub(/[\",]/, \"\"); ".\
  "if (!seen[$2]++) print $2 }'"), "kernel")
eval check
n = words(kernels)
array equal_radius[n]; array equal_variance[n]; array radius_image[n]; array variance_image[n]
do for [k = 1:n] {
  list = cells(analytic."kernel:".word(kernels, k))
  equal_radius[k] = int(word(list, 1)); equal_variance[k] = int(last(list))
}
eval check

# ---- constants of fit.json: theory's, measured, standard error; as ratios to theory's of the box ----
constants(c, quantity) = found(system(sprintf("cat %s/fit.json 2>/dev/null | awk '{ gsub(/[\",]/, \"\") } ".\
  "$1 == \"cell:\" { cell = $2 } $1 == \"quantity:\" { quantity = $2 } ".\
  "$1 ~ /^coefficient/ { values = values \" \" $2 } ".\
  "$1 == \"coefficient_se:\" { if (cell == \"%d\" && quantity == \"%s\") print values; values = \"\" }'", \
  here, c, quantity)), sprintf("%s of cell %d in fit.json", quantity, c))
array theory[4 * n]; array measured[4 * n]; array half[4 * n]
at(k, quantity, equal) = 2 * n * equal + n * quantity + k # quantity 1: bias; equal 1: variance
do for [equal = 0:1] { do for [quantity = 0:1] { do for [k = 1:n] {
  values = constants(equal ? equal_variance[k] : equal_radius[k], quantity ? "bias" : "variance")
  eval check
  if (k == 1) { box = real(word(values, 1)) }
  m = at(k, quantity, equal)
  theory[m] = word(values, 1) / box; measured[m] = word(values, 2) / box
  half[m] = 1.959963984540054 * word(values, 3) / abs(box)
} } }

# ---- averages at equal radius: blocks of N, measured, lower, upper, predicted, times theory's power ----
set datafile separator comma
header = system("head -n 1 ".here."/curves.csv 2>/dev/null")
if (!strstrt(header, ",quantity,series,first,N,measured,lower,upper,pooled,predicted")) {
  print results."/curves.csv: missing, or without the columns this figure needs"
  exit status 1
}
set datafile columnheaders
curves = results."/curves.csv"
curve_block(quantity, k) = sprintf("$curve_%d_%d", quantity, k)
is_mine(k, quantity) = column("cell") == equal_radius[k] && strcol("series") eq "average" && \
  strcol("quantity") eq (quantity ? "bias" : "variance")
flat(x, quantity) = quantity ? x * column("N")**(1. / 3) / radiance : x * column("N")**(2. / 3) / radiance**2
low(quantity) = flat(column("measured") < 0 ? -column("upper") : column("lower"), quantity)
high(quantity) = flat(column("measured") < 0 ? -column("lower") : column("upper"), quantity)
do for [k = 1:n] { do for [quantity = 0:1] {
  eval "set table ".curve_block(quantity, k)
  plot curves using (column("N")):(flat(abs(column("measured")), quantity)):(low(quantity)):(high(quantity)):\
    (flat(abs(column("predicted")), quantity)) with table if (is_mine(k, quantity))
  unset table
  eval "lines = |".curve_block(quantity, k)."|"
  if (lines == 0) { missing = "averages in curves.csv of ".word(kernels, k) }
} }
unset datafile columnheaders
eval check

# ---- errors of pictures: blocks of N and relative error ----
path = cells("scene:cornell-box integrator:path")
eval check
one = image(int(word(path, 1)), last(averages(int(word(path, 1)))))
other = image(int(last(path)), last(averages(int(last(path)))))
eval check
eval sizes(one)
error_block(equal, k) = sprintf("$error_%d_%d", equal, k)
do for [k = 1:n] {
  list = cells(pictures."kernel:".word(kernels, k))
  eval check
  do for [equal = 0:1] {
    c = int(equal ? last(list) : word(list, 1))
    ns = averages(c)
    eval check
    if (equal) { variance_image[k] = image(c, word(ns, 1)) } else { radius_image[k] = image(c, word(ns, 1)) }
    eval "set print ".error_block(equal, k)
    do for [m in ns] {
      eval compare(image(c, m), one, other)
      print sprintf("%s %.9g", m, root(mean_square) / mean)
    }
    unset print
  }
}
n_most = real(last(ns))
set datafile separator whitespace

# ---- the page ----
paper_x = 7.2; paper_y = 6.75
tint(k) = word("#0072B2 #E69F00 #009E73 #CC79A7 #56B4E9 #D55E00 #000000 #999999", (k - 1) % 8 + 1)
form(k) = int(word("7 5 9 13 11 15 4 6", (k - 1) % 8 + 1))
side = (paper_x - 0.42 - 0.05 * n) / (n + 1)
left(column) = 0.36 + (side + 0.05) * (column - 1)
panel_w = 1.65
panel(column) = 0.55 + 2.4 * (column - 1)
top = 0.28; first_row = 2.42; second_row = first_row + side + 0.06; bottom = second_row + side + 0.4

do for [name in terminals] {
  eval terminal(name)
  set pointsize 0.4
  set errorbars 0
  # ---- variance and bias ----
  eval axes
  set xtics autofreq
  unset key
  set logscale xy
  set format x "10^{%T}"
  set xlabel "iterations N" offset 0,0.5
  do for [quantity = 0:1] {
    eval place(panel(quantity + 1), top, panel_w, 1.5)
    set xrange [0.8:1250]
    set yrange [quantity ? 0.06 : 0.0008:quantity ? 0.4 : 0.012]
    set format y "%g"
    set ytics (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.4)
    set title (quantity ? "|bias|" : "variance")." of the average, equal radius" offset 0,-0.7
    set ylabel (quantity ? "× N^{1/3} / radiance" : "× N^{2/3} / radiance²") offset 0.6,0
    plot for [k = 1:n] curve_block(quantity, k) using 1:5 with lines linewidth 0.9 linecolor rgb tint(k), \
      for [k = 1:n] curve_block(quantity, k) using 1:2:3:4 with yerrorbars linewidth 0.5 pointtype form(k) \
        linecolor rgb tint(k)
  }
  # ---- constants at equal radius ----
  eval place(panel(3), top, panel_w, 1.5)
  set xrange [0.9:2.7]
  set yrange [0.36:1.12]
  set format x "%g"
  set xtics (1, 1.5, 2, 2.5)
  set ytics (0.4, 0.6, 0.8, 1)
  set title "constants at equal radius" offset 0,-0.7
  set xlabel "R / R_{box}, from the variance" offset 0,0.5
  set ylabel "μ_2 / μ_{2,box}, from the bias" offset 0.6,0
  set label 2 "box of smaller radius" at 1.62,0.655 rotate by -37 center textcolor "#666666" font ",7"
  plot [x = 1:2.7] 1 / x with lines linewidth 0.7 dashtype 3 linecolor "#555555", \
    for [k = 1:n] "+" using (measured[at(k, 0, 0)]):(measured[at(k, 1, 0)]):(half[at(k, 0, 0)]):\
      (half[at(k, 1, 0)]) every ::0::0 with xyerrorbars linewidth 0.7 pointtype form(k) linecolor rgb tint(k), \
    for [k = 1:n] "+" using (theory[at(k, 0, 0)]):(theory[at(k, 1, 0)]) every ::0::0 with points \
      pointtype 6 pointsize 0.9 linewidth 0.6 linecolor "#000000"
  unset label 2
  # ---- pictures ----
  eval bare
  eval whole
  eval expose_mean
  set datafile separator comma
  do for [equal = 0:1] {
    do for [k = 1:n] {
      eval place(left(k), equal ? second_row : first_row, side, side)
      if (equal) { unset title } else { set title word(kernels, k) offset 0,-0.8 }
      if (k == 1) {
        set label 1 (equal ? "equal variance" : "equal radius") at graph -0.08,0.5 center rotate by 90
      }
      eval draw(equal ? variance_image[k] : radius_image[k])
    }
  }
  eval place(left(n + 1), first_row, side, side)
  set title "path tracing" offset 0,-0.8
  set label 2 "R: integral of ψ²\nμ_2: second moment\nequal variance:\nradius × (R / R_{box})^{1/2}" \
    at graph 0,-0.25 left font ",7"
  eval draw(one)
  unset label 2
  set datafile separator whitespace
  # ---- errors of pictures ----
  eval axes
  set xtics autofreq
  set logscale xy
  set xrange [0.8:1.25 * n_most]
  set yrange [0.035:0.2]
  set format x "10^{%T}"
  set format y "%g"
  set ytics (0.02, 0.05, 0.1, 0.2)
  set xlabel "iterations N" offset 0,0.5
  do for [equal = 0:1] {
    eval place(panel(equal + 1), bottom, panel_w, 1.5)
    set title "error of pictures, equal ".(equal ? "variance" : "radius") offset 0,-0.7
    set ylabel "relative RMSE" offset 0.6,0
    plot for [k = 1:n] error_block(equal, k) using 1:2 with linespoints linewidth 0.7 pointtype form(k) \
      linecolor rgb tint(k)
  }
  # ---- constants at equal variance ----
  eval place(panel(3), bottom, panel_w, 1.5)
  unset logscale
  set xrange [0.85:1.03]
  set yrange [n + 0.6:0.4]
  set format x "%g"
  set xtics 0.05
  set ytics scale 0 ("" 1)
  do for [k = 1:n] { eval sprintf("set ytics add ('%s' %d)", word(kernels, k), k) }
  set title "constants at equal variance" offset 0,-0.7
  set xlabel "R μ_2 / (R μ_2)_{box}, from the bias" offset 0,0.5
  unset ylabel
  plot for [k = 1:n] "+" using (measured[at(k, 1, 1)]):(k):(half[at(k, 1, 1)]) every ::0::0 with xerrorbars \
      linewidth 0.7 pointtype form(k) linecolor rgb tint(k), \
    for [k = 1:n] "+" using (theory[at(k, 1, 1)]):(k) every ::0::0 with points \
      pointtype 6 pointsize 0.9 linewidth 0.6 linecolor "#000000"
  # ---- one legend ----
  eval bare
  eval place(0.3, paper_y - 0.42, paper_x - 0.6, 0.2)
  set key center center horizontal samplen 1.5 width 1
  set label 1 "points: measured, 95 % intervals; lines and black circles: theory, nothing fitted; pictures: one iteration" \
    at screen 0.5,0.09 / paper_y center textcolor "#444444" font ",7"
  plot [0:1] [0:1] for [k = 1:n] NaN with linespoints linewidth 0.9 pointtype form(k) linecolor rgb tint(k) \
    title word(kernels, k)
  unset label
  unset key
  eval finish
}
