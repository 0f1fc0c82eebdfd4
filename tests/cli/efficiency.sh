#!/bin/bash
# photonlab efficiency: errors as `compare` measures them, the same bits by any number of threads, and
# what it cannot race refused.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

cat >"$scratch/race.yaml" <<'YAML'
scene: scenes/glass-and-mirror.pbrt
runs: 1
radius: 0.2
photons: 300
iterations: 4
images: [1, 2, 4]
probes: [[32, 32]]
quantity: none
reference: none
depth: 4
parts:
  - {integrator: path, runs: 3, iterations: 48, images: [48], seed: truth}
  - {integrator: path, seed: [path-1, path-2]}
  - {alpha: 1/2, seed: [half-1, half-2]}
  - {alpha: 2/3, seed: [two-thirds-1, two-thirds-2]}
YAML

race() { # race NAME THREADS
  "$photonlab" run "$scratch/race.yaml" --quiet --threads "$2" -o "$scratch/$1" >/dev/null &&
    "$photonlab" efficiency "$scratch/$1" >"$scratch/$1.out"
}
check 'an experiment of methods and a reference is raced' race one 1
check 'by two threads, too' race two 2
check 'errors are the same bits' cmp "$scratch/one/errors.csv" "$scratch/two/errors.csv"
check 'and so is what is known of references' cmp "$scratch/one/references.csv" "$scratch/two/references.csv"
check 'methods of one integrator are told apart by what differs' \
  grep -q '^  probabilistic 0.667  *4 ' "$scratch/one.out"

# The reference is one image: `compare` against it gives the same numbers.
expected() { # expected CELL N
  "$photonlab" compare "$scratch"/one/images/*-cell000-48.exr \
    "$scratch"/one/images/*-cell"$(printf %03d "$1")"-"$2".exr | awk '$1 == "relmse" { print $2 }'
}
same_error() { # same_error CELL N
  awk -F, -v cell="$1" -v n="$2" -v expected="$(expected "$1" "$2")" '
    $3 == cell && $4 == n { found = 1; exit !(($5 / expected - 1) ^ 2 < 1e-10) }
    END { if (!found) exit 1 }' "$scratch/one/errors.csv"
}
check 'errors are those of compare' same_error 1 4
check 'at each N and seed' same_error 4 2
check 'three seeds of no cell are missing' test "$(wc -l <"$scratch/one/errors.csv")" = 19 # 3 x 2 x 3

# 1 / (error x time) at one time for all.
check 'efficiency is what its columns say' awk -F, '
  NR == 1 { next }
  { n++; at[$3]++; if (($6 * $4 * $3 - 1) ^ 2 > 1e-12) exit 1 }
  END { for (t in at) times++; exit !n || times != 1 }' "$scratch/one/efficiency.csv"

refused() { # refused SED-SCRIPT: the table's message
  sed "$1" "$scratch/race.yaml" >"$scratch/bad.yaml"
  "$photonlab" run "$scratch/bad.yaml" --quiet -o "$scratch/bad" >/dev/null
  ! "$photonlab" efficiency "$scratch/bad" 2>&1 >/dev/null
}
check 'shared photons are no time of one alone' \
  grep -q 'shares its photons with others' <(refused 's/two-thirds/half/g')
check 'methods need a reference' grep -q 'a reference is one cell' <(refused '/truth/d')
check 'and more than one seed' grep -q 'at least two seeds' <(refused 's/, path-2//')
done_testing
