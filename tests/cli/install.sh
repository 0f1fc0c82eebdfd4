#!/bin/bash
# make install puts down a program that runs, its man page and its data; make uninstall leaves none.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
[ "$photonlab" = build/photonlab ] || {
  skip 'make install' 'only of the release build'
  done_testing
  exit
}
# A make inside make test has its CC, OPT, ...: nothing is built again.
make_to_scratch() { make INSTALL=no "$1" PREFIX=/usr DESTDIR="$scratch"; }

check 'make install' make_to_scratch install
check 'what is installed runs' "$scratch/usr/bin/photonlab" --version
check 'the man page is installed' test -s "$scratch/usr/share/man/man1/photonlab.1"
check 'the scenes are installed' diff -r scenes "$scratch/usr/share/photonlab/scenes"
check 'make uninstall' make_to_scratch uninstall
check 'nothing is left' test -z "$(find "$scratch" -type f)"
done_testing
