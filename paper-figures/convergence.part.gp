# What the figures of convergence share (".part" because an experiment's own figure is NAME.gp):
# variance and |bias| of the average of N iterations against N, a column of panels for each scene, a
# curve for each cell, at the first of the scene's probes in the file. Points: measured over runs
# with 95 % intervals; lines: the predicted average (no slope is fitted to these points). Where
# theory has no closed form a line has theory's exponent and fitted constants. A bias below two
# standard errors is drawn hollow at its upper limit, with an arrow down. Loaded with these set:
#   results       the directory; curves.csv is read, figures/FIGURE.* is written
#   figure        name of the figure
#   scenes, names of the columns and their titles; "": the first six of the file
#   only          integrators whose cells are shown; "": all
#   slopes        1: a curve of alpha ends with theory's power of N, if alpha is all that varies
#   powers        of rho, which lead the bias of each column's scene; not set: 1, as on surfaces

# ---- inputs: gnuplot itself exits 0 when data are missing ----
if (results eq "") { print "usage: gnuplot -c ".figure.".gp RESULTS_DIR"; exit status 2 }
data = results."/curves.csv"
figures = results."/figures"
quoted(path) = "'".system("printf %s \"".path."\" | sed \"s/'/'\\\\\\\\''/g\"")."'"
header = system("head -n 1 ".quoted(data)." 2>/dev/null")
before = "cell,scene,"
after = ",x,y,quantity,series,first,N,measured,lower,upper,pooled,predicted"
keys_end = strlen(header) - strlen(after)
if (keys_end <= strlen(before) || header[1:strlen(before)] ne before || header[keys_end + 1:*] ne after) {
  print data.": missing, or its columns are not ".before."...".after
  exit status 1
}
if (system("mkdir -p ".quoted(figures)." && echo made") ne "made") {
  print figures.": cannot make this directory"
  exit status 1
}
keys = system("echo ".header[strlen(before) + 1:keys_end]." | tr , ' '")
n_keys = words(keys)

set datafile separator comma
set datafile columnheaders

# ---- first reading: scenes, how many cells, how far N goes ----
found_scenes = ""; n_cells = 0; n_max = 1
add_scene(s) = strstrt(found_scenes, "'".s."'") ? 0 : (found_scenes = found_scenes." '".s."'", 1)
set xrange [-1:1]
set yrange [-1:1]
set table $seen
plot data using (add_scene(strcol("scene")), \
  n_cells = column("cell") >= n_cells ? column("cell") + 1 : n_cells, \
  n_max = column("N") > n_max ? column("N") : n_max, 0):(0) with points
unset table
if (words(found_scenes) == 0) { print data.": has no rows"; exit status 1 }
left_out = ""
if (scenes eq "") {
  do for [c = 1:words(found_scenes) < 6 ? words(found_scenes) : 6] {
    scenes = scenes." '".word(found_scenes, c)."'"
  }
  if (words(found_scenes) > 6) { left_out = sprintf("shown: first 6 of %d scenes", words(found_scenes)) }
}
columns = words(scenes)

# A variance is drawn as it stands, a bias by its size.
z = 1.959963984540054
error(q) = (column("upper") - column("lower")) / (2 * z)
found(q) = q eq "variance" || abs(column("measured")) >= 2 * error(q)
lower(q) = q eq "variance" ? column("lower") : abs(column("measured")) - z * error(q)
upper(q) = q eq "variance" ? column("upper") : abs(column("measured")) + z * error(q)
drawn(p) = p == 0 ? NaN : abs(p)
# Whether a panel in logarithms shows anything of a row.
visible(q) = upper(q) > 0 || drawn(column("predicted")) > 0

