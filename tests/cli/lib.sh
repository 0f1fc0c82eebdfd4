# shellcheck shell=bash
# For tests/cli/*.sh, sourced first: they run from the project's root and print TAP.
#   check 'a sentence' COMMAND...      passes if the command does; its output is shown if not
#   check_fails 'a sentence' COMMAND...    passes if the command exits with a status of 1 to 125
#   skip 'a sentence' 'why'
#   done_testing                       prints the plan; a script that ends without it has failed
# $photonlab is the binary, $scratch a folder that is removed at the end.
set -u
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit
# shellcheck disable=SC2034 # used by the scripts
photonlab=${PHOTONLAB:-build/photonlab}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
tests=0

ok() {
  tests=$((tests + 1))
  echo "ok $tests - $1"
}

not_ok() { # not_ok NAME DETAILS
  tests=$((tests + 1))
  echo "not ok $tests - $1"
  [ -z "${2-}" ] || printf '%s\n' "$2" | sed 's/^/# /'
}

skip() { # skip NAME WHY
  tests=$((tests + 1))
  echo "ok $tests - $1 # SKIP $2"
}

check() {
  local name=$1 output status=0
  shift
  output=$("$@" 2>&1) || status=$?
  if [ $status = 0 ]; then ok "$name"; else not_ok "$name" "status $status: $*
$output"; fi
}

check_fails() { # 126 and above: not found, or killed by a signal
  local name=$1 output status=0
  shift
  output=$("$@" 2>&1) || status=$?
  if [ $status -ge 1 ] && [ $status -le 125 ]; then ok "$name"; else not_ok "$name" "status $status: $*
$output"; fi
}

done_testing() { echo "1..$tests"; }
