#!/bin/bash
# PHOTONLAB_SIMD: what it names runs, what it cannot name is refused before anything is done.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

refused() { # refused COMMAND...: status 1, nothing printed, one line of complaint
  local status=0
  PHOTONLAB_SIMD=sse9 "$photonlab" "$@" >"$scratch/out" 2>"$scratch/error" || status=$?
  cat "$scratch/out" "$scratch/error"
  [ $status = 1 ] && [ ! -s "$scratch/out" ] && [ "$(wc -l <"$scratch/error")" = 1 ] &&
    grep -q '^photonlab: PHOTONLAB_SIMD=sse9: .* from scalar to ' "$scratch/error"
}

check 'an unknown level is refused by validate' refused validate
check 'an unknown level is refused by info' refused info scenes/cornell-box.pbrt
check 'an unknown level is refused by render' refused render scenes/cornell-box.pbrt -o "$scratch/x.png"
check 'scalar is a level everywhere' env PHOTONLAB_SIMD=scalar "$photonlab" validate
check 'an empty one is none' env PHOTONLAB_SIMD= "$photonlab" list laws
done_testing
