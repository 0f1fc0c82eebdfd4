# experiments: numerical-stability
# Relative error against stress, with the bound of each: parts alone and whole scenes, beside ways not taken.
#   gnuplot -c paper-figures/numerical-stability.gp RESULTS_DIR   reads stability.csv, writes figures/numerical-stability.*
results = ARG1
if (results eq "") { print "usage: gnuplot -c numerical-stability.gp RESULTS_DIR"; exit status 2 }
data = results."/stability.csv"
quoted(path) = "'".system("printf %s \"".path."\" | sed \"s/'/'\\\\\\\\''/g\"")."'"
if (system("head -n 1 ".quoted(data)." 2>/dev/null") ne "family,what,stress,error,bound,verdict") {
  print data.": missing, or not as experiments/numerical-stability.sh writes it"
  exit status 1
}
if (system("mkdir -p ".quoted(results."/figures")." && echo made") ne "made") {
  print results."/figures: cannot make this directory"
  exit status 1
}

# Of the rows of a family whose `what` matches, at each stress: the largest error and bound.
least = 1e-18 # where no error is drawn
rows(family, what) = sprintf("< awk -F, '$1 == \"%s\" && $2 ~ /%s/ && $4 ~ /^[0-9]/ { x = $3 + 0; n[x]++; \
  if ($4 + 0 > e[x]) e[x] = $4 + 0; if ($5 + 0 > b[x]) b[x] = $5 + 0 } END { for (x in n) \
  printf \"%%.9g %%.9g %%.9g\\n\", x, (e[x] > 0 ? e[x] : %g), (b[x] > 0 ? b[x] : \"nan\") }' %s | sort -g", family, what, least, quoted(data))
refused(family) = sprintf("< awk -F, '$1 == \"%s\" && $6 == \"refused\" { print $3 }' %s", family, quoted(data))
count(verdict) = int(system(sprintf("awk -F, '$6 == \"%s\"' %s | wc -l", verdict, quoted(data))))
if (count("ok") == 0) { print data.": nothing is within its bound"; exit status 1 }

# Differences of lgamma at alpha = 2/3, against the expansion in w = i + alpha / 2, right to 1e-12 from 1000 on.
a = 2. / 3
expansion(i) = (i + a / 2) ** (a - 1) / gamma(1 + a) * (1 - a * (1 - a) * (2 - a) / (24 * (i + a / 2) ** 2))
differences(i) = abs(exp(lgamma(i + a) - lgamma(1 + a) - lgamma(i + 1)) / expansion(i) - 1)

