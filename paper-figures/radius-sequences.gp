# experiments: radius-sequences
# Radii of local statistics against the closed forms (above), the error of the average under each law
# (middle), and points of a picture with their discs after 1, 2, 10 and 100 passes (below).
#   gnuplot -c paper-figures/radius-sequences.gp RESULTS_DIR   reads radii.csv, curves.csv, discs/*.csv
#   and images/*.csv, writes figures/radius-sequences.*
results = ARG1
if (results eq "") { print "usage: gnuplot -c radius-sequences.gp RESULTS_DIR"; exit status 2 }
radii = results."/radii.csv"
curves = results."/curves.csv"
quoted(path) = "'".system("printf %s \"".path."\" | sed \"s/'/'\\\\\\\\''/g\"")."'"
cell_name = system("cd ".quoted(results)." && ls discs/cornell-box-cell*-1.csv 2>/dev/null | sed 's/.*cell//; s/-.*//'")
discs(i) = sprintf("%s/discs/cornell-box-cell%s-%d.csv", results, cell_name, i)
picture = sprintf("%s/images/cornell-box-cell%s-100.csv", results, cell_name)

# ---- errors: gnuplot itself exits 0 when data are missing ----
missing(path) = system("test -s ".quoted(path)." || echo missing") ne ""
passes = "1 2 10 100"
do for [path in sprintf("'%s' '%s' '%s'", radii, curves, picture)] {
  if (missing(path)) { print path.": missing (photonlab run, fit, plot)"; exit status 1 }
}
do for [i in passes] { if (missing(discs(int(i)))) { print discs(int(i)).": missing"; exit status 1 } }

set datafile separator comma
set datafile columnheaders

# ---- what rows are shown: of a scene, a law, an alpha, and photons in the first disc ----
two_thirds = 2. / 3
near(a, b) = abs(a / b - 1) < 1e-3
of(scene, law, alpha) = strcol("scene") eq scene && strcol("law") eq law && near(column("alpha"), alpha)
uniform(law, photons) = of("plane-uniform-beam", law, two_thirds) && near(column("first_disc"), photons)
point_light(alpha) = of("plane-point-light", "hachisuka", alpha)
z = 1.959963984540054
# Rows as blocks: i, measured mean, half of its 95 % interval, expected (all / rho), then r / r_1, its
# deviation over runs.
to_block = "using (column('i')):(column('mean') / column('rho') - 1):\
(z * column('sd') / sqrt(column('runs')) / column('rho')):(column('expected') / column('rho') - 1):\
(sqrt(column('mean'))):(column('sd') / sqrt(column('mean')) / 2) with table if"
lambdas = "1 3 10 100"
laws = "hachisuka pbrt"
alphas = "0.5 0.6666666666666667 0.8"
do for [l = 1:2] { do for [k = 1:4] {
  eval sprintf("set table $uniform_%d_%d", l, k)
  eval sprintf("plot radii %s (uniform('%s', %s))", to_block, word(laws, l), word(lambdas, k))
  unset table
} }
do for [k = 1:3] {
  eval sprintf("set table $point_%d", k)
  eval sprintf("plot radii %s (point_light(%s))", to_block, word(alphas, k))
  unset table
}
# Of the average: N, size, half of its interval, prediction, runs.
error_laws = "hachisuka pbrt knaus-zwicker power"
is_curve(law, quantity) = of("plane-quadratic-beam", law, two_thirds) && \
  strcol("quantity") eq quantity && strcol("series") eq "average"
do for [l = 1:4] { do for [quantity in "variance bias"] {
  eval sprintf("set table $%s_%d", quantity, l)
  eval sprintf("plot curves using (column('N')):(abs(column('measured'))):\
((column('upper') - column('lower')) / 2):(abs(column('predicted'))):(column('runs')) with table if \
(is_curve('%s', '%s'))", word(error_laws, l), quantity)
  unset table
  eval sprintf("filled = |$%s_%d|", quantity, l)
  if (filled < 10) { print curves.": no ".quantity." of ".word(error_laws, l); exit status 1 }
} }
do for [l = 1:2] { do for [k = 1:4] {
  eval sprintf("filled = |$uniform_%d_%d|", l, k)
  if (filled < 10) { print radii.": no ".word(laws, l)." of ".word(lambdas, k)." photons"; exit status 1 }
} }
do for [k = 1:3] {
  eval sprintf("filled = |$point_%d|", k)
  if (filled < 10) { print radii.": no plane-point-light at alpha ".word(alphas, k); exit status 1 }
}
# Root of variance and squared bias; the square of a measured bias holds variance / runs.
rmse(v, b) = sqrt(v + b**2)
rmse_half(v, dv, b, db) = sqrt(dv**2 + (2 * b * db)**2) / (2 * rmse(v, b))
item(line, k) = real(word(line, k))
rmse_row(v, b) = sprintf("%s %.9g %.9g %.9g", word(v, 1), \
  rmse(item(v, 2) * (1 - 1 / item(v, 5)), item(b, 2)), \
  rmse_half(item(v, 2), item(v, 3), item(b, 2), item(b, 3)), rmse(item(v, 4), item(b, 4)))
