#!/bin/bash
# Numerical hazards (theory 7): errors under stress stay within their bounds, and a run that would
# reach a limit of number is refused in one line that names the limit.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

stress=$scratch/stress.csv
check 'every error under stress is within its bound' "$photonlab" validate stability -o "$stress"
verdicts() { awk -F, -v family="$1" -v verdict="$2" '$1 == family && $6 == verdict { n++ }
  END { exit !n }' "$stress"; }
for family in law alpha sums counters moments rim 'small discs'; do
  check "the table has $family" verdicts "$family" ok
done
check 'radii too small for the scene are refused' verdicts 'small discs' refused
check 'no level fails' test "$(grep -c FAIL "$stress")" = 0
check_fails 'an unknown part is refused' "$photonlab" validate stabilty
check_fails '-o is for the levels' "$photonlab" validate -o "$scratch/none.csv"

run() { # run KEYS: an experiment with these keys
  { printf 'scene: scenes/cornell-box.pbrt\nquantity: none\nreference: none\nprobes: [[32, 58]]\n'
    printf '%s\n' "$@"; } >"$scratch/run.yaml"
  rm -rf "$scratch/run"
  "$photonlab" run "$scratch/run.yaml" -o "$scratch/run" --quiet 2>&1
}
refused() { # refused WHAT MESSAGE KEYS: it ends with status 1 and this one line
  local output status=0
  output=$(run "${@:3}") || status=$?
  if [ $status = 1 ] && [ "$(wc -l <<<"$output")" = 1 ] && grep -qE -- "$2" <<<"$output"; then
    ok "$1 is refused"
  else
    not_ok "$1 is refused" "status $status: $output"
  fi
}
measured() { # measured WHAT KEYS: it runs, and every number of the log is finite
  local output status=0
  output=$(run "${@:2}") || status=$?
  if [ $status = 0 ] && ! grep -qiE 'nan|inf' "$scratch/run/log.csv"; then
    ok "$1 is measured"
  else
    not_ok "$1 is measured" "status $status: $output"
  fi
}
refused 'a radius below 100 spacings of floats' 'radius .* too small .* coordinates up to 2' \
  'radius: 2e-5' 'photons: 10' 'iterations: 1' 'runs: 2'
refused 'a last radius below them' 'radius .* too small' \
  'radius: 3e-5' 'alpha: 0' 'photons: 10' 'iterations: 100' 'runs: 2'
for radius in 0 -0.1 nan inf 1e400 5e-324; do
  refused "a radius of $radius" 'radius' "radius: $radius" 'photons: 10' 'iterations: 1' 'runs: 2'
done
for alpha in -0.1 1.0000001 nan; do
  refused "alpha = $alpha" 'alpha' "alpha: $alpha" 'radius: 0.1' 'photons: 10' 'runs: 2'
done
refused 'a second radius of zero' 'second radius is zero' \
  'integrator: sppm' 'law: pbrt' 'alpha: 0' 'radius: 0.1' 'photons: 10' 'runs: 2'
refused 'photons beyond memory' 'photons' 'photons: 1e12' 'radius: 0.1' 'iterations: 1' 'runs: 2'
measured 'one photon, iteration and run' 'photons: 1' 'iterations: 1' 'runs: 1' 'radius: 0.1'
measured 'alpha = 0' 'alpha: 0' 'photons: 100' 'iterations: 9' 'runs: 2' 'radius: 0.1'
measured 'alpha = 1' 'alpha: 1' 'photons: 100' 'iterations: 9' 'runs: 2' 'radius: 0.1'
measured 'a radius of 1e6 scenes' 'radius: 1e6' 'photons: 100' 'iterations: 2' 'runs: 2'
measured 'a radius of 1e150' 'radius: 1e150' 'photons: 100' 'iterations: 2' 'runs: 2'
for reference in pixel ray-differentials knn; do
  refused "a radius of 1e-6 by $reference" 'probe \[32, 58\]: radius .* too small' \
    "reference-radius: $reference" 'radius: 1e-6' 'photons: 1000' 'iterations: 2' 'runs: 2'
  measured "a radius of 1 by $reference" \
    "reference-radius: $reference" 'radius: 1' 'photons: 1000' 'iterations: 2' 'runs: 2'
done
refused 'a radius whose square is beyond all numbers' 'radius 1e\+155 is too large' \
  'radius: 1e155' 'photons: 10' 'iterations: 1' 'runs: 2'

# Every test, plant and stress that is said to catch a hazard is there.
hazards=experiments/numerical-stability.hazards
catches() { # of "FILE NAME", "PATCH" or "stress: FAMILY"
  case $1 in
  'stress: '*) grep -qE "^${1#stress: }," "$stress" ||
    grep -qE "measure ${1#stress: } " experiments/numerical-stability.sh ;;
  *.patch) test -s "$1" ;;
  *) grep -qw -- "${1##* }" "${1%% *}" ;;
  esac
}
while read -r catcher; do
  check "there is $catcher" catches "$catcher"
done < <(awk '!/^(#|hazard )/ { print substr($0, 62) }' $hazards | tr ';' '\n' | sed 's/^ *//' | sort -u)
done_testing
