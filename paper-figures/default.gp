# experiments: any
# Variance and |bias| of the average of N iterations against N, one curve a cell, for an experiment
# without a figure of its own.
#   gnuplot -c paper-figures/default.gp RESULTS_DIR   reads curves.csv, writes figures/default.*
scenes = ""
names = ""
figure = "default"
only = ""
slopes = 0
results = ARG1
load system("dirname \"".ARG0."\"")."/convergence.part.gp"