do for [l = 1:4] {
  eval sprintf("set print $rmse_%d", l)
  eval sprintf("do for [j = 1:|$variance_%d|] { print rmse_row($variance_%d[j], $bias_%d[j]) }", l, l, l)
  unset print
}
unset datafile columnheaders
stats picture skip 1 using 4 nooutput
mean_green = STATS_mean
stats picture skip 1 using 1 nooutput
pixels = STATS_max + 1

# ---- theory ----
rho(i) = gamma(i + two_thirds) / (gamma(1 + two_thirds) * gamma(i + 1)) # for i < 150
rho_far(i) = (i + two_thirds / 2)**(two_thirds - 1) / gamma(1 + two_thirds)
knaus_zwicker(i) = i < 100 ? rho(i) : rho_far(i) # relative error 2e-6 there
power(i) = i**(two_thirds - 1)
pbrt(i) = i < 2 ? NaN : two_thirds * knaus_zwicker(i - 1)
# lim r^2 / r^2 of knaus-zwicker; bias goes with r^2, variance against it.
constant(l) = l == 2 ? two_thirds : l == 4 ? gamma(1 + two_thirds) : 1

# ---- an ellipse from two conjugate half-axes: eigenvalues of a a' + b b' ----
m11(a1, b1) = a1**2 + b1**2
m12(a1, a2, b1, b2) = a1 * a2 + b1 * b2
root(p, q, s) = sqrt((p - q)**2 / 4 + s**2)
major(a1, a2, b1, b2) = 2 * sqrt((m11(a1, b1) + m11(a2, b2)) / 2 + \
  root(m11(a1, b1), m11(a2, b2), m12(a1, a2, b1, b2)))
minor(a1, a2, b1, b2) = 4 * abs(a1 * b2 - a2 * b1) / major(a1, a2, b1, b2)
tilt(a1, a2, b1, b2) = m12(a1, a2, b1, b2) == 0 && m11(a1, b1) >= m11(a2, b2) ? 0 : \
  90 / pi * atan2(2 * m12(a1, a2, b1, b2), m11(a1, b1) - m11(a2, b2))
# Every eighth point of every eighth row.
every = 8
is_drawn(x, y) = int(x) % every == every / 2 && int(y) % every == every / 2

curve(c) = c <= 0.0031308 ? 12.92 * c : 1.055 * c**(1 / 2.4) - 0.055
shown(c) = 150 * curve(c / mean_green / 3 > 1 ? 1 : c / mean_green / 3)

if (system("mkdir -p ".quoted(results."/figures")." && echo made") ne "made") {
  print results."/figures: cannot make this directory"
  exit status 1
}

# ---- looks: Okabe and Ito's colours, of laws and of what else varies ----
colour(l) = word("#0072B2 #D55E00 #009E73 #CC79A7", l)
shape(l) = int(word("7 5 9 13", l))
other(k) = word("#E69F00 #56B4E9 #444444 #CC79A7", k)
dash(l) = l == 3 ? 2 : 1
# ---- page, in inches ----
paper_x = 7.2; paper_y = 6.13
column_x = 1.3; gap_x = 0.45; picture_x = 1.62
left(c) = (0.45 + (c - 1) * (column_x + gap_x)) / paper_x
right(c) = left(c) + column_x / paper_x
picture_left(c) = (0.28 + (c - 1) * (picture_x + 0.09)) / paper_x
top(row) = 1 - word("0.24 2.15 4.04", row) / paper_y
bottom(row) = top(row) - (row == 3 ? picture_x : 1.33) / paper_y

