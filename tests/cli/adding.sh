#!/bin/bash
# A kernel, a radius law, a reference radius and an integrator are one file's change each: the
# templates of tests/templates are added to a copy of the tree, and what is built of it lists them,
# validates them, takes them in an experiment and gives theory's values; tests loop over them.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
templates=$PWD/tests/templates
built=${photonlab%/*} && [ "$built" != build ] || built=build/release
tree=$scratch/tree
mkdir -p "$tree/build"
cp -a Makefile packages install-packages src analysis scenes tests "$tree"
cp -a build/packages "$tree/build"
(mkdir -p "$tree/$built" && cp -a "$built"/{obj,gen,libphotonlab.a} "$tree/$built") # times and all
cd "$tree" || exit

# add SENTENCE FILE COMMAND...: of all files only FILE changes, or is new
add() {
  local before changed
  before=$(sums)
  "${@:3}"
  changed=$(diff <(echo "$before") <(sums) | sed -n 's/^[<>] .* //p' | sort -u)
  if [ "$changed" = "./$2" ]; then ok "$1"; else not_ok "$1" "changed: $changed"; fi
}
sums() { find . -path ./build -prune -o -type f -exec cksum {} +; }

# As a template says: its functions above the file's table, its row at the end of the table.
add_row() { # add_row TEMPLATE FILE
  awk '
    NR == FNR {
      if (/^\/\/ The row/) at_row = 1
      if (at_row) row = /^\/\// ? row : row $0 "\n"
      else if (past_header) functions = functions $0 "\n"
      if (/^$/) past_header = 1
      next
    }
    /^\/\/ clang-format off/ { printf "%s", functions }
    /^};/ && in_table { printf "%s", row }
    { print; in_table = (in_table || / = \{$/ && /\[\]/) && !/^};/ }' "$1" "$2" >"$scratch/new"
  cat "$scratch/new" >"$2"
}

add 'a kernel is one file' src/density/kernel.lanes.c \
  add_row "$templates/kernel.c" src/density/kernel.lanes.c
add 'a radius law is one file' src/density/law.c add_row "$templates/law.c" src/density/law.c
add 'a reference radius is one file' src/estimate/reference_radius.c \
  add_row "$templates/reference_radius.c" src/estimate/reference_radius.c
add 'an integrator is one file' src/integrator/chance.c \
  cp "$templates/integrator.c" src/integrator/chance.c
tests_over_tables=("$built"/tests/{unit/{kernel,law,predict},statistical/{reference_radius,views}})
check 'all of it builds' make INSTALL=no -j2 "$photonlab" "${tests_over_tables[@]}"

# By hand: integrals of t (1 - t^4), t^3 (1 - t^4) and t (1 - t^4)^2 over [0, 1] are 1/3, 1/8, 2/15,
# so c = 3 / (2 pi), mu2 = 3/16, R = 6 / (5 pi); 2^(1/3) = 1.259921.
lists() { "$photonlab" list "$1" | grep -qE "^ +$2"; }
check 'list has the kernel, with its constants' \
  lists kernels 'quartic +1 - t\^4 +in the plane: c 0\.477465, mu2 0\.187500, R 0\.381972$'
check 'list has the law' lists laws 'delayed +\(\(i \+ 1\) / 2\)\^\(alpha - 1\)$'
check 'with its constant' lists laws 'rho_i i\^\(1 - alpha\) -> 2\^\(1 - alpha\), 1\.259921 at'
check 'list has the reference radius' lists reference-radii 'distance +the point'
check 'list has the integrator' lists integrators 'chance +path tracing'

check 'validate finds nothing wrong' "$photonlab" validate
validated() { [ "$("$photonlab" validate | grep -c "^$1.* ok$")" = "$2" ]; }
check 'it looks at the kernel in three dimensions' validated 'kernel quartic, d = ' 12
check 'it looks at the law' validated 'law delayed: ' 4

# The beam of 1 W and radius 1: E = 1 / pi, of which 1 / (2 pi) is seen; a box of radius r has
# E^2 (1 / r^2 - 1) / photons as variance. The furnace: radiance 1 everywhere.
cat >toys.yaml <<'YAML'
iterations: 300
runs: 64
seed: toys
probes: [[32, 32]]
depth: 1
parts:
  - {scene: scenes/plane-quadratic-beam.pbrt, kernel: quartic, radius: 0.8, photons: 250}
  - {scene: scenes/plane-quadratic-beam.pbrt, law: delayed, alpha: 1/2, radius: 0.7, photons: 250}
  - {scene: scenes/plane-uniform-beam.pbrt, reference-radius: distance, radius: 0.1, law: fixed,
     photons: 500}
  - {scene: scenes/white-furnace.pbrt, integrator: chance, depth: 64}
YAML
check 'an experiment takes all four' "$photonlab" run toys.yaml --quiet -o "$scratch/toys"

# of CELL COLUMN...: of every iteration alone
of() {
  awk -F, -v cell="$1" -v names="${*:2}" '
    NR == 1 { for (k = 1; k <= NF; k++) at[$k] = k; n = split(names, name, " "); next }
    $at["cell"] == cell && $at["series"] == "iteration" {
      for (k = 1; k <= n; k++) printf "%s ", $at[name[k]]
      print ""
    }' "$scratch/toys/log.csv"
}

# Within five standard errors, which are those of 64 runs each.
mean_is() { # mean_is CELL VALUE
  of "$1" mean m2 | awk -v value="$2" '
    { sum += $1; square += $2 / 63 / 64; n++ }
    END {
      mean = sum / n; se = sqrt(square) / n
      print "mean", mean, "+-", se, "of", n, "iterations, theory:", value
      exit !(n == 300 && se > 0 && se < 0.01 * value && (mean - value) ^ 2 < 25 * square / n ^ 2)
    }'
}

# The variances over 64 runs of 300 iterations are 1.0 % from their mean, 63 degrees of freedom and
# 2 / 63 / 300 each: five standard errors are 5 %, a radius wrong by 3 %.
variance_is() { # variance_is CELL VALUE
  of "$1" m2 | awk -v value="$2" '
    { sum += $1 / 63; n++ }
    END {
      print "variance", sum / n, "theory:", value
      exit !((sum / n / value - 1) ^ 2 < 25 * 2 / (63 * n))
    }'
}

check "the reference radius' mean is the irradiance seen" mean_is 2 0.0506605918
check "the reference radius is 4.288307 tenths: the variance is theory's" variance_is 2 \
  "$(awk 'BEGIN { r = 0.4288307454867612; print 0.0506605918 ^ 2 * (1 / r ^ 2 - 1) / 500 }')"
check "the integrator's mean is the furnace's" mean_is 3 1
check "the law's radius at i = 7 and alpha = 1/2 is that of rho = 1/2" awk '
  NR == 7 { print; exit !(($2 / 0.7) ^ 2 - 0.5 < 1e-12 && 0.5 - ($2 / 0.7) ^ 2 < 1e-12) }' \
  <(of 1 i radius)
agrees() { # agrees CELL: variance and bias, rates and coefficients
  awk -v cell="$1" '
    $1 == cell { n++; good += $NF == "agree"; print }
    END { exit !(n == 2 && good == 2) }' <("$photonlab" fit "$scratch/toys")
}
check 'the fit agrees with theory of the kernel' agrees 0
check 'the fit agrees with theory of the law' agrees 1
refused() { ! "$photonlab" render scenes/plane-point-light.pbrt --integrator chance -o x.exr; }
check 'the integrator refuses what it cannot meet' grep -q 'chance never meets a point light' \
  <(refused 2>&1)

check 'the tests that loop over the tables pass with all four' tests/run "${tests_over_tables[@]}"
done_testing
