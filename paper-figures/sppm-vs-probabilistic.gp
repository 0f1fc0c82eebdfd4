# experiments: sppm-vs-probabilistic
# A row for each scene: SPPM and probabilistic photon mapping after as many iterations; 20 times their
# difference with photons of their own, and with the same photons and eye points; CPU seconds. Below:
# either's noise, what both noises make of a difference, and how much of one is the same in both seeds.
#   gnuplot -c paper-figures/sppm-vs-probabilistic.gp RESULTS_DIR   reads images/*.csv and timing.csv,
#   writes figures/sppm-vs-probabilistic.*
results = ARG1
figure = "sppm-vs-probabilistic"
load system("dirname \"".ARG0."\"")."/pictures.part.gp"
scenes = "box-of-balls torus-in-glass"
titles = "'Balls in a box' 'Torus in glass'"
white = "5 5" # of the mean
kinds = "sppm probabilistic"
kind_titles = "'SPPM' 'probabilistic'"
factor = 20

# Cells 2 k - 1 and 2 k of a scene are kind k with the first and the second seed.
array picture[8]
array took[8]
array white_at[2]
array noise[4]
array own[2]
array same[2]
array systematic[2]
do for [s = 1:2] {
  # The film of quality paper has a scene of its own.
  scene = word(scenes, s)
  if (missing eq "" && cells("scene:".scene) eq "") { missing = ""; scene = scene."-512" }
  do for [k = 1:2] {
    both = cells("integrator:".word(kinds, k)." scene:".scene)
    eval check
    if (words(both) != 2) { print results.": ".word(kinds, k)." of ".scene." is not there twice"; exit status 1 }
    do for [seed = 1:2] {
      c = int(word(both, seed))
      n = last(averages(c))
      picture[4 * (s - 1) + 2 * (k - 1) + seed] = image(c, n)
      took[4 * (s - 1) + 2 * (k - 1) + seed] = seconds(c, n)
      eval check
    }
  }
  sppm = picture[4 * s - 3]; sppm_again = picture[4 * s - 2]
  other = picture[4 * s - 1]; other_again = picture[4 * s]
  eval sizes(sppm)
  white_at[s] = mean * word(white, s)
  eval compare(sppm, sppm_again, sppm_again)
  noise[2 * s - 1] = sqrt(mean_square / 2) / mean
  eval compare(other, other_again, other_again)
  noise[2 * s] = sqrt(mean_square / 2) / mean
  eval compare(sppm, other_again, other_again)
  own[s] = sqrt(mean_square) / mean
  eval compare(sppm, other, other)
  same[s] = sqrt(mean_square) / mean
  eval covary(sppm, other, sppm_again, other_again)
  systematic[s] = root(mean_square) / mean
}

paper_x = 7.2; paper_y = 3.66
left(column) = 0.22 + 1.36 * (column - 1)
top(row) = 0.2 + 1.62 * (row - 1)
do for [name in terminals] {
  eval terminal(name)
  do for [s = 1:2] {
    first = 4 * (s - 1)
    eval sizes(picture[first + 1])
    eval bare
    eval whole
    exposure = 1 / white_at[s]
    do for [k = 1:2] {
      eval place(left(k), top(s), 1.3, 1.3)
      if (s == 1) { set title word(kind_titles, k) offset 0,-0.8 }
      if (k == 1) { set label 1 word(titles, s) at graph -0.06,0.5 center rotate by 90 }
      set xlabel "noise ".percent(noise[2 * (s - 1) + k]) offset 0,0.4
      eval draw(picture[first + 2 * k - 1])
    }
    eval place(left(3), top(s), 1.3, 1.3)
    if (s == 1) { set title "20× difference" offset 0,-0.8 }
    set xlabel percent(own[s])."; both noises: ".percent(sqrt(noise[2 * s - 1]**2 + noise[2 * s]**2)) offset 0,0.4
    eval draw_signed(picture[first + 1], picture[first + 4])
    eval place(left(4), top(s), 1.3, 1.3)
    if (s == 1) { set title "20×, the same photons" offset 0,-0.8 }
    set xlabel percent(same[s])."; in both seeds: ".percent(systematic[s]) offset 0,0.4
    eval draw_signed(picture[first + 1], picture[first + 3])
    # ---- time ----
    eval bare
    eval axes
    eval place(left(5) + 0.3, top(s), 1.0, 1.3)
    unset grid
    most = 0
    do for [j = first + 1:first + 4] { most = took[j] > most ? took[j] : most }
    set xrange [0.4:2.6]
    set yrange [0:1.2 * most]
    set xtics ("SPPM" 1, "probabilistic" 2) scale 0
    set ytics autofreq
    set format y "%g"
    if (s == 1) { set title "CPU seconds" offset 0,-0.8 }
    unset xlabel
    set boxwidth 0.35
    set style fill solid 1 noborder
    set print $bars
    do for [j = 1:4] { print sprintf("%g,%g,%d", 0.62 + 0.38 * j + 0.24 * (j > 2), took[first + j], j > 2 ? 0xD55E00 : 0x0072B2) }
    unset print
    plot $bars using 1:2:3 with boxes linecolor rgb variable, \
      $bars using 1:2:(sprintf("%.2g", $2)) with labels offset 0,0.6 font ",7"
  }
  # ---- what the colours and numbers are ----
  eval bare
  eval note(n." iterations, two seeds. Orange: SPPM is brighter; blue: the other. %: root mean squares over pixels, of the mean. ".\
    "All light but the lamp itself.")
  eval finish
}