do for [terminal_name in "pdf svg png"] {
  if (terminal_name eq "pdf") { set terminal pdfcairo enhanced font "Helvetica,8" size paper_x,paper_y }
  if (terminal_name eq "svg") { set terminal svg enhanced font "Helvetica,11" \
    size 140 * paper_x,140 * paper_y background "white" }
  if (terminal_name eq "png") { set terminal pngcairo enhanced font "Helvetica,8" \
    size 200 * paper_x,200 * paper_y fontscale 1.75 linewidth 1.75 pointscale 1.75 }
  set output results."/figures/radius-sequences.".terminal_name
  set pointsize 0.32
  set errorbars 0
  set samples 1000
  set multiplot
  set datafile separator whitespace # of blocks
  set border 3 linewidth 0.6 linecolor "#444444"
  set grid xtics ytics linecolor "#DDDDDD" linewidth 0.4 linetype 1, linetype 1
  set xtics 1,10 scale 0.6,0.3 nomirror
  set ytics scale 0.6,0.3 nomirror
  set logscale x
  set format x "10^{%T}"
  set xrange [0.8:1250]
  set xlabel "iteration i" offset 0,0.7
  set key samplen 1.2 spacing 1 font ",7" maxrows 6 title ""

  # ---- radii ----
  set lmargin at screen left(1)
  set rmargin at screen right(1)
  set tmargin at screen top(1)
  set bmargin at screen bottom(1)
  set title "radius r_i / r_1 of four laws" offset 0,-0.7
  set logscale y
  set yrange [0.2:1.15]
  set ytics (0.2, 0.3, 0.4, 0.5, 0.7, 1)
  set format y "%g"
  set key bottom left reverse Left
  plot $uniform_1_2 using 1:5:6 with yerrorbars linewidth 0.5 pointtype shape(1) \
      linecolor rgb colour(1) title "hachisuka", \
    $uniform_2_2 using 1:5:6 with yerrorbars linewidth 0.5 pointtype shape(2) \
      linecolor rgb colour(2) title "pbrt", \
    sqrt(knaus_zwicker(x < 1 ? 1 : x)) with lines linewidth 0.9 linecolor rgb colour(3) \
      title "knaus-zwicker", \
    sqrt(power(x < 1 ? 1 : x)) with lines linewidth 0.9 linecolor rgb colour(4) title "power", \
    sqrt(pbrt(x)) with lines linewidth 0.9 dashtype 2 linecolor rgb colour(3) \
      title "√α knaus-zwicker_{i−1}"

  # ---- against the closed form: few photons ----
  unset logscale y
  set key top left Right noreverse maxrows 2 title "photons in the first disc" left
  do for [l = 1:2] {
    set lmargin at screen left(1 + l)
    set rmargin at screen right(1 + l)
    set title (l == 1 ? "hachisuka: mean r_i^2/(r_1^2 ρ_i) − 1, %" : \
      "pbrt: r_i^2/(r_1^2 α ρ_{i−1}) − 1, %") offset 0,-0.7
    set yrange [-4:40]
    set ytics 0,10
    plot 0 with lines linewidth 0.5 linecolor "#888888" notitle, \
      for [k = 1:4] sprintf("$uniform_%d_%d", l, k) using 1:(100 * $4) with lines linewidth 0.9 \
        linecolor rgb other(k) notitle, \
      for [k = 1:4] sprintf("$uniform_%d_%d", l, k) using 1:(100 * $2):(100 * $3) with yerrorbars \
        linewidth 0.5 pointtype shape(k) linecolor rgb other(k) title word(lambdas, k)
  }
  # ---- and light that varies ----
  set lmargin at screen left(4)
  set rmargin at screen right(4)
  set title "hachisuka, where light varies, %" offset 0,-0.7
  set yrange [-12:3]
  set ytics -10,5
  set key bottom left reverse Left maxrows 6 title ""
  plot 0 with lines linewidth 0.5 linecolor "#888888" notitle, \
    for [k = 1:3] sprintf("$point_%d", k) using 1:(100 * $4) with lines linewidth 0.9 \
      linecolor rgb other(k) notitle, \
    for [k = 1:3] sprintf("$point_%d", k) using 1:(100 * $2):(100 * $3) with yerrorbars linewidth 0.5 \
      pointtype shape(k) linecolor rgb other(k) title word("α=1/2 α=2/3 α=0.8", k)

  # ---- errors ----
  unset key
  set tmargin at screen top(2)
  set bmargin at screen bottom(2)
  set logscale xy
  set ytics autofreq
  set format y "10^{%T}"
  set xlabel "iterations N"
  set yrange [*:*]
  do for [c = 1:3] {
    quantity = word("variance bias rmse", c)
    set lmargin at screen left(c)
    set rmargin at screen right(c)
    set title word("'variance of the average' '|bias| of the average' 'RMSE of the average'", c) offset 0,-0.7
    set yrange [word("3e-7 3e-4 8e-4", c):word("1e-4 1e-2 1.2e-2", c)]
    plot for [l = 1:4] sprintf("$%s_%d", quantity, l) using 1:4 with lines linewidth 0.9 \
        dashtype dash(l) linecolor rgb colour(l), \
      for [l = 1:4] sprintf("$%s_%d", quantity, l) using 1:2:3 with yerrorbars linewidth 0.5 \
        pointtype shape(l) linecolor rgb colour(l)
  }
  # ---- what theory says of them as N grows ----
  set lmargin at screen left(4)
  set rmargin at screen right(4)
  unset logscale
  unset tics
  unset grid
  unset xlabel
  set border 0
  set title "as N grows, by theory" offset 0,-0.7
  set xrange [0:1]
  set yrange [0:1]
  set label 1 "ratio to knaus-zwicker" at 0.4,0.82 left font ",7"
  set label 2 "r^2" at 0.44,0.68 left font ",7"
  set label 3 "var." at 0.63,0.68 left font ",7"
  set label 4 "bias" at 0.85,0.68 left font ",7"
  do for [l = 1:4] {
    y = 0.68 - 0.13 * l
    set label 4 * l + 1 word(error_laws, l) at 0.35,y right font ",7" textcolor rgb colour(l)
    set label 4 * l + 2 sprintf("%.3f", constant(l)) at 0.4,y left font ",7"
    set label 4 * l + 3 sprintf("%.3f", 1 / constant(l)) at 0.62,y left font ",7"
    set label 4 * l + 4 sprintf("%.3f", constant(l)) at 0.84,y left font ",7"
  }
  plot NaN notitle
  unset label

  # ---- pictures ----
  set datafile separator comma
  set tmargin at screen top(3)
  set bmargin at screen bottom(3)
  set style ellipse units xx
  set xrange [-0.5:pixels - 0.5]
  set yrange [-0.5:pixels - 0.5]
  set label 1 "Above: α = 2/3 in uniform light, and a point light (380 photons in the first disc, at 0.8 of the density in its middle). Points: means over runs with" \
    at screen 0.5,0.3 / paper_y center textcolor "#444444" font ",7"
  set label 2 "95 % intervals, on the left with deviations (3 photons). Lines: theory's expectation of so many photons, by recursion. Middle: quadratic light, 103 photons" \
    at screen 0.5,0.19 / paper_y center textcolor "#444444" font ",7"
  set label 3 "in the first disc; lines: predicted (local laws: constants fitted). Below: ppm, one point in 64 and its disc; 2500 photons a pass." \
    at screen 0.5,0.08 / paper_y center textcolor "#444444" font ",7"
  do for [c = 1:4] {
    i = int(word(passes, c))
    set lmargin at screen picture_left(c)
    set rmargin at screen picture_left(c) + picture_x / paper_x
    set title (i == 1 ? "discs after 1 pass" : sprintf("%d passes", i)) offset 0,-0.7
    plot picture skip 1 using 1:(pixels - 1 - $2):(shown($3)):(shown($4)):(shown($5)) with rgbimage, \
      discs(i) skip 1 using (is_drawn($1, $2) ? $10 - 0.5 : NaN):(pixels - 0.5 - $11):\
        (major($12, $13, $14, $15)):(minor($12, $13, $14, $15)):(-tilt($12, $13, $14, $15)) \
        with ellipses linewidth 0.7 linecolor rgb "#E69F00", \
      discs(i) skip 1 using (is_drawn($1, $2) ? $10 - 0.5 : NaN):(pixels - 0.5 - $11) with points \
        pointtype 7 pointsize 0.12 linecolor rgb "#FFFFFF"
    unset label
  }
  unset multiplot
  set output
}
