# experiments: light-paths
# Two scenes by every method at about equal time: the picture, a part of it enlarged, CPU seconds and
# relative error; and the error against CPU seconds. Prints the same as a table.
#   gnuplot -c paper-figures/light-paths.gp RESULTS_DIR   reads manifest.json, timing.csv, images/*.csv,
#   writes figures/light-paths.* and the truth, images/SCENE-{a,b,truth}.csv
results = ARG1
figure = "light-paths"
load system("dirname \"".ARG0."\"")."/pictures.part.gp"
scenes = "torus-in-box torus-in-glass"
titles = "'L D D E: in a box' 'L S D S E: in glass'"
methods = "path photonmap ppm sppm probabilistic"
method_titles = "'path tracing' 'photon mapping' 'PPM' 'SPPM' 'probabilistic'"
crops = "'78 148 56 42' '88 78 56 42'" # x, y, width, height in pixels
n = words(methods)

# ---- the truth, twice: path tracing, and photons at two radii of ratio 2 extrapolated to zero ----
final(c) = image(c, last(averages(c)))
picture(scene, what) = results."/images/".scene."-".what.".csv"
# Of two files the sum weighed with u and v.
weigh(u, one, v, other, file) = system("paste -d, ".quoted(one)." ".quoted(other)." | awk -F, -v OFS=, ".\
  sprintf("-v u=%.17g -v v=%.17g ", u, v)."'NR == 1 { print \"x,y,R,G,B\" } NR > 1 ".\
  "{ print $1, $2, u * $3 + v * $8, u * $4 + v * $9, u * $5 + v * $10 }' >".quoted(file))
paths = cells("scene:torus-in-box integrator:path") # the last two are the truth
radii = cells("scene:torus-in-glass integrator:probabilistic law:fixed") # small a, b, large a, b
mask = final(cell("scene:torus-in-glass-mask integrator:path"))
if (words(paths) != 3 || words(radii) != 4) { missing = "truth: two paths of the box, two radii twice of the glass" }
eval check
do for [k = 1:2] {
  t = weigh(1, final(int(word(paths, k + 1))), 0, mask, picture("torus-in-box", word("a b", k)))
  t = weigh(4. / 3, final(int(word(radii, k))), -1. / 3, final(int(word(radii, k + 2))), \
    picture("torus-in-glass", word("a b", k)))
}
do for [scene in scenes] {
  t = weigh(0.5, picture(scene, "a"), 0.5, picture(scene, "b"), picture(scene, "truth"))
}

# ---- errors: over the pixels of the torus in glass, and of the whole box ----
array mean_of[2]; array noise[2]; array frame[2 * n]; array took[2 * n]; array error[2 * n]
at(s, m) = n * (s - 1) + m
law_of(method) = method eq "probabilistic" ? " law:knaus-zwicker" : ""
block(s, m) = sprintf("$error_%d_%d", s, m)
counted(s) = s == 1 || column(18) > 0.5
product(one, other) = ($3 - column(one)) * ($3 - column(other)) # the scenes are gray
files(s, file) = beside(quoted(file)." ".quoted(picture(word(scenes, s), "a"))." ".\
  quoted(picture(word(scenes, s), "b"))." ".quoted(mask))
do for [s = 1:2] {
  scene = word(scenes, s)
  stats files(s, picture(scene, "truth")) skip 1 using (counted(s) ? $3 : NaN) nooutput
  mean_of[s] = STATS_mean
  stats files(s, picture(scene, "a")) skip 1 using (counted(s) ? product(13, 13) : NaN) nooutput
  noise[s] = 0.5 * sqrt(STATS_mean) / mean_of[s]
  do for [m = 1:n] {
    c = cell("scene:".scene." integrator:".word(methods, m).law_of(word(methods, m)))
    eval "set print ".block(s, m)
    do for [i in averages(c)] {
      stats files(s, image(c, i)) skip 1 using (counted(s) ? product(8, 13) : NaN) nooutput
      took[at(s, m)] = seconds(c, i)
      error[at(s, m)] = root(STATS_mean) / mean_of[s]
      print sprintf("%.9g,%.9g", took[at(s, m)], error[at(s, m)])
    }
    unset print
    frame[at(s, m)] = final(c)
  }
}
eval check
set print "-"
do for [s = 1:2] {
  print sprintf("%-15s error of the truth %.1f %%; others without it", word(scenes, s), 100 * noise[s])
  do for [m = 1:n] {
    print sprintf("  %-14s %7.1f CPU s  error %6.1f %%  of path tracing's %.3f", word(methods, m), \
      took[at(s, m)], 100 * error[at(s, m)], error[at(s, m)] / error[at(s, 1)])
  }
}

