#!/bin/bash
# The layers of src/ORDER, memory from the arena only, nothing inexact from libm; and that the
# check finds each of these when it is planted in a small tree.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
compiler=${CC:-gcc}

check 'the tree keeps the rules of the layers' \
  tests/order . "${PHOTONLAB_OBJECTS:-build/release/obj}"

# planted SENTENCE FILE TEXT VIOLATION: a tree where only FILE breaks a rule, once compiled
planted() {
  local tree=$scratch/tree output
  rm -rf "$tree"
  mkdir -p "$tree"/{src/low,src/high,analysis,obj/src/low,obj/analysis}
  echo 'low high analysis' >"$tree/src/ORDER"
  echo '#include "low/low.h"' >"$tree/src/high/high.h"
  touch "$tree/src/low/low.h"
  printf '%b\n' "$3" >"$tree/$2"
  (cd "$tree" && $compiler -c -fno-builtin -Isrc -I. -x c "$2" -o "obj/${2%.c}.o") || return
  output=$(tests/order "$tree" "$tree/obj")
  if [[ $output == "$4" ]]; then ok "$1"; else not_ok "$1" "expected: $4
found: $output"; fi
}

planted 'an include to the left is in order' src/low/a.c '#include "low/low.h"\nint a;' ''
planted 'an include to the right is found' src/low/a.c '#include "high/high.h"\nint a;' \
  'src/low/a.c:1: low includes "high/high.h", which is to its right in src/ORDER'
planted 'an include without a folder is found' src/low/a.c 'int a;\n#include "../low/low.h"' \
  'src/low/a.c:2: "../low/low.h" is not relative to a folder of src/ORDER'
planted 'sin in src/ is found' src/low/a.c 'double sin(double);\ndouble a(double x) { return sin(x); }' \
  "src/low/a.c calls libm's sin: its bits depend on the machine (numeric/elementary.h)"
planted 'fmaf in src/ is found' src/low/a.c \
  'float fmaf(float, float, float);\nfloat a(float x) { return fmaf(x, x, x); }' \
  "src/low/a.c calls libm's fmaf: its bits depend on the machine (numeric/elementary.h)"
planted 'sqrt in src/ is allowed' src/low/a.c 'double sqrt(double);\ndouble a(double x) { return sqrt(x); }' ''
planted 'sin in analysis/ is allowed' analysis/a.c \
  'double sin(double);\ndouble a(double x) { return sin(x); }' ''
planted 'malloc is found' analysis/a.c '#include <stdlib.h>\nvoid *a(void) { return malloc(3); }' \
  'analysis/a.c calls malloc: memory comes from the arena'
done_testing
