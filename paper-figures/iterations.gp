# experiments: iterations
# Iterations 1, 10, 100, 1000 alone, and below them the averages up to these; at the right their error
# against i and N, and path tracing.
#   gnuplot -c paper-figures/iterations.gp RESULTS_DIR   reads images/*.csv and timing.csv, writes
#   figures/iterations.*
results = ARG1
figure = "iterations"
load system("dirname \"".ARG0."\"")."/pictures.part.gp"

photons = cell("integrator:probabilistic")
traced = cells("integrator:path")
eval check
if (words(traced) != 2) { print results.": path tracing is there ".words(traced)." times, not twice"; exit status 1 }
samples = last(averages(int(word(traced, 1))))
one = image(int(word(traced, 1)), samples)
other = image(int(word(traced, 2)), samples)
ns = averages(photons)
eval check
eval sizes(one)

# Relative: root mean square over pixels and channels, by the mean of path tracing.
array of_single[words(ns)]
array of_average[words(ns)]
uncertain = 0
set print $error
do for [k = 1:words(ns)] {
  single = image(photons, "single-".word(ns, k))
  average = image(photons, word(ns, k))
  eval check
  eval compare(single, one, other)
  of_single[k] = root(mean_square) / mean
  eval compare(average, one, other)
  of_average[k] = root(mean_square) / mean
  se = root_error(mean_square, square_error) / mean
  uncertain = se > uncertain ? se : uncertain
  print sprintf("%s,%.9g,%.9g", word(ns, k), of_single[k], of_average[k])
}
unset print
number(n) = sum [k = 1:words(ns)] (word(ns, k) eq n ? k : 0)
shown = "1 10 100 1000"
array seconds_to[4]
do for [c = 1:4] {
  if (number(word(shown, c)) == 0) { print results.": no image of ".word(shown, c)." iterations"; exit status 1 }
  seconds_to[c] = seconds(photons, word(shown, c))
}
eval check

paper_x = 6.95; paper_y = 3.5
left(column) = 0.08 + 1.36 * (column - 1)
top(row) = 0.2 + 1.6 * (row - 1)
do for [name in terminals] {
  eval terminal(name)
  set pointsize 0.4
  eval bare
  eval whole
  exposure = 1 / (5 * mean)
  do for [c = 1:4] {
    n = word(shown, c)
    eval place(left(c), top(1), 1.3, 1.3)
    set title "iteration ".n offset 0,-0.8
    set xlabel "error ".percent(of_single[number(n)]) offset 0,0.4
    eval draw(image(photons, "single-".n))
    eval place(left(c), top(2), 1.3, 1.3)
    set title (c == 1 ? "average of 1" : "average of 1–".n) offset 0,-0.8
    set xlabel "error ".percent(of_average[number(n)]).sprintf(", %.2g CPU s", seconds_to[c]) offset 0,0.4
    eval draw(image(photons, n))
  }
  eval place(left(5), top(2), 1.3, 1.3)
  set title "path tracing" offset 0,-0.8
  set xlabel samples." samples a pixel" offset 0,0.4
  eval draw(one)
  # ---- error ----
  eval bare
  eval axes
  eval place(left(5) + 0.3, top(1), 1.0, 1.2)
  set title "relative error" offset 0,-0.8
  set xlabel "i, N" offset 0,0.6
  set logscale xy
  set xrange [0.8:1250]
  set yrange [*:*] noextend
  set offsets 0,0,graph 0.08,graph 0.08
  set xtics (1, 10, 100, 1000)
  set ytics (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2)
  set format "%g"
  set label 2 "alone" at graph 0.1,0.85 textcolor rgb colour(2)
  set label 3 "average" at graph 0.1,0.15 textcolor rgb colour(1)
  plot for [k = 1:2] $error using 1:(column(4 - k)) with linespoints linewidth 0.9 pointtype shape(k) \
    linecolor rgb colour(k)
  unset label
  unset offsets
  eval bare
  eval note("All light but the lamp itself, as seen directly, in metal and in glass. Errors: root mean squares over pixels, of the mean;".\
    " path tracing's noise leaves a standard error of at most ".sprintf("%.1g %%.", 100 * uncertain))
  eval finish
}
