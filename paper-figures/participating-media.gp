# experiments: participating-media
# A volumetric caustic: averages of 1, 10, 100, 1000 iterations of photon points, photon beams and path
# tracing in about the same time; below, variance and |bias| of the average at one pixel of the cone
# against N, of points (d = 3) and beams (d = 1), and what theory expects of them.
#   gnuplot -c paper-figures/participating-media.gp RESULTS_DIR   reads images/*.csv, timing.csv and
#   curves.csv, writes figures/participating-media.*
results = ARG1
figure = "participating-media"
load system("dirname \"".ARG0."\"")."/pictures.part.gp"

points = cell("view:all integrator:probabilistic")
beams = cell("view:all integrator:beams")
traced = cell("view:all integrator:path")
eval check
shown = "1 10 100 1000"
n_beams = last(averages(beams))
n_traced = last(averages(traced))
eval check
array file[6]; array title_of[6]; array time_of[6]
do for [k = 1:4] {
  file[k] = image(points, word(shown, k))
  title_of[k] = k == 1 ? "points, 1 iteration" : "points, 1–".word(shown, k)
  time_of[k] = seconds(points, word(shown, k))
}
file[5] = image(beams, n_beams); title_of[5] = "beams, 1–".n_beams; time_of[5] = seconds(beams, n_beams)
file[6] = image(traced, n_traced); title_of[6] = "paths, ".n_traced." a pixel"; time_of[6] = seconds(traced, n_traced)
eval check
eval sizes(file[5])

# ---- curves: blocks of N, size, lower, upper, predicted, found; one for each panel and alpha ----
alphas = "0.4 0.5714285714285714 0.8"
alpha(k) = real(word(alphas, k))
z = 1.959963984540054
rows(method, quantity, k) = sprintf("< awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) c[$i] = i; next } ".\
  "$c[\"integrator\"] == \"%s\" && $c[\"quantity\"] == \"%s\" && $c[\"series\"] == \"average\" && ".\
  "($c[\"alpha\"] - %s)^2 < 1e-12 { print $c[\"N\"] \",\" $c[\"measured\"] \",\" $c[\"lower\"] \",\" $c[\"upper\"] ".\
  "\",\" $c[\"predicted\"] }' %s/curves.csv", method, quantity, word(alphas, k), here)
methods = "probabilistic beams"
quantities = "variance bias"
panel(p, what) = word(what eq "method" ? methods : quantities, what eq "method" ? (p + 1) / 2 : (p - 1) % 2 + 1)
error(p) = (column(4) - column(3)) / (2 * z)
is_found(p) = panel(p, "quantity") eq "variance" || abs(column(2)) >= 2 * error(p)
size(p) = abs(column(2))
block(p, k) = sprintf("$curve%d%d", p, k)
do for [p = 1:4] { do for [k = 1:3] {
  source = rows(panel(p, "method"), panel(p, "quantity"), k)
  if (system("test -n \"$(".source[3:*].")\" && echo there") ne "there") {
    print results."/curves.csv: no ".panel(p, "quantity")." of ".panel(p, "method")." at alpha = ".word(alphas, k)
    exit status 1
  }
  eval every."set table ".block(p, k)
  plot source using 1:(size(p)):(panel(p, "quantity") eq "variance" ? column(3) : size(p) - z * error(p)):\
    (panel(p, "quantity") eq "variance" ? column(4) : size(p) + z * error(p)):\
    ($5 == 0 ? NaN : abs($5)):(is_found(p)) with table
  unset table
} }
array n_max[4]
do for [p = 1:4] {
  subject = rows(panel(p, "method"), panel(p, "quantity"), 1)
  eval every."stats subject using 1 nooutput"
  n_max[p] = STATS_max
}

# ---- theory's powers of N ----
names = "0.4 4/7 0.8"
power(p, k) = p % 2 == 1 ? alpha(k) : p == 2 ? 2 * (1 - alpha(k)) / 3 : \
  2 * (1 - alpha(k)) < 1 ? 2 * (1 - alpha(k)) : 1
