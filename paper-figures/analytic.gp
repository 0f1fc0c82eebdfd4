# experiments: analytic
# Measured over exact for every scene with a closed form: variance and bias, each as its size and its
# rate; below, how the bias of the average falls at, near and beside a shadow's edge.
#   gnuplot -c paper-figures/analytic.gp RESULTS_DIR   reads fit.json and curves.csv, writes figures/analytic.*
results = ARG1
if (results eq "") { print "usage: gnuplot -c analytic.gp RESULTS_DIR"; exit status 2 }
quoted(path) = "'".system("printf %s \"".path."\" | sed \"s/'/'\\\\\\\\''/g\"")."'"
data = results."/curves.csv"
fits = results."/fit.json"

# ---- inputs: gnuplot itself exits 0 when data are missing ----
header = system("head -n 1 ".quoted(data)." 2>/dev/null")
do for [name in "scene kernel x y quantity series N measured lower upper predicted"] {
  if (!strstrt(",".header.",", ",".name.",")) {
    print data.": missing, or without a column ".name
    exit status 1
  }
}
if (system("mkdir -p ".quoted(results."/figures")." && echo made") ne "made") {
  print results."/figures: cannot make this directory"
  exit status 1
}
# A line of fit.json is a key; those of a row are indented by six.
keys = "scene kernel quantity rate_theory rate rate_se coefficient_theory coefficient coefficient_se"
awk = "awk -v names=".quoted(keys)." 'BEGIN { n = split(names, name, \" \") } ".\
  "/^      \"probe\": / { getline x; getline y; gsub(/[ ,]/, \"\", x); gsub(/[ ,]/, \"\", y) } ".\
  "/^      \"[a-z_]*\": / { key = $1; gsub(/[\":]/, \"\", key); gsub(/[\",]/, \"\", $2); ".\
  "value[key] = $2 == \"null\" ? \"nan\" : $2 } ".\
  "/^    }/ { printf \"%s,%s\", x, y; for (k = 1; k <= n; k++) printf \" %s\", value[name[k]]; print \"\" }'"
set table $rows
plot "< ".awk." ".quoted(fits)." 2>/dev/null" using (stringcolumn(1)):(stringcolumn(2)):(stringcolumn(3)):\
  (stringcolumn(4)):5:6:7:8:9:10 with table
unset table
if (!exists("$rows") || |$rows| == 0) { print fits.": missing, or has no rows"; exit status 1 }

# ---- rows of the upper panels: scene, probe, title ----
shown = "\
 'plane-uniform-beam 32,32 Uniform beam'\
 'plane-quadratic-beam 32,32 Quadratic beam'\
 'plane-gaussian-beam 32,32 Gaussian beam, centre'\
 'plane-gaussian-beam 52,32 … where ΔE = 0'\
 'plane-cosine-grating 32,32 Grating, crest'\
 'plane-cosine-grating 36,32 … at its mean'\
 'plane-cosine-grating 40,32 … trough'\
 'plane-point-light 32,32 Lambertian point, foot'\
 'plane-point-light 52,32 … where ΔE = 0'\
 'plane-point-light-isotropic 32,32 Isotropic point, foot'\
 'plane-point-light-isotropic 52,32 … where ΔE = 0'\
 'plane-disc-light 32,32 Disc light, foot'\
 'plane-disc-light 62,32 … where ΔE = 0'\
 'plane-shadow-edge 32,32 Shadow, at the edge'\
 'plane-shadow-edge 45,32 … at r_1/2 from it'\
 'plane-shadow-edge-pixel 2,1 … pixel beside it'\
 'integrating-sphere 32,32 Integrating sphere'\
 'white-furnace 32,32 White furnace'\
 'mirror-sds 32,32 By a mirror, foot'\
 'mirror-sds 52,32 … where ΔE = 0'"
n_shown = words(shown)
title_of(k) = (t = word(shown, k), t = t[strstrt(t, " ") + 1:*], t[strstrt(t, " ") + 1:*])
place_of(k) = (t = word(shown, k), u = t[strstrt(t, " ") + 1:*], t[1:strstrt(t, " ")].word(u, 1))
row_of(scene, probe) = sum [k = 1:n_shown] (place_of(k) eq scene." ".probe ? k : 0)
kernels = "box gaussian"
kernel_of(name) = sum [k = 1:words(kernels)] (word(kernels, k) eq name ? k : 0)
y_of(scene, probe, kernel) = -row_of(scene, probe) + (kernel_of(kernel) == 1 ? 0.16 : -0.16)
z = 1.959963984540054

