# What figures of pictures share (".part" because an experiment's own figure is NAME.gp). Loaded with
#   results, figure   the directory, and the name of figures/FIGURE.* in it
# set. Files are found, and errors kept in mind until the first `eval check`, by
#   cells("scene:torus integrator:sppm")   numbers of the cells with these keys in manifest.json
#   averages(cell)                         the N of its images
#   image(cell, n)                         a file of x,y,R,G,B; n may be "single-10"
#   seconds(group, n)                      CPU seconds until there; a cell whose photons no other
#                                          shares is a group of its own, numbered in the same order
# A command with an argument is a function that returns it: `eval draw(file)`. Lengths are inches.

# ---- inputs: gnuplot itself exits 0 when data are missing ----
if (results eq "") { print "usage: gnuplot -c ".figure.".gp RESULTS_DIR"; exit status 2 }
set datafile separator comma
quoted(path) = "'".system("printf %s \"".path."\" | sed \"s/'/'\\\\\\\\''/g\"")."'"
here = quoted(results)
missing = ""
found(text, what) = (missing = missing eq "" && text eq "" ? what : missing, text)
check = 'if (missing ne "") { print results.": no ".missing; exit status 1 }'
cells(keys) = found(system("cat ".here."/manifest.json 2>/dev/null | awk -v keys='".keys."' ".\
  "'BEGIN { n = split(keys, key, \" \") } { gsub(/[ \",]/, \"\") } ".\
  "{ for (k = 1; k <= n; k++) same += $0 == key[k] } /^cell:/ { cell = substr($0, 6) } ".\
  "/^}/ { if (same == n) print cell; same = 0 }'"), "cell with ".keys)
cell(keys) = int(word(cells(keys)." -1", 1))
averages(c) = found(system(sprintf("cd %s/images 2>/dev/null && ls | ".\
  "sed -n 's/.*-cell%03d-\\([0-9]*\\)\\.csv$/\\1/p' | sort -n", here, c)), sprintf("image of cell %d", c))
image(c, n) = found(system(sprintf("ls %s/images/*-cell%03d-%s.csv 2>/dev/null", here, c, "".n)), \
  sprintf("image of cell %d after %s", c, "".n))
seconds(g, n) = real("0".found(system(sprintf("cat %s/timing.csv 2>/dev/null | awk -F, ".\
  "'$1 == \"%d\" && $6 == \"%s\" { s += $10; n++ } END { if (n) print s }'", here, g, "".n)), \
  sprintf("time of group %d after %s", g, "".n)))
last(list) = word(list, words(list))
if (system("mkdir -p ".here."/figures && echo made") ne "made") {
  print results."/figures: cannot make this directory"
  exit status 1
}

# ---- numbers: means over pixels and channels; ranges would leave some out ----
every = "set xrange [*:*]; set yrange [*:*]; unset logscale; "
beside(files) = "< paste -d, ".files # quoted; k-th file's colours: columns 5 k - 2 to 5 k
times(k) = (column(k) - column(k + 5)) * (column(k + 10) - column(k + 15))
# The picture's width and height in pixels, and its mean.
sizes(file) = (subject = file, every."stats subject skip 1 using 1:2 nooutput; ".\
  "width = STATS_max_x + 1; height = STATS_max_y + 1; ".\
  "stats subject skip 1 using (($3 + $4 + $5) / 3) nooutput; mean = STATS_mean")
# mean_square of (a - b) (c - d): what two differences have in common. compare(file, one, other) is its error:
# two independent references' own noise cancels and leaves a standard error of at most square_error; with one
# reference twice it is the mean square difference.
covary(a, b, c, d) = (subject = beside(quoted(a)." ".quoted(b)." ".quoted(c)." ".quoted(d)), \
  every."stats subject skip 1 using ((times(3) + times(4) + times(5)) / 3) nooutput; ".\
  "mean_square = STATS_mean; square_error = STATS_stddev / sqrt(STATS_records)")
compare(file, one, other) = covary(file, one, file, other)
root(square) = square >= 0 ? sqrt(square) : NaN
root_error(square, error) = error / (2 * root(square)) # of the root, from that of the square
percent(v) = sprintf(v < 0.995 ? "%.2g %%" : "%.0f %%", 100 * v)