slope(p, k) = power(p, k) == 1 ? "N^{−1}" : sprintf("N^{−%.2g}", power(p, k))
# Were bias as r^3, alpha = 4/7 gave b_1 S_+(N) / N (theory 3.1), in the end as N^-(1 - alpha).
rho(a, n) = exp(lgamma(n + a) - lgamma(1 + a) - lgamma(n + 1))
mean_rho(a, n) = ((n + a) * rho(a, n) - 1) / (a * n)
set datafile separator whitespace
first = word($curve22[1], 5) eq "nan" ? 2 : 5 # predicted, or measured
first_bias = real(word($curve22[1], first))
set table $if_as_volume
plot $curve22 using 1:(first_bias * mean_rho(alpha(2), $1)) with table
unset table

radiance = sprintf("%.2g", real(found(system("awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) c[$i] = i; next } ".\
  "$c[\"reference\"] ~ /^[0-9]/ { print $c[\"reference\"]; exit }' ".here."/probes.csv"), "reference in probes.csv")))
eval check

paper_x = 6.95; paper_y = 3.55
set errorbars 0
set datafile separator whitespace
do for [name in terminals] {
  eval terminal(name)
  set pointsize 0.4
  # ---- pictures ----
  set datafile separator comma
  eval bare
  eval whole
  exposure = 1 / (12 * mean)
  do for [c = 1:6] {
    eval place(0.06 + 1.15 * (c - 1), 0.2, 1.09, 1.09)
    set title title_of[c] offset 0,-0.8
    set xlabel sprintf("%.2g CPU s", time_of[c]) offset 0,0.4
    eval draw(file[c])
  }
  # ---- curves ----
  set datafile separator whitespace
  do for [p = 1:4] {
    eval bare
    eval axes
    eval place(0.42 + 1.73 * (p - 1), 1.72, 1.1, 1.12)
    set title (p % 2 ? "variance of " : "|bias| of ").(p < 3 ? "points" : "beams") offset 0,-0.6
    set xlabel "iterations N" offset 0,0.6
    set logscale xy
    set format xy "10^{%T}"
    set xrange [0.8:*]
    set yrange [*:*]
    if (p == 2) {
      set yrange [0.75 * first_bias * mean_rho(alpha(2), n_max[p]):1.25 * first_bias]
      set format y "%g"
      set ytics (0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5)
    }
    set xrange [0.8:n_max[p] * 1.25]
    plot for [k = 1:3] block(p, k) using 1:5 with lines linewidth 0.9 linecolor rgb colour(k), \
      for [k = 1:3] block(p, k) using 1:($6 == 1 ? $2 : NaN):3:4 with yerrorbars linewidth 0.6 pointtype shape(k) \
        linecolor rgb colour(k), \
      for [k = 1:3] block(p, k) using 1:($6 == 1 ? NaN : $4):(0):(-0.35 * $4) with vectors \
        head size screen 0.003,25 filled linewidth 0.4 linecolor rgb colour(k), \
      for [k = 1:3] block(p, k) using 1:($6 == 1 ? NaN : $4) with points pointtype shape(k) - 1 linewidth 0.6 \
        linecolor rgb colour(k), \
      for [k = 1:3] block(p, k) using 1:($1 == n_max[p] ? $5 : NaN):(slope(p, k)) with labels left \
        offset 0.5,0 font ",7" textcolor rgb colour(k), \
      $if_as_volume using 1:(p == 2 ? $2 : NaN) with lines linewidth 0.6 dashtype 2 linecolor rgb "#444444", \
      $if_as_volume using 1:(p == 2 && $1 == n_max[p] ? $2 : NaN):("N^{−0.43}") with labels left \
        offset 0.5,0 font ",7" textcolor rgb "#444444"
  }
  # ---- one legend ----
  eval bare
  eval place(0, 3.17, paper_x, 0.15)
  set key center center horizontal samplen 2.2 width 2
  plot [0:1] [0:1] for [k = 1:3] NaN with linespoints linewidth 0.9 pointtype shape(k) linecolor rgb colour(k) \
    title "α = ".word(names, k)
  eval bare
  eval note("Measured, 95 % intervals, of a radiance of ".radiance."; hollow: |bias| < 2 SE, upper limit. Lines: theory's exponents, ".\
    "constants fitted (none: rate not resolved). Dashed: if bias were as r^3, α = 4/7.")
  eval finish
}