# Blocks: y, measured over exact, half of its interval, deviate of the difference; rate less theory's, half of
# its interval. Where the exact size is below three standard errors its ratio says nothing: only the deviate is
# shown.
take(q, k) = strcol(4) eq q && kernel_of(strcol(3)) == k && row_of(strcol(2), strcol(1)) > 0
at_y(x) = y_of(strcol(2), strcol(1), strcol(3))
do for [q in "variance bias"] { do for [k = 1:2] {
  eval sprintf("set table $size_%s_%d", q, k)
  plot $rows using (at_y(0)):(abs(column(8)) > 3 * column(10) ? column(9) / column(8) : -9):\
    (z * column(10) / abs(column(8))):((column(9) - column(8)) / column(10)) with table if (take(q, k))
  unset table
  eval sprintf("set table $rate_%s_%d", q, k)
  plot $rows using (at_y(0)):(column(6) - column(5)):(z * column(7)) with table if (take(q, k))
  unset table
} }
do for [k = 1:n_shown] {
  found = 0
  do for [line = 1:|$rows|] { if (word($rows[line], 2)." ".word($rows[line], 1) eq place_of(k)) { found = 1 } }
  if (!found) { print fits.": no rows of ".place_of(k); exit status 1 }
}

# ---- curves of the lower panel: |bias| of the average over the radiance in full light ----
curves = "\
 'plane-shadow-edge 32,32 at the edge: constant'\
 'plane-shadow-edge-pixel 2,1 pixel beside it: N^{−1/6}'\
 'plane-quadratic-beam 32,32 no edge (quadratic beam): N^{−1/3}'\
 'plane-shadow-edge 45,32 at r_1/2 from it: N^{−1} once it is clear'"
n_curves = words(curves)
n_max = 1
keep(n) = (n_max = n > n_max ? n : n_max, n)
curve_title(k) = (t = word(curves, k), t = t[strstrt(t, " ") + 1:*], t[strstrt(t, " ") + 1:*])
curve_place(k) = (t = word(curves, k), u = t[strstrt(t, " ") + 1:*], t[1:strstrt(t, " ")].word(u, 1))
radiance(k) = k == 3 ? 1 / pi**2 : 0.5 / pi**2 # reflectance 0.5, irradiance 2/pi and 1/pi
set datafile separator comma
set datafile columnheaders
is_curve(k) = strcol("scene")." ".strcol("x").",".strcol("y") eq curve_place(k) && strcol("kernel") eq "box" && \
  strcol("quantity") eq "bias" && strcol("series") eq "average"
do for [k = 1:n_curves] {
  eval sprintf("set table $curve_%d", k)
  plot data using (keep(column("N"))):(abs(column("measured")) / radiance(k)):\
    ((column("upper") - column("lower")) / 2 / radiance(k)):(abs(column("predicted")) / radiance(k)) \
    with table if (is_curve(k))
  unset table
}
set datafile separator whitespace
unset datafile columnheaders

# ---- page, in inches ----
paper_x = 7.4; paper_y = 6.9
set pointsize 0.45
set errorbars 0
colour(k) = word("#0072B2 #D55E00", k)
curve_colour(k) = word("#009E73 #CC79A7 #0072B2 #D55E00", k)
point(k) = int(word("7 9 5 13", k))
heads = "'variance / exact' 'its rate − α' '|bias| / exact' 'its rate − theory'"
left = 0.215; right = 0.985; gap = 0.018; width = (right - left - 3 * gap) / 4
array x_range[4] = [0.0155, 0.0155, 0.17, 0.11]
kinds = "size_variance rate_variance size_bias rate_bias"