# ---- second reading: the cells of each scene, and what tells them apart ----
n_cells = int(n_cells)
array scene_of[n_cells]; array values[n_cells]
array pixel[columns]
do for [i = 1:n_cells] { scene_of[i] = 0; values[i] = "" }
do for [c = 1:columns] { pixel[c] = "" }
rows = ""; lines = ""; biased = ""
number_of(s) = sum [c = 1:columns] (word(scenes, c) eq s ? c : 0)
add_pixel(c, xy) = pixel[c] eq "" ? (pixel[c] = xy, 1) : 0
row_name(q, i) = sprintf("|%s:%d|", q, i)
add_row(r) = strstrt(rows, r) ? 0 : (rows = rows.r, 1)
add_line(r, p) = p != p || strstrt(lines, r) ? 0 : (lines = lines.r, 1) # NaN is not itself
add_biased(c, q, p) = q eq "variance" || p == 0 || strstrt(biased, sprintf("|%d|", c)) ? 0 : \
  (biased = biased.sprintf("|%d|", c), 1)
add_value(i, j) = (values[i] = values[i].strcol(word(keys, j))." ", 0)
add_cell(i, c) = scene_of[i] ? 0 : (scene_of[i] = c, sum [j = 1:n_keys] add_value(i, j))
# Rows of averages, of a scene and of an integrator that are shown, at the probe that is shown.
is_named(s, list) = list eq "" || strstrt(" ".list." ", " ".s." ") > 0
take(i, c, q, xy) = c == 0 || strcol("series") ne "average" || !is_named(strcol("integrator"), only) ? 0 : \
  (add_pixel(c, xy), add_biased(c, q, column("predicted")), \
  pixel[c] ne xy ? 0 : (add_cell(i, c), !visible(q) ? 0 : add_row(row_name(q, i)), \
    add_line(row_name(q, i), column("predicted"))))
set table $seen
plot data using (take(int(column("cell")) + 1, number_of(strcol("scene")), strcol("quantity"), \
  strcol("x").",".strcol("y")), 0):(0) with points
unset table
# A scene that was named and has no curve is an error; a curve the fit could not predict is named in
# its panel.
do for [quantity in "variance bias"] { do for [c = 1:columns] {
  n_here = sum [i = 1:n_cells] (scene_of[i] == c && strstrt(rows, row_name(quantity, i)) > 0)
  if (names ne "" && n_here == 0) {
    print sprintf("%s: no %s of %s", data, quantity, word(scenes, c))
    exit status 1
  }
} }
if (rows eq "") { print data.": has nothing to draw"; exit status 1 }

# A key varies if it does among the cells of one scene.
array one[columns]
varied = ""
do for [j = 1:n_keys] {
  varies = 0
  do for [c = 1:columns] { one[c] = "" }
  do for [i = 1:n_cells] { if (scene_of[i]) {
    value = word(values[i], j)
    if (one[scene_of[i]] ne "" && one[scene_of[i]] ne value) { varies = 1 }
    one[scene_of[i]] = value
  } }
  if (varies) { varied = varied." ".j }
}
# What else varies tells the curves apart better than their random numbers.
unseeded = ""
do for [j in varied] { if (word(keys, int(j)) ne "seed") { unseeded = unseeded." ".j } }
if (unseeded ne "") { varied = unseeded }
# Three digits, or a fraction of small numbers, or six digits.
is_whole(x) = abs(x - int(x + 0.5)) < 1e-6
smallest(x, n) = n > 15 ? 0 : is_whole(x * n) ? n : smallest(x, n + 1)
fraction(x) = is_whole(1000 * x) || !smallest(x, 2) ? sprintf("%g", x) : \
  sprintf("%d/%d", int(x * smallest(x, 2) + 0.5), smallest(x, 2))
value_text(v) = !strstrt(v, ".") ? v : fraction(real(v))
key_text(k) = k eq "alpha" ? "α" : k

# ---- the series: cells alike in what varies have one look and one entry of the legend ----
array series_of[n_cells]; array legend[n_cells]; array identity[n_cells]
n_series = 0; longest = 0
do for [i = 1:n_cells] { series_of[i] = 0; if (scene_of[i]) {
  mine = ""; label_text = ""
  do for [j in varied] {
    mine = mine." ".word(values[i], int(j))
    label_text = label_text.(label_text eq "" ? "" : ", ").key_text(word(keys, int(j)))." = ". \
      value_text(word(values[i], int(j)))
  }
  do for [k = 1:n_series] { if (identity[k] eq mine) { series_of[i] = k } }
  if (!series_of[i]) {
    n_series = n_series + 1
    identity[n_series] = mine; legend[n_series] = label_text; series_of[i] = n_series
    if (strlen(label_text) > longest) { longest = strlen(label_text) }
  }
} }
most = 12 # six colours, two of each
if (n_series > most) { left_out = sprintf("%s first %d of %d series", \
  left_out eq "" ? "shown:" : left_out.",", most, n_series) }
