# experiments: time-to-error
# A panel for each scene: relative mean square error against CPU seconds, by every method, and where
# they change places; the last: CPU seconds until a rate is known to 0.004, against alpha.
#   gnuplot -c paper-figures/time-to-error.gp RESULTS_DIR   reads curves-time.csv, leads.csv, efficiency.csv,
#   references.csv (photonlab efficiency) and verdict.csv (time-to-error.sh), writes figures/time-to-error.*
results = ARG1
figure = "time-to-error"
load system("dirname \"".ARG0."\"")."/pictures.part.gp"

file(name) = here."/".name
rows(name, condition, what) = sprintf("< awk -F, 'NR > 1 && %s { print %s }' %s", condition, what, file(name))
words_of(name, condition, what) = found(system(rows(name, condition, what)[3:*]." | awk '!seen[$0]++'"), name)
scenes = words_of("references.csv", "1", "$1")
verdicts = words_of("verdict.csv", "1", "$1\"/\"$3")
seen = words_of("curves-time.csv", "1", "$1")
eval check
n = words(scenes)

# ---- names and looks of scenes and methods ----
known = "cornell-box glass-and-mirror torus-in-glass-wide-64 fog-caustic-64"
known_titles = "'diffuse box' 'glass and mirror balls' 'torus in glass' 'caustic in fog'"
place_of(name, list) = sum [k = 1:words(list)] (word(list, k) eq name ? k : 0)
title_of(scene) = place_of(scene, known) ? word(known_titles, place_of(scene, known)) : scene
methods = "'path' 'photonmap' 'ppm' 'sppm' 'beams' 'probabilistic box 0.5' 'probabilistic box 0.667' ".\
  "'probabilistic box 0.8' 'probabilistic epanechnikov 0.667'"
method_titles = "'path tracing' 'photon maps' 'PPM' 'SPPM' 'photon beams' 'probabilistic, 1/2' ".\
  "'probabilistic, 2/3' 'probabilistic, 4/5' 'prob., 2/3, Epanechnikov'"
colours = "#000000 #E69F00 #CC79A7 #D55E00 #009E73 #56B4E9 #0072B2 #56B4E9 #0072B2"
shapes = "7 15 9 5 13 10 11 8 4"
dashes = "1 1 1 1 1 2 1 4 3"
look(m) = int(word(dashes, m))
shaped(m) = int(word(shapes, m))
tint(m) = word(colours, m)
is_method(scene, m) = sprintf("$1 == \"%s\" && $2 == \"%s\"", scene, word(methods, m))
title_of_method(name) = place_of(name, methods) ? word(method_titles, place_of(name, methods)) : name
block(s, m) = sprintf("$curve%d_%d", s, m)

# ---- curves: CPU seconds, error, its standard error, whether it counts ----
set datafile separator whitespace
array least[n]; array reference[n]; array efficient[n]; array crossings[n]
do for [s = 1:n] {
  scene = word(scenes, s)
  do for [m = 1:words(methods)] {
    lines = system(rows("curves-time.csv", is_method(scene, m), "$4, $5, $6, $7")[3:*])
    eval "set print ".block(s, m)
    print lines eq "" ? "NaN NaN NaN 0" : lines
    unset print
  }
  reference[s] = real(system(rows("references.csv", sprintf("$1 == \"%s\"", scene), "$4 + $5")[3:*]))
  # The best at the last common time, and by how much it beats path tracing.
  efficient[s] = system(rows("efficiency.csv", sprintf("$1 == \"%s\"", scene), "$2 \",\" $3 \",\" $4")[3:*]." | awk -F, '".\
"$1 == \"path\" { path = $3 } !best || $3 < best { best = $3; name = $1; at = $2 } ".\
    "END { if (!path) exit; r = path / best; d = r < 10 ? 1 : r < 100 ? 0 : r < 1000 ? -1 : -2; ".\
    "printf \"%s|%.2g|%.*f\", name, at, d < 0 ? 0 : d, int(r * 10 ^ d + 0.5) / 10 ^ d }'")
  eval sprintf("set print $crossed%d", s)
  print "NaN NaN NaN NaN"
  print system(rows("leads.csv", sprintf("$1 == \"%s\" && $7 != \"nan\"", scene), "$7, $8, $5")[3:*])
  unset print
}
field(text, k) = system(sprintf("printf %%s '%s' | cut -d '|' -f %d", text, k))
summary(s) = efficient[s] eq "" ? "" : sprintf("at %s s best: ", field(efficient[s], 2)).\
  title_of_method(field(efficient[s], 1)).(field(efficient[s], 1) eq "path" ? "" : \
  sprintf(", %s× path", field(efficient[s], 3)))

