#!/bin/bash
# What is skipped changes no byte: every skip has an experiment of its name in tests/data/skips, which
# is run with it and without it. That each of them does skip something is what `make bench-skip` shows.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

run() { # run FOLDER SKIP OPTIONS...
  "$photonlab" run "tests/data/skips/$2.yaml" --quiet -o "$scratch/$2/$1" "${@:3}" > /dev/null
}

# What is measured, in two results directories. Images of gray scenes may have equal channels.
same() {
  local file
  [ -s "$1/log.csv" ] || return 1
  for file in "$1"/{log,probes,runs}.csv "$1"/images/*.exr "$1"/discs/*.csv; do
    [ ! -e "$file" ] || cmp "$file" "$2/${file#"$1"/}" || return 1
  done
}
prefix() { cmp -n "$(stat -c %s "$1")" "$1" "$2" && ! cmp -s "$1" "$2"; }

names=$("$photonlab" list skips | awk '/^  / { print $1 }')
for name in $names; do
  check "$name: its experiment runs" run with "$name"
  case $name in
  references) # the second folder's are sampled again, over the first one's
    cp -r "$scratch/$name/references" "$scratch/$name/kept"
    touch -d '1 hour ago' "$scratch/$name/references"/*
    check "$name: taken from disk if they are there" run taken "$name"
    check_fails "$name: and left alone" test -n "$(find "$scratch/$name/references" -newer "$scratch/$name/kept")"
    ;;
  esac
  check "$name: it runs without" run without "$name" --no-skip="$name"
  case $name in
  runs)
    check "$name: those made are the first" \
      prefix "$scratch/$name/with/runs.csv" "$scratch/$name/without/runs.csv"
    sed '/^until:/d' "tests/data/skips/$name.yaml" > "$scratch/all.yaml"
    "$photonlab" run "$scratch/all.yaml" --quiet -o "$scratch/$name/all" > /dev/null
    check "$name: without, all are made" same "$scratch/$name/all" "$scratch/$name/without"
    ;;
  references)
    check "$name: sampled again, the same" diff -r "$scratch/$name/kept" "$scratch/$name/references"
    check "$name: it was sampled" \
      test -z "$(find "$scratch/$name/references" -name '*.csv' ! -newer "$scratch/$name/kept")"
    ;;&
  *) check "$name: the same bytes" same "$scratch/$name/with" "$scratch/$name/without" ;;
  esac
done
check 'there are skips' test -n "$names"
check_fails 'a name that is none is refused' \
  "$photonlab" run tests/data/skips/gray.yaml -o "$scratch/none" --no-skip=grey
done_testing