n_shown = n_series > most ? most : n_series
if (left_out ne "") { print data.": ".left_out }

# ---- the points: blocks $variance1, $bias1, ... of N, size, lower, upper, predicted, found ----
is_mine(i, q) = column("cell") == i - 1 && strcol("quantity") eq q && strcol("series") eq "average" && \
  strcol("x").",".strcol("y") eq pixel[scene_of[i]]
block(q, i) = "$".q.i
is_shown(i, q) = scene_of[i] && series_of[i] <= most && strstrt(rows, row_name(q, i))
do for [quantity in "variance bias"] { do for [i = 1:n_cells] { if (is_shown(i, quantity)) {
  eval "set table ".block(quantity, i)
  plot data using (column("N")):(abs(column("measured"))):(lower(quantity)):(upper(quantity)):\
    (drawn(column("predicted"))):(found(quantity)) with table if (is_mine(i, quantity))
  unset table
} } }
set datafile separator whitespace
unset datafile columnheaders

# ---- looks: Okabe and Ito's colours; shapes differ too, and the second six are dashed ----
colour(k) = word("#0072B2 #D55E00 #009E73 #CC79A7 #E69F00 #56B4E9", (k - 1) % 6 + 1)
full(k) = int(word("7 5 9 13 11 15 5 9 13 11 15 7", k))
hollow(k) = full(k) - 1
dash(k) = k > 6 ? 2 : 1
with_slopes = slopes && words(varied) == 1 && word(keys, int(word(varied." 0", 1))) eq "alpha"
alpha(k) = real(identity[k])
# The average forgets no bias: at 1/N that of its first iterations is left.
falls(k, c) = exists("powers") ? real(word(powers, c)) * (1 - alpha(k)) : 1 - alpha(k)
slope_of(k, q, c) = q eq "variance" ? alpha(k) : falls(k, c) < 1 ? falls(k, c) : 1
slope_text(k, q, c) = !with_slopes ? "" : sprintf("N^{−%s}", fraction(slope_of(k, q, c)))
value_list(k) = words(varied) == 1 ? " ".value_text(word(identity[k], 1)) : sprintf(" %d", k)
noted = words(varied) == 1 ? key_text(word(keys, int(word(varied, 1))))." =" : "curves"

# ---- page, in inches ----
paper_x = columns < 3 ? 4.2 : 0.26 + 1.785 * columns
per_row = int((paper_x - 0.81) / (0.062 * longest + 0.38)) # as gnuplot reckons
per_row = per_row < 1 ? 1 : per_row > n_shown ? n_shown : per_row
key_rows = (n_shown + per_row - 1) / per_row
foot = left_out eq "" ? 0 : 0.14
more = foot + 0.1 * (key_rows - 1)
paper_y = 4.2 + more
left = 0.48 / paper_x; right = 1 - 0.33 / paper_x; gap = 0.555 / paper_x
width = (right - left - gap * (columns - 1)) / columns
up(y) = (y * 4.2 + more) / paper_y # from the height on a page with one row of legend
set pointsize 0.42
set errorbars 0