# ---- one tone curve: `exposure` times radiance, sRGB's curve ----
curve(c) = c <= 0.0031308 ? 12.92 * c : 1.055 * c**(1 / 2.4) - 0.055
clipped(c) = c < 0 ? 0 : c > 1 ? 1 : c
tone(c) = 255 * curve(clipped(c))
expose_mean = "exposure = 1 / (3 * mean)" # shows the mean as a third

# ---- pictures: sizes(file) of one of them comes first ----
as_image = "with rgbimage; unset label 1"
draw(file) = (subject = file, "plot subject skip 1 using 1:(height - 1 - $2):".\
  "(tone(exposure * $3)):(tone(exposure * $4)):(tone(exposure * $5)) ".as_image)
# `factor` times the difference in the same tones, by colour; and of the mean of the colours, from white,
# where nothing differs, to orange, where `one` is larger, or blue (Okabe and Ito's).
pair(one, other) = (subject = beside(quoted(one)." ".quoted(other)), "plot subject skip 1 using 1:(height - 1 - $2):")
absolute(k) = tone(exposure * factor * abs(column(k) - column(k + 5)))
draw_absolute(one, other) = pair(one, other)."(absolute(3)):(absolute(4)):(absolute(5)) ".as_image
excess(k) = (column(k) + column(k + 1) + column(k + 2) - column(k + 5) - column(k + 6) - column(k + 7)) / 3
shade(high, low) = 255 - tone(factor * exposure * abs(excess(3))) * (1 - (excess(3) > 0 ? high : low) / 255.)
draw_signed(one, other) = pair(one, other)."(shade(213, 0)):(shade(94, 114)):(shade(0, 178)) ".as_image
# Everything, or the pixels from (x, y) on, counted from the top left; and a frame around these.
whole = "set xrange [-0.5:width - 0.5]; set yrange [-0.5:height - 0.5]"
crop(x, y, w, h) = sprintf("set xrange [%g:%g]; set yrange [%g:%g]", x - 0.5, x + w - 0.5, \
  height - y - h - 0.5, height - y - 0.5)
mark(tag, x, y, w, h, colour) = sprintf("set object %d rectangle from %g,%g to %g,%g front fillstyle empty ".\
  "border linecolor rgb '%s' linewidth 1", tag, x - 0.5, height - y - h - 0.5, x + w - 0.5, height - y - 0.5, colour)

# ---- the page: paper_x, paper_y are set by the figure ----
place(x, y, w, h) = sprintf("set lmargin at screen %.6f; set rmargin at screen %.6f; ".\
  "set tmargin at screen %.6f; set bmargin at screen %.6f", \
  x / real(paper_x), (x + w) / real(paper_x), 1 - y / real(paper_y), 1 - (y + h) / real(paper_y))
bare = "unset logscale; unset tics; unset key; unset xlabel; unset ylabel; unset title; unset grid; ".\
  "set border 0; set size noratio"
axes = "set border 3 linewidth 0.6 linecolor '#444444'; set xtics scale 0.6,0.3 nomirror; ".\
  "set ytics scale 0.6,0.3 nomirror; set grid xtics ytics linecolor '#DDDDDD' linewidth 0.4 linetype 1, linetype 1"
colour(k) = word("#0072B2 #D55E00 #009E73 #CC79A7 #E69F00 #56B4E9", k)
shape(k) = int(word("7 5 9 13 11 15", k))
# A line of small print at the bottom.
note(text) = (subject = text, place(0, paper_y - 0.2, paper_x, 0.2)."; set label 1 subject at graph 0.5,0.5 center ".\
  "textcolor '#444444' font ',7'; plot [0:1] [0:1] NaN; unset label 1")
terminals = "pdf svg png"
terminal(name) = (name eq "pdf" ? "set terminal pdfcairo enhanced font 'Helvetica,8' size paper_x,paper_y" : \
  name eq "svg" ? "set terminal svg enhanced font 'Helvetica,11' size 140 * paper_x,140 * paper_y background 'white'" : \
  "set terminal pngcairo enhanced font 'Helvetica,8' size 300 * paper_x,300 * paper_y ".\
  "fontscale 2.6 linewidth 2.6 pointscale 2.6")."; set output results.'/figures/'.figure.'.".name."'; set multiplot"
finish = "unset multiplot; set output"