do for [terminal_name in "pdf svg png"] {
  if (terminal_name eq "pdf") { set terminal pdfcairo enhanced font "Helvetica,8" size paper_x,paper_y }
  if (terminal_name eq "svg") { set terminal svg enhanced font "Helvetica,11" \
    size 140 * paper_x,140 * paper_y background "white" }
  if (terminal_name eq "png") { set terminal pngcairo enhanced font "Helvetica,8" \
    size 230 * paper_x,230 * paper_y fontscale 2.1 linewidth 2.1 pointscale 2.1 }
  set output results."/figures/analytic.".terminal_name
  set multiplot
  set border 1 linewidth 0.6 linecolor "#444444"
  set grid xtics linecolor "#DDDDDD" linewidth 0.4 linetype 1
  set xtics scale 0.6 nomirror
  unset key
  set tmargin at screen 0.955
  set bmargin at screen 0.385
  set yrange [-n_shown - 0.6:-0.4]
  do for [panel = 1:4] {
    kind = word(kinds, panel)
    centre = panel % 2
    set lmargin at screen left + (panel - 1) * (width + gap)
    set rmargin at screen left + (panel - 1) * (width + gap) + width
    set title word(heads, panel) offset 0,-0.6
    set xrange [centre - x_range[panel]:centre + x_range[panel]]
    set format x "%g"
    set xtics panel < 3 ? 0.01 : panel == 3 ? 0.1 : 0.05
    if (panel == 1) {
      set ytics scale 0
      set ytics () # the rows' names
      do for [k = 1:n_shown] { set ytics add (title_of(k) -k) }
    } else { set format y ""; unset ytics }
    set arrow 1 from centre,-n_shown - 0.6 to centre,-0.4 nohead linewidth 0.6 linecolor "#888888" back
    block(k) = sprintf("$%s_%d", kind, k)
    if (panel == 3) {
      plot for [k = 1:2] block(k) using ($2 == -9 ? NaN : $2):1:3 with xerrorbars linewidth 0.7 pointtype point(k) \
          linecolor rgb colour(k), \
        for [k = 1:2] block(k) using ($2 == -9 ? centre : NaN):1:(sprintf("z = %.1f", $4)) with labels left \
          offset 0.6,0 font ",6" textcolor rgb colour(k)
    } else {
      plot for [k = 1:2] block(k) using 2:1:3 with xerrorbars linewidth 0.7 pointtype point(k) linecolor rgb colour(k)
    }
    unset arrow 1
  }

  # The lower panel.
  unset title
  set border 3
  set lmargin at screen 0.075
  set rmargin at screen 0.64
  set tmargin at screen 0.315
  set bmargin at screen 0.06
  set xrange [0.9:n_max * 1.1]
  set yrange [1e-3:1]
  set logscale xy
  set xtics auto
  set ytics auto scale 0.6, 0.3 nomirror
  set format xy "10^{%T}"
  set grid xtics ytics linecolor "#DDDDDD" linewidth 0.4 linetype 1
  set xlabel "iterations N" offset 0,0.7
  set ylabel "|bias of the average| / radiance" offset 1.2,0
  set key at screen 0.66,0.31 left top Left reverse samplen 1.6 spacing 1.25 width 0
  set label 1 "points: measured, 95 % intervals; lines and 1: exact" at screen 0.665,0.085 left textcolor "#444444" font ",7"
  set label 2 "z: (measured − exact) / SE where the bias is too" at screen 0.665,0.066 left textcolor "#444444" font ",7"
  set label 3 "small for a ratio (none, or ΔE = 0: r^4 alone)" at screen 0.665,0.05 left textcolor "#444444" font ",7"
  set label 4 "no rate: not to be resolved at this size" at screen 0.665,0.031 left textcolor "#444444" font ",7"
  plot for [k = 1:n_curves] sprintf("$curve_%d", k) using 1:4 with lines linewidth 1 linecolor rgb curve_colour(k) notitle, \
    for [k = 1:n_curves] sprintf("$curve_%d", k) using 1:2:3 with yerrorbars linewidth 0.6 pointtype point(k) \
      linecolor rgb curve_colour(k) notitle, \
    for [k = 1:n_curves] NaN with linespoints linewidth 1 pointtype point(k) linecolor rgb curve_colour(k) \
      title curve_title(k), \
    for [k = 1:2] NaN with points pointtype point(k) linecolor rgb colour(k) title "above: ".word(kernels, k)." kernel"
  unset label
  unset logscale; unset xlabel; unset ylabel; unset key
  unset multiplot
  set output
}