do for [terminal_name in "pdf svg png"] {
  if (terminal_name eq "pdf") { set terminal pdfcairo enhanced font "Helvetica,8" size paper_x,paper_y }
  if (terminal_name eq "svg") { set terminal svg enhanced font "Helvetica,11" \
    size 140 * paper_x,140 * paper_y background "white" }
  if (terminal_name eq "png") { set terminal pngcairo enhanced font "Helvetica,8" \
    size 300 * paper_x,300 * paper_y fontscale 2.6 linewidth 2.6 pointscale 2.6 }
  set output figures."/".figure.".".terminal_name
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
    top = up(row == 1 ? 0.94 : 0.53)
    do for [c = 1:columns] {
      set lmargin at screen left + (c - 1) * (width + gap)
      set rmargin at screen left + (c - 1) * (width + gap) + width
      set tmargin at screen top
      set bmargin at screen top - 0.35 * 4.2 / paper_y
      if (row == 1) {
        if (names eq "") { set title word(scenes, c)." at ".pixel[c] offset 0,-0.4 noenhanced
        } else { set title word(names, c) offset 0,-0.4 }
      } else { unset title }
      if (row == 2) { set xlabel "iterations N" offset 0,0.6 } else { unset xlabel }
      if (c == 1) {
        set ylabel row == 1 ? "variance of the average" : "|bias| of the average" offset 1.2,0
      } else { unset ylabel }
      here = ""; absent = ""; unresolved = ""
      do for [i = 1:n_cells] { if (scene_of[i] == c && series_of[i] <= most) {
        if (is_shown(i, quantity)) {
          here = here." ".i
          if (!strstrt(lines, row_name(quantity, i))) {
            unresolved = unresolved.value_list(series_of[i])
          }
        } else { absent = absent.value_list(series_of[i]) }
      } }
      note = row == 2 && !strstrt(biased, sprintf("|%d|", c)) ? "predicted: no bias" : ""
      if (unresolved ne "") { note = "rate not resolved: ".noted.unresolved }
      if (absent ne "") { note = "not resolvable: ".noted.absent }
      if (here eq "") { note = quantity.": nothing to draw" }
      set label 1 note at graph 0.05,0.07 left textcolor "#666666" font ",7"
      if (here eq "") {
        set yrange [0.1:1]
        plot NaN
        set yrange [*:*]
      } else {
        plot \
          for [i in here] block(quantity, i) using 1:5 with lines linewidth 0.9 dashtype dash(series_of[int(i)]) \
            linecolor rgb colour(series_of[int(i)]), \
          for [i in here] block(quantity, i) using 1:($6 == 1 ? $2 : NaN):3:4 with yerrorbars linewidth 0.6 \
            pointtype full(series_of[int(i)]) linecolor rgb colour(series_of[int(i)]), \
          for [i in here] block(quantity, i) using 1:($6 == 1 ? NaN : $4):(0):(-0.35 * $4) with vectors \
            head size screen 0.003,25 filled linewidth 0.4 linecolor rgb colour(series_of[int(i)]), \
          for [i in here] block(quantity, i) using 1:($6 == 1 ? NaN : $4) with points \
            pointtype hollow(series_of[int(i)]) linewidth 0.6 linecolor rgb colour(series_of[int(i)]), \
          for [i in here] block(quantity, i) using 1:($1 == n_max ? $5 : NaN):\
            (slope_text(series_of[int(i)], quantity, c)) with labels left offset 0.5,0 font ",7" \
            textcolor rgb colour(series_of[int(i)])
      }
    }
  }
  # One legend for all panels.
  set lmargin at screen left
  set rmargin at screen right
  set tmargin at screen up(0.09)
  set bmargin at screen (0.17 + foot) / paper_y
  unset logscale; unset border; unset xtics; unset ytics; unset xlabel; unset ylabel; unset title; unset grid
  set label 1 "points: measured, 95 % intervals; hollow: |bias| < 2 SE, upper limit; lines: predicted (no closed form: constants fitted)" \
    at screen 0.5,(0.085 + foot) / paper_y center textcolor "#444444" font ",7"
  set label 2 left_out at screen 0.5,0.085 / paper_y center textcolor "#444444" font ",7"
  if (words(varied)) { set key center center horizontal samplen 2.2 width 2 maxcols per_row }
  plot [0:1] [0:1] for [k = 1:n_shown] NaN with linespoints linewidth 0.9 dashtype dash(k) \
    pointtype full(k) linecolor rgb colour(k) title legend[k]
  unset label
  unset key
  unset multiplot
  set output
}