panels = "law alpha sums moments rim scale light moved"
blue = "#0072B2"; green = "#009E73"; red = "#D55E00"; purple = "#CC79A7"; gray = "#999999"; dark = "#555555"
paper_x = 7.2; paper_y = 5
do for [terminal_name in "pdf svg png"] {
  if (terminal_name eq "pdf") { set terminal pdfcairo enhanced font "Helvetica,8" size paper_x,paper_y }
  if (terminal_name eq "svg") { set terminal svg enhanced font "Helvetica,11" \
    size 140 * paper_x,140 * paper_y background "white" }
  if (terminal_name eq "png") { set terminal pngcairo enhanced font "Helvetica,8" \
    size 250 * paper_x,250 * paper_y fontscale 2.2 linewidth 2.2 pointscale 2.2 }
  set output results."/figures/numerical-stability.".terminal_name
  set pointsize 0.35
  set multiplot
  set border 3 linewidth 0.6 linecolor "#444444"
  set grid xtics ytics linecolor "#E4E4E4" linewidth 0.4 linetype 1
  set tics scale 0.5,0 nomirror font ",7"
  set logscale xy
  set yrange [least / 3:30]
  set format x "10^{%T}"
  set key font ",6.5" samplen 1.2 spacing 1 left top Left reverse at graph 0.0,-0.25 vertical maxcols 1 width -4
  do for [p = 1:8] {
    column = (p - 1) % 4; line = (p - 1) / 4
    set lmargin at screen 0.065 + 0.238 * column
    set rmargin at screen 0.065 + 0.238 * column + 0.195
    set tmargin at screen 0.95 - 0.475 * line
    set bmargin at screen 0.95 - 0.475 * line - 0.265
    set ytics nomirror 1e4 format (column ? "" : "10^{%T}")
    set ytics add ((column ? "" : "0") least)
    set ytics nomirror
    set ylabel column ? "" : "relative error" offset 1.2,0 font ",7.5"
    set xlabel offset 0,0.7 font ",7.5"
    set title offset 0,-0.7 font ",8"
    set xtics nomirror
    unset object
    unset label
    if (p == 1) {
      set title "radius law"
      set xlabel "iteration i"
      set xrange [5:3e15]; set xtics 1,1e5
      plot rows("law", "closed form") using 1:2 with linespoints pointtype 7 linecolor rgb blue title "closed form, six alphas", \
        "" using 1:3 with lines dashtype 2 linecolor rgb blue title "its bound", \
        rows("law", "in double") using 1:2 with linespoints pointtype 6 linecolor rgb dark title "recurrence in double", \
        rows("law", "in float") using 1:2 with linespoints pointtype 4 linecolor rgb gray title "recurrence in float", \
        [1e4:1e15] differences(x) with lines linecolor rgb gray dashtype 3 title "differences of lgamma"
    }
    if (p == 2) {
      set title "alpha to 0 and to 1"
      set xlabel "distance x of alpha from 0 or 1"
      set xrange [3e-1:3e-17]; set xtics ("10^{-1}" 1e-1, "10^{-5}" 1e-5, "10^{-10}" 1e-10, "10^{-15}" 1e-15)
      plot rows("alpha", "rho_1000") using 1:2 with linespoints pointtype 7 linecolor rgb blue title "{/Symbol r}_{1000}", \
        rows("alpha", "sum of 1") using 1:2 with linespoints pointtype 5 linecolor rgb green title "sum of 1/{/Symbol r}", \
        rows("alpha", "sum of rho;") using 1:2 with linespoints pointtype 9 linecolor rgb red title "sum of {/Symbol r}", \
        "" using 1:3 with lines dashtype 2 linecolor rgb red title "its bound", \
        rows("alpha", "stands") using 1:2 with linespoints pointtype 4 linecolor rgb gray title "sum of {/Symbol r} as in books"
    }
    if (p == 3) {
      set title "sums"
      set xlabel "terms n"
      set xrange [500:2e9]; set xtics 1e3,1e3
      plot rows("sums", "^photons of a disc") using 1:2 with linespoints pointtype 7 linecolor rgb blue title "photons of a disc", \
        rows("sums", "iterations") using 1:2 with linespoints pointtype 5 linecolor rgb green title "iterations of a run", \
        "" using 1:3 with lines dashtype 2 linecolor rgb green title "its bound: random rounding", \
        rows("sums", "equal") using 1:2 with linespoints pointtype 9 linecolor rgb red title "equal photons", \
        "" using 1:3 with lines dashtype 2 linecolor rgb red title "its bound: all one way", \
        rows("sums", "^in float") using 1:2 with linespoints pointtype 4 linecolor rgb gray title "in float"
    }
    if (p == 4) {
      set title "moments over runs"
      set xlabel "mean / standard deviation, or / bias"
      set xrange [5:2e12]; set xtics 1e3,1e3
      plot rows("moments", "^variance of runs") using 1:2 with linespoints pointtype 7 linecolor rgb blue title "variance", \
        "" using 1:3 with lines dashtype 2 linecolor rgb blue title "its bound", \
        rows("moments", "bias of runs") using 1:2 with linespoints pointtype 5 linecolor rgb green title "bias", \
        "" using 1:3 with lines dashtype 2 linecolor rgb green title "its bound", \
        rows("moments", "squares") using 1:2 with linespoints pointtype 4 linecolor rgb gray title "variance by squares", \
        rows("moments", "floats") using 1:2 with linespoints pointtype 8 linecolor rgb gray title "bias by floats"
    }
    if (p == 5) {
      set title "rim of a disc"
      set xlabel "distance from the origin / r"
      set xrange [0.5:2e8]; set xtics 1,1e2
      plot rows("rim", "grid") using 1:2 with linespoints pointtype 7 linecolor rgb blue title "photons by the grid", \
        rows("rim", "tree") using 1:2 with points pointtype 6 pointsize 0.7 linecolor rgb green title "photons by the tree", \
        rows("rim", "squares") using 1:2 with linespoints pointtype 4 linecolor rgb gray title "a^2 - 2 a b + b^2"
    }
    if (p == 6 || p == 7) {
      family = word(panels, p)
      set title p == 6 ? "scenes scaled" : "light scaled"
      set xlabel "factor"
      if (p == 6) { set xrange [2e-7:5e6]; set xtics 1e-6,1e3 } else { set xrange [1e-13:1e13]; set xtics 1e-12,1e6 }
      plot rows(family, "cornell-box; mean") using 1:2 with linespoints pointtype 7 linecolor rgb blue title "mean, triangles", \
        "" using 1:3 with lines dashtype 2 linecolor rgb blue title "its bound", \
        rows(family, "glass-ball; mean") using 1:2 with linespoints pointtype 5 linecolor rgb green title "mean, quadrics", \
        rows(family, "plane-point-light; rate") using 1:2 with linespoints pointtype 9 linecolor rgb red title "rate of the variance", \
        rows(family, "bits") using 1:2 with points pointtype 2 pointsize 0.6 linecolor rgb purple title "bits, powers of two"
    }
    if (p == 8) {
      set title "scenes moved, to 10^6"
      set xlabel "last r / spacing of floats"
      set xrange [3e6:1e-2]; set xtics ("10^6" 1e6, "10^4" 1e4, "100" 1e2, "1" 1, "0.01" 1e-2)
      set object 1 rectangle from 100, graph 0 to 1e-2, graph 1 fillcolor "#F3E6DF" fillstyle solid noborder behind
      set label 1 "refused" at graph 0.80, graph 0.5 center font ",7" textcolor rgb red
      plot rows("moved", "cornell-box; mean") using 1:2 with linespoints pointtype 7 linecolor rgb blue title "mean, triangles", \
        "" using 1:3 with lines dashtype 2 linecolor rgb blue title "its bound", \
        rows("moved", "glass-ball; mean") using 1:2 with linespoints pointtype 5 linecolor rgb green title "mean, quadrics", \
        rows("moved", "plane-point-light; rate") using 1:2 with linespoints pointtype 9 linecolor rgb red title "rate of the variance", \
        rows("radius", "float") using 1:2 with linespoints pointtype 4 linecolor rgb gray title "photons in float", \
        refused("moved") using 1:(3e-17) with points pointtype 2 pointsize 0.6 linecolor rgb red notitle
    }
  }
  unset tics; unset xlabel; unset ylabel; unset title; unset grid; unset object; unset label; unset logscale
  set border 0
  set key off
  set lmargin at screen 0; set rmargin at screen 1; set bmargin at screen 0; set tmargin at screen 0.1
  set label 1 "coloured: what photonlab computes, at 0 where nothing is wrong; dashed: bounds; gray: ways not taken; crosses at 0: powers of two, which must have the same bits" \
    at screen 0.5,0.032 center font ",6.5" textcolor "#444444"
  set label 2 sprintf("%d values within their bounds, %d runs or radii refused with the limit they would meet, %d beyond; counters to 2^{40}, slivers and surfaces that coincide have no error", \
    count("ok"), count("refused"), count("FAIL")) at screen 0.5,0.012 center font ",6.5" textcolor "#444444"
  plot [0:1] [0:1] NaN notitle
  unset label
  unset multiplot
  set output
}
