# experiments: reference-radius
# A row for each scene: path tracing, the average of the most iterations with each reference radius, and
# its relative error (root mean square over pixels, by the mean of path tracing) against N.
#   gnuplot -c paper-figures/reference-radius.gp RESULTS_DIR   reads images/*.csv, writes
#   figures/reference-radius.*
results = ARG1
figure = "reference-radius"
load system("dirname \"".ARG0."\"")."/pictures.part.gp"
scenes = "box cornell-box torus"
titles = "'Long box' 'Cornell box' 'Metal ring'"
kinds = "global knn ray-differentials"
kind_titles = "'global' 'k nearest photons' 'ray differentials'"
n_kinds = 3

array truth[3]
array white[3]
array most[3]
array picture[9]
do for [s = 1:3] {
  of_path = cell("integrator:path scene:".word(scenes, s))
  eval check
  truth[s] = image(of_path, last(averages(of_path)))
  eval check
  eval sizes(truth[s])
  white[s] = mean
  do for [k = 1:n_kinds] {
    c = cell("reference-radius:".word(kinds, k)." integrator:probabilistic scene:".word(scenes, s))
    eval check
    ns = averages(c)
    eval check
    most[s] = last(ns)
    picture[3 * (s - 1) + k] = image(c, most[s])
    eval "set print ".sprintf("$error_%d_%d", s, k)
    do for [n in ns] {
      eval compare(image(c, n), truth[s], truth[s])
      print sprintf("%s,%.9g", n, sqrt(mean_square) / mean)
    }
    unset print
  }
}

paper_x = 7.2; paper_y = 4.65
left(column) = 0.22 + 1.36 * (column - 1)
top(row) = 0.25 + 1.36 * (row - 1)
do for [name in terminals] {
  eval terminal(name)
  set pointsize 0.4
  do for [s = 1:3] {
    eval bare
    eval whole
    mean = white[s]
    eval expose_mean
    do for [column = 1:n_kinds + 1] {
      eval place(left(column), top(s), 1.3, 1.3)
      if (s == 1) {
        set title (column == 1 ? "path tracing" : word(kind_titles, column - 1)) offset 0,-0.8
      }
      if (column == 1) { set label 1 word(titles, s) at graph -0.06,0.5 center rotate by 90 }
      eval draw(column == 1 ? truth[s] : picture[3 * (s - 1) + column - 1])
    }
    # ---- error ----
    eval axes
    eval place(left(n_kinds + 2) + 0.3, top(s), 1.3 * 0.83, 1.28)
    set xrange [0.8:1.25 * most[s]]
    set yrange [*:*] noextend
    set logscale xy
    set xtics 1,10
    set ytics (0.02, 0.05, 0.1, 0.2, 0.5, 1, 2)
    set format x (s == 3 ? "10^{%T}" : "")
    set format y "%g"
    set offsets 0,0,graph 0.05,graph 0.05
    if (s == 1) { set title "relative error" offset 0,-0.8 }
    if (s == 3) { set xlabel "iterations N" offset 0,0.4 }
    plot for [k = 1:n_kinds] sprintf("$error_%d_%d", s, k) using 1:2 with linespoints \
      linewidth 0.9 pointtype shape(k) linecolor rgb colour(k)
    unset offsets
  }
  # ---- one legend ----
  eval bare
  eval place(0.72, paper_y - 0.28, 5.76, 0.26)
  set key center center horizontal samplen 2 width 2
  plot [0:1] [0:1] for [k = 1:n_kinds] NaN with linespoints linewidth 0.9 pointtype shape(k) \
    linecolor rgb colour(k) title word(kind_titles, k)
  eval finish
}