# ---- verdicts: alpha, planned CPU s, needed CPU s, whether it was reached ----
n_verdicts = words(verdicts)
verdict_scene(v) = system(sprintf("dirname %s", word(verdicts, v)))
verdict_kind(v) = system(sprintf("basename %s", word(verdicts, v)))
do for [v = 1:n_verdicts] {
  eval sprintf("set print $verdict%d", v)
  print system(rows("verdict.csv", sprintf("$1 == \"%s\" && $3 == \"%s\"", verdict_scene(v), verdict_kind(v)), \
    "$2, $5, $10, ($9 <= 0.004)")[3:*])
  unset print
}
verdict_title(v) = (verdict_scene(v) eq "plane-uniform-beam" ? "uniform" : "quadratic")." light, ".verdict_kind(v)

panels = n + 1
columns = 4
lines_of_panels = (panels + columns - 1) / columns
paper_x = 7.2; paper_y = 1.72 * lines_of_panels + 0.72
wide = 1.32; high = 1.22
left(p) = 0.42 + 1.75 * ((p - 1) % columns)
top(p) = 0.2 + 1.72 * ((p - 1) / columns)
set errorbars 0
do for [name in terminals] {
  eval terminal(name)
  set pointsize 0.35
  do for [s = 1:n] {
    eval bare
    eval axes
    eval place(left(s), top(s), wide, high)
    set title title_of(word(scenes, s)) offset 0,-0.7
    set xlabel "CPU seconds" offset 0,0.7
    if (s % columns == 1) { set ylabel "relative mean square error" offset 0.8,0 } else { unset ylabel }
    set logscale xy
    set format xy "10^{%T}"
    set xrange [*:*] noextend
    set yrange [*:*] noextend
    set offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05
    set label 1 summary(s) at graph 0.5,-0.255 center font ",6" textcolor "#444444"
    plot for [m = 1:words(methods)] block(s, m) using 1:($4 == 1 ? $2 : NaN):3 with yerrorbars linewidth 0.5 \
        pointtype shaped(m) linecolor rgb tint(m), \
      for [m = 1:words(methods)] block(s, m) using 1:($4 == 1 ? $2 : NaN) with lines linewidth 0.8 dashtype look(m) \
        linecolor rgb tint(m), \
      for [m = 1:words(methods)] block(s, m) using 1:($4 == 1 ? NaN : $2) with points pointsize 0.15 \
        pointtype 6 linewidth 0.5 linecolor rgb tint(m), \
      5 * reference[s] with lines linewidth 0.8 dashtype 3 linecolor rgb "#666666", \
      sprintf("$crossed%d", s) using 1:2 with points pointtype 6 pointsize 0.9 linewidth 0.7 linecolor rgb "#000000"
    unset label
    unset offsets
    unset xrange
    unset yrange
  }
  # ---- the cost of a verdict ----
  eval bare
  eval axes
  eval place(left(panels), top(panels), wide, high)
  set title "a rate to 0.004" offset 0,-0.7
  set xlabel "α" offset 0,0.7
  set ylabel "CPU seconds" offset 1.2,0
  set logscale y
  set format "%g"
  set xtics (0.3, 0.5, "2/3" 0.66667, 0.8)
  set xrange [0.25:0.85]
  set yrange [*:*]
  set key at graph 1,1 right top font ",6" samplen 1 spacing 1.1
  plot for [v = 1:n_verdicts] sprintf("$verdict%d", v) using 1:2 with lines linewidth 0.8 linecolor rgb colour(v) notitle, \
    for [v = 1:n_verdicts] sprintf("$verdict%d", v) using 1:($4 == 1 ? $3 : NaN) with points pointtype shape(v) \
      linecolor rgb colour(v) title verdict_title(v), \
    for [v = 1:n_verdicts] sprintf("$verdict%d", v) using 1:($4 == 1 ? NaN : $3) with points pointtype shape(v) - 1 \
      linecolor rgb colour(v) notitle
  unset ylabel
  unset xrange
  unset yrange
  # ---- one legend ----
  eval bare
  eval place(0.2, paper_y - 0.52, paper_x - 0.3, 0.3)
  set xrange [0:1]
  set yrange [0:1]
  legend_x(m) = ((m - 1) % 5) * 0.2
  legend_y(m) = m > 5 ? 0.25 : 0.75
  do for [m = 1:words(methods)] {
    set label m word(method_titles, m) at legend_x(m) + 0.045,legend_y(m) left font ",7"
  }
  plot for [m = 1:words(methods)] "+" every ::::1 using (legend_x(m) + 0.037 * $0):(legend_y(m)) with linespoints \
    linewidth 0.9 dashtype look(m) pointtype shaped(m) linecolor rgb tint(m)
  unset label
  unset xrange
  unset yrange
  eval note("Probabilistic: α, box kernel. Bars: standard errors over three runs. Rings: where curves cross. Dotted: five times the reference's ".\
    "error, where curves end. Last: hollow: extrapolated; lines: planned.")
  eval finish
}
