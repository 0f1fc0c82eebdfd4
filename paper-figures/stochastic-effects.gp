# experiments: stochastic-effects
# A row for depth of field, motion blur and gloss: path tracing, PPM with one and with sixteen points a pixel,
# SPPM and probabilistic photon mapping after about as much CPU time; their errors against CPU time.
#   gnuplot -c paper-figures/stochastic-effects.gp RESULTS_DIR   reads images/*.csv and timing.csv,
#   writes figures/stochastic-effects.*
results = ARG1
figure = "stochastic-effects"
load system("dirname \"".ARG0."\"")."/pictures.part.gp"
scenes = "balls-lens balls-motion balls-gloss"
titles = "'Depth of field' 'Motion blur' 'Gloss'"
kinds = "'integrator:ppm hit-points:1' 'integrator:ppm hit-points:16' integrator:sppm integrator:probabilistic"
kind_titles = "'PPM, 1 point' 'PPM, 16 points' 'SPPM' 'probabilistic'"
n_kinds = 4
moves(s) = s == 2
has(s, k) = !moves(s) || k > 2 # PPM is refused where something moves

# Relative errors: root mean square over pixels and channels, by the mean of path tracing. Path tracing's
# own: of either, half the mean square of what two differ by.
array truth[3]
array white[3]
array picture[12]
array caption[12]
array samples[3]
uncertain = 0
do for [s = 1:3] {
  scene = " scene:".word(scenes, s)
  traced = cells("integrator:path".scene)
  eval check
  if (words(traced) != 2) { print results.": path tracing of".scene." is not there twice"; exit status 1 }
  ns = averages(int(word(traced, 1)))
  eval check
  samples[s] = last(ns)
  one = image(int(word(traced, 1)), samples[s])
  other = image(int(word(traced, 2)), samples[s])
  eval check
  truth[s] = one
  eval sizes(one)
  white[s] = mean
  eval "set print ".sprintf("$error_%d_%d", s, n_kinds + 1)
  do for [n in ns] {
    half = image(int(word(traced, 1)), n)
    rest = image(int(word(traced, 2)), n)
    took = seconds(int(word(traced, 1)), n)
    eval check
    eval compare(half, rest, rest)
    print sprintf("%.9g,%.9g", took, sqrt(mean_square / 2) / mean)
  }
  unset print
  do for [k = 1:n_kinds] { if (has(s, k)) {
    c = cell(word(kinds, k).scene)
    eval check
    ns = averages(c)
    eval "set print ".sprintf("$error_%d_%d", s, k)
    do for [n in ns] {
      of_n = image(c, n)
      took = seconds(c, n)
      eval check
      eval compare(of_n, one, other)
      print sprintf("%.9g,%.9g", took, root(mean_square) / mean)
    }
    unset print
    se = root_error(mean_square, square_error) / mean
    uncertain = k > 2 && se > uncertain ? se : uncertain
    picture[n_kinds * (s - 1) + k] = of_n
    caption[n_kinds * (s - 1) + k] = sprintf("error %.3g %%, %.2g CPU s", 100 * root(mean_square) / mean, took)
  } }
}

paper_x = 7.2; paper_y = 3.85
side_x = 1.1; side_y = side_x * height / width
left(column) = 0.22 + 1.14 * (column - 1)
top(row) = 0.22 + 1.08 * (row - 1)
do for [name in terminals] {
  eval terminal(name)
  set pointsize 0.35
  do for [s = 1:3] {
    eval bare
    eval whole
    mean = white[s]
    eval expose_mean
    eval place(left(1), top(s), side_x, side_y)
    if (s == 1) { set title "path tracing" offset 0,-0.8 }
    set xlabel samples[s]." samples a pixel" offset 0,0.4 font ",7"
    set label 1 word(titles, s) at graph -0.07,0.5 center rotate by 90
    eval draw(truth[s])
    do for [k = 1:n_kinds] {
      if (s == 1) { set title word(kind_titles, k) offset 0,-0.8 }
      if (has(s, k)) {
        eval place(left(k + 1), top(s), side_x, side_y)
        set xlabel caption[n_kinds * (s - 1) + k] offset 0,0.4 font ",7"
        eval draw(picture[n_kinds * (s - 1) + k])
      }
      if (!has(s, k) && k == 1) {
        eval place(left(2), top(s), 1.14 + side_x, side_y)
        unset xlabel
        set label 1 "refused: PPM draws its points once,\nphotons of other times do not belong to them" \
          at graph 0.5,0.55 center textcolor "#666666" font ",7"
        plot NaN
        unset label 1
      }
    }
    # ---- error ----
    eval bare
    eval axes
    eval place(left(6) + 0.28, top(s), 0.84, side_y)
    set logscale xy
    set xrange [0.05:30]
    set yrange [*:*] noextend
    set offsets 0,0,graph 0.08,graph 0.08
    set xtics (0.1, 1, 10)
    set ytics (0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5)
    set format x (s == 3 ? "%g" : "")
    set format y "%g"
    if (s == 1) { set title "relative error" offset 0,-0.8 }
    if (s == 3) { set xlabel "CPU seconds" offset 0,0.6 font ",8" }
    plot for [k in moves(s) ? "3 4 5" : "1 2 3 4 5"] sprintf("$error_%d_%s", s, k) using 1:2 with linespoints \
      linewidth 0.9 pointtype shape(int(k)) linecolor rgb colour(int(k))
    unset offsets
  }
  # ---- one legend ----
  eval bare
  eval place(0.5, paper_y - 0.4, 6.2, 0.22)
  set key center center horizontal samplen 2 width 1
  plot [0:1] [0:1] for [k = 1:n_kinds + 1] NaN with linespoints linewidth 0.9 pointtype shape(k) \
    linecolor rgb colour(k) title (k > n_kinds ? "path tracing" : word(kind_titles, k))
  eval bare
  eval note("All light but the lamp itself. Errors: root mean squares over pixels, of the mean; standard error of SPPM's and ".\
    "probabilistic's last ones at most ".percent(uncertain).".")
  eval finish
}
