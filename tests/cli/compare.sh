#!/bin/bash
# photonlab compare: metrics with their definitions, standard errors over independent runs only.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

picture() { # picture NAME SEED PHOTONS: of the Gaussian beam
  "$photonlab" render scenes/plane-gaussian-beam.pbrt -o "$scratch/$1.pfm" --quiet \
    --integrator probabilistic --radius 0.3 --photons "$3" --iterations 2 --seed "$2" >/dev/null
}
picture reference 1 4000
for k in 2 3 4; do picture "run$k" $k 400; done
picture again 2 400

of() { "$photonlab" compare "$scratch/reference.pfm" "${@/#/$scratch/}"; }
one=$(of run2.pfm)
check 'one image has its errors, and their definitions' \
  test "$(grep -cE '^(mse|relmse|smape) +[0-9.e-]+   mean of ' <<<"$one")" = 3
several=$(of run2.pfm run3.pfm run4.pfm)
check 'several have means and standard errors' \
  test "$(grep -cE '^(mse|relmse|smape) +[0-9.e-]+ \+- [0-9.e-]+   mean of ' <<<"$several")" = 3
# mean and SE of three values, from those of each image alone
each() { for k in 2 3 4; do of "run$k.pfm" | awk '$1 == "mse" { print $2 }'; done; }
check 'which are those of the images, not of their pixels' awk '
  NR == FNR { if ($1 == "mse") { mean = $2; se = $4 } next }
  { sum += $1; square += $1 * $1 }
  END {
    expected = sqrt((square - sum * sum / 3) / 2 / 3)
    print mean, se, sum / 3, expected
    exit !(se > 0 && (mean * 3 / sum - 1) ^ 2 < 1e-8 && (se / expected - 1) ^ 2 < 0.01)
  }' <(echo "$several") <(each)
same=$(! of run2.pfm run3.pfm again.pfm 2>&1)
check 'two runs of one seed are refused' \
  grep -q 'run2.pfm and .*again.pfm have the same errors to the last bit' <<<"$same"
check_fails 'and so they fail' of run2.pfm again.pfm
check 'a reference has no error' grep -q '^mse *0 ' <(of reference.pfm)
check_fails 'an image is needed' of
done_testing
