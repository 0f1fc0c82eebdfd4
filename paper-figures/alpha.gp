# experiments: alpha
# Variance and |bias| of the average of N iterations against N, one curve an alpha.
#   gnuplot -c paper-figures/alpha.gp RESULTS_DIR     reads curves.csv, writes figures/alpha.*
scenes = "plane-uniform-beam plane-quadratic-beam plane-point-light cornell-box"
names = "'Uniform light' 'Quadratic light' 'Point light' 'Cornell box'"
figure = "alpha"
slopes = 1
results = ARG1
load system("dirname \"".ARG0."\"")."/convergence.part.gp"
