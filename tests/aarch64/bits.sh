#!/bin/bash
# The same bytes as here on aarch64, from gcc and clang, and on an x86-64 without AVX: emulated, by
# the programs that `make test-aarch64` builds. Prints TAP.
# shellcheck source=tests/same_bytes.sh
. "$(dirname "$0")/../same_bytes.sh"
plain=(qemu-x86_64-static -cpu Nehalem build/x86-64/photonlab)

measure release "$photonlab"
measure aarch64 qemu-aarch64-static build/aarch64/photonlab
same aarch64
if [ -x build/aarch64-clang/photonlab ]; then
  measure aarch64-clang qemu-aarch64-static build/aarch64-clang/photonlab
  same aarch64-clang
else
  skip 'aarch64-clang gives the same bytes' 'clang is not installed'
fi
if [ "$(uname -m)" = x86_64 ]; then
  measure plain-x86-64 "${plain[@]}"
  same plain-x86-64
  check_fails 'a plain x86-64 refuses avx2' env PHOTONLAB_SIMD=avx2 "${plain[@]}" validate
else
  skip 'plain-x86-64 gives the same bytes' 'this is none'
fi
done_testing
