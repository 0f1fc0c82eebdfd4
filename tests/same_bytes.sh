# shellcheck shell=bash
# For tests of TAP (tests/cli/lib.sh) that run one experiment in several ways and compare results.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "${BASH_SOURCE[0]}")/cli/lib.sh"
experiment=tests/data/experiments/bits.yaml

# measure NAME COMMAND...: the experiment by a program (or a program with an environment)
measure() {
  mkdir -p "$scratch/$1"
  check "$1 runs the experiment" "${@:2}" run $experiment --quiet -o "$scratch/$1/results"
}

# The names, with sums of the contents, of all that must not differ.
sums() {
  (cd "$scratch/$1" && find . -name log.csv -o -name probes.csv -o -name runs.csv -o -name '*.exr' -o -path '*references*.csv' |
    LC_ALL=C sort | xargs cksum)
}

same() { # same NAME: as `release`
  local name=$1
  if [ -n "$(sums release)" ] && [ "$(sums release)" = "$(sums "$name")" ]; then
    ok "$name gives the same bytes"
  else
    not_ok "$name gives the same bytes" "$(diff <(sums release) <(sums "$name"))"
  fi
}