paper_x = 7.2; paper_y = 4.42
side = 0.86; below = side * 42 / 56; gap = 0.05; from = 0.25
left(k) = from + (side + gap) * (k - 1)
top(s) = 0.28 + 1.86 * (s - 1)
wide = 0.98
do for [terminal_name in terminals] {
  eval terminal(terminal_name)
  set pointsize 0.4
  eval bare
  do for [s = 1:2] {
    eval sizes(picture(word(scenes, s), "truth"))
    eval expose_mean
    crop_x = int(word(word(crops, s), 1)); crop_y = int(word(word(crops, s), 2))
    crop_w = int(word(word(crops, s), 3)); crop_h = int(word(word(crops, s), 4))
    do for [k = 1:n + 1] {
      file = k == 1 ? picture(word(scenes, s), "truth") : frame[at(s, k - 1)]
      eval place(left(k), top(s), side, side)
      eval whole
      if (s == 1) { set title (k == 1 ? "truth" : word(method_titles, k - 1)) offset 0,-0.8 } else { unset title }
      if (k == 1) { set label 1 word(titles, s) at graph -0.07,0.1 center rotate by 90 }
      eval mark(1, crop_x, crop_y, crop_w, crop_h, colour(5))
      eval draw(file)
      unset object 1
      unset title
      eval place(left(k), top(s) + side + gap, side, below)
      eval crop(crop_x, crop_y, crop_w, crop_h)
      set label 1 (k == 1 ? "± ".percent(noise[s]) : \
        sprintf("%.1f s, ", took[at(s, k - 1)]).percent(error[at(s, k - 1)])) at graph 0.5,-0.1 center
      eval draw(file)
    }
    # ---- error against time ----
    eval place(left(n + 2) + 0.32, top(s), wide, side + gap + below)
    eval axes
    set logscale xy
    set xrange [*:*] noextend
    set yrange [*:*] noextend
    equal = took[at(s, 1)]
    do for [m = 2:n] { equal = took[at(s, m)] < equal ? took[at(s, m)] : equal }
    set arrow 1 from first equal, graph 0 to first equal, graph 1 nohead dashtype 2 linecolor rgb "#999999"
    set offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05
    set format "%g"
    set xtics (0.1, 1, 10, 100, 1000)
    set ytics (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10)
    if (s == 1) { set title "relative error" offset 0,-0.8 } else { set xlabel "CPU seconds" offset 0,0.6 }
    plot for [m = 1:n] block(s, m) using 1:2 with linespoints linewidth 0.9 pointtype shape(m) \
      linecolor rgb (m == 1 ? "#000000" : colour(m - 1)), \
      noise[s] with lines linewidth 0.8 dashtype 3 linecolor rgb "#666666"
    eval bare
    unset arrow 1
    unset offsets
    unset xrange
    unset yrange
  }
  # ---- one legend ----
  eval place(0.4, paper_y - 0.42, paper_x - 0.6, 0.16)
  set key center center horizontal samplen 2 width 1
  plot [0:1] [0:1] for [m = 1:n] NaN with linespoints linewidth 0.9 pointtype shape(m) \
    linecolor rgb (m == 1 ? "#000000" : colour(m - 1)) title word(method_titles, m)
  unset key
  eval note("error: root mean square over pixels by the mean; in glass, over the torus' pixels alone; ".\
    "without the truth's own, which is dotted; dashes: equal time")
  eval finish
}
