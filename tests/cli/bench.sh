#!/bin/bash
# The benchmark program: what it writes is well-formed and can be compared. No time is judged.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

csv=$scratch/bench.csv
# bench BENCH FILE, one repetition
bench() { make -s bench BENCH="$1" REPETITIONS=1 FIGURES="$2"; }
well_formed() { # every line as many fields as the header, a positive value, low <= high
  awk -F, '/^#/ { said++; next }
    !fields { fields = NF; next }
    NF != fields || !($5 > 0) || $6 > $7 { bad = 1 }
    { rows++ }
    END { exit bad || rows != '"$2"' || said < 5 }' "$1"
}
check 'one row is timed' bench random/scalar "$csv"
check 'its CSV describes the machine and has the row' well_formed "$csv" 1
check_fails 'a row that is not there is said to be missing' bench none/such "$scratch/none.csv"
better() { tests/bench/compare "$csv" "$csv" | grep -q 'random/scalar .* 1.00 *1.00'; }
check 'a run compared with itself is as fast' better
check 'what a skip saves is timed, after it was seen to change nothing' bench skip/last-bounce "$csv"
check 'with it and without it' well_formed "$csv" 4
done_testing
