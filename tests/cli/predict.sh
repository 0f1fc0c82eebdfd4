#!/bin/bash
# photonlab predict: numbers of theory, lists, experiments, and what it refuses.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

# The value of a column in the row of this N.
value() { # value FILE COLUMN N
  awk -F, -v column="$2" -v n="$3" '
    NR == 1 { for (k = 1; k <= NF; k++) at[$k] = k; next }
    $at["N"] == n { print $at[column] }' "$1"
}

near() { # near MEASURED EXPECTED RELATIVE
  awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN { d = a - b; if (d < 0) d = -d; if (b < 0) b = -b
    exit !(a != "" && d <= t * b) }'
}

# One line to stderr that contains the text, and nothing to stdout.
refuses() { # refuses TEXT ARGUMENTS...
  local text=$1 status=0
  shift
  "$photonlab" predict "$@" >"$scratch/out" 2>"$scratch/err" || status=$?
  cat "$scratch/out" "$scratch/err"
  [ $status = 1 ] && [ ! -s "$scratch/out" ] && [ "$(wc -l <"$scratch/err")" = 1 ] &&
    grep -qF -- "$text" "$scratch/err"
}

csv=$scratch/one.csv
check 'predict needs no argument' "$photonlab" predict -o "$csv"
check 'S+ of 1000 iterations' near "$(value "$csv" s_plus 1000)" 164.75212587394374 1e-14
check 'S- of 1000 iterations' near "$(value "$csv" s_minus 1000)" 6777.61332683002 1e-14
check '-o and --csv write the same' cmp "$csv" <("$photonlab" predict --csv)
# The box, lambda 100 and curvature -0.1 of 65536 photons: mean 1 - 0.0125, counts are binomial.
check 'bias of the first iteration' near "$(value "$csv" bias_one 1)" -0.0125 1e-15
check 'variance of the first iteration' near "$(value "$csv" variance_one 1)" \
  "$(awk 'BEGIN { m = 1 - 0.0125; printf "%.17g", m / 100 - m * m / 65536 }')" 1e-14
check 'the straight line through the exact curve' \
  grep -q 'variance -0.6801, bias -0.3053' <("$photonlab" predict --photons 1e9 --curvature -1e-9)
check 'density, radius and photons say lambda: 0.25 pi 0.1^2 1000' \
  grep -q 'lambda 7.85398,' <("$photonlab" predict --density 0.25 --radius 0.1 --photons 1000)
check 'a Laplacian of 3 says curvature 0.12 at radius 0.2' \
  grep -q 'curvature 0.12,' <("$photonlab" predict --laplacian 3 --radius 0.2)

laws=$("$photonlab" list laws | grep -cE '^  [a-z]')
kernels=$("$photonlab" list kernels | grep -cE '^  [a-z]')
rows() { "$photonlab" predict --iterations 50 "$@" | grep -cE 'N\^-'; }
check 'all laws and kernels' test "$(rows --law all --kernel all)" = $((laws * kernels))
check 'lists cross' test "$(rows --alpha 0.5,2/3,0.8 --dimension 1,2,3 --lambda 1,10)" = 18
"$photonlab" predict experiments/alpha.yaml -o "$csv" >"$scratch/table"
check "an experiment's curves" near "$(value "$csv" s_plus 1000 | sort -n | tail -n 1)" \
  336.11024497360893 1e-13
check 'an experiment has a line for each cell and probe' \
  grep -qE '^plane-quadratic-beam +32,32 .* 245 ' "$scratch/table"
check 'and no constants where there is no closed form' \
  grep -qE '^cornell-box .* - +- +- +N\^-0.6667 +N\^-0.3333 +-0.6801 +-0.3053' "$scratch/table"

# At a shadow's edge half of the light, 0.5 / pi^2, is missing for ever, and with it half the variance,
# (0.5 / pi^2)^2 / 45 Gamma(5/3) / (4/3), 45 = 500 0.3^2; beside it the bias ends.
printf '%s\n' 'scene: scenes/plane-shadow-edge.pbrt' 'photons: 500' 'radius: 0.3' \
  'probes: [[32, 32], [40, 32], [10, 32]]' >"$scratch/edge.yaml"
"$photonlab" predict "$scratch/edge.yaml" >"$scratch/table"
check 'at an edge the bias stays' \
  grep -qE '^32,32 .* 1\.931e-05 N\^-0\.6667  -0\.02533  +-0\.6[0-9]+ +0\.0000 ' "$scratch/table"
check 'near an edge it ends' grep -qE '^40,32 .* N\^-1\.0000 ' "$scratch/table"
check 'in the dark there is nothing' grep -qE '^10,32 .* 0 +0 +0 +0 +0 +- ' "$scratch/table"

check 'alpha above 1' refuses '--alpha: 1.5 is outside [0, 1]' --alpha 0.5,1.5
check 'an unknown kernel' refuses 'did you mean box' --kernel bx
check 'an unknown law' refuses 'is unknown' --law hachi
check 'a fourth dimension' refuses '--dimension' --dimension 4
check 'an empty item of a list' refuses '--alpha: no value' --alpha 0.5,,0.7
check 'no photons in the disc' refuses 'is not positive' --lambda 0
check 'more photons in the disc than emitted' refuses 'in the first disc' --lambda 9 --photons 8
check 'a radius beyond the light' refuses 'take a smaller --radius' --laplacian -8 --radius 3
check 'numbers that overflow' refuses 'take a smaller --radius' --curvature 1e300
check 'lambda and density' refuses 'give one' --lambda 9 --density 1
check 'curvature and Laplacian' refuses 'give one' --curvature 9 --laplacian 1
check 'a law without a second radius' refuses 'has no radius' --law pbrt --alpha 0
check 'more iterations than laws promise' refuses 'out of range' --iterations 1e15
check 'no iterations' refuses 'out of range' --iterations 0
check 'a line beyond the end' refuses '--from: 2000 is beyond' --from 2000
list=$(seq -s, 1 200)
check 'lists that cross to too many' refuses 'more than' --lambda "$list" --photons "$list"
check 'options that an experiment sets' refuses '--alpha: an experiment' \
  --alpha 0.5 experiments/alpha.yaml
check 'an experiment that is not there' refuses 'nothing.yaml' nothing.yaml
check 'a file that cannot be written' refuses 'nowhere' -o nowhere/at/all.csv
done_testing
