# experiments: media-analytic
# Variance and |bias| of the average of N iterations against N in fog, one curve an alpha: photon points,
# whose law shrinks r^3, photon beams, whose law shrinks r, and points where a wall ends the ray.
#   gnuplot -c paper-figures/media-analytic.gp RESULTS_DIR   reads curves.csv, writes figures/media-analytic.*
part = system("dirname \"".ARG0."\"")."/convergence.part.gp"
results = ARG1
scenes = "fog-beam fog-slab fog-furnace"
names = "'Points, d = 3: bias ∝ r^2' 'Beams, d = 1: bias ∝ r^2' 'Points at a wall: bias ∝ r'"
powers = "0.6666666666666667 2 0.3333333333333333"
figure = "media-analytic"
only = ""
slopes = 1
load part
