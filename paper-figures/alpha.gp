# experiments: alpha
# Variance and |bias| of the average of N iterations against N, one curve an alpha: of probabilistic
# in alpha.*, of ppm and sppm, whose radii follow the photons found, in alpha-ppm.* and alpha-sppm.*.
#   gnuplot -c paper-figures/alpha.gp RESULTS_DIR     reads curves.csv, writes figures/alpha*.*
part = system("dirname \"".ARG0."\"")."/convergence.part.gp"
results = ARG1
scenes = "plane-uniform-beam plane-quadratic-beam plane-point-light cornell-box"
names = "'Uniform light' 'Quadratic light' 'Point light' 'Cornell box'"
figure = "alpha"
only = "probabilistic"
slopes = 1
load part
scenes = "plane-uniform-beam plane-quadratic-beam plane-point-light"
names = "'Uniform light' 'Quadratic light' 'Point light'"
figure = "alpha-ppm"
only = "ppm"
load part
figure = "alpha-sppm"
only = "sppm"
load part
