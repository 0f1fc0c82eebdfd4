#!/bin/bash
# experiments/parallel.sh PHOTONLAB RESULTS QUALITY, of the Makefile: parallel.yaml and two pictures
# by 1, 2, ... threads, once a repetition and in another order in each, so that whatever else the
# machine does falls on all alike. Every time is that of a whole command. Other bytes than by all
# threads are an error. Leaves RESULTS/threads.csv; interrupted, it goes on with the next measurement.
set -eu
photonlab=$1 results=$2 quality=$3
scene=scenes/cornell-box.pbrt radius=0.1
case $quality in
paper) repetitions=9 iterations=512 ;;
*) repetitions=5 iterations=64 ;;
esac
cores=$(nproc)
cpu=$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1 | tr -s ', ' ' ')

"$photonlab" run experiments/parallel.yaml -o "$results" --quality "$quality"
scratch=$results/scratch table=$results/threads.csv part=$results/threads.part
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$scratch"

sizes=$(for ((n = 1; n <= cores; n += n < 4 ? 1 : n)); do echo "$n"; done; echo "$cores")
mapfile -t counts < <(sort -nu <<<"$sizes")

# What is measured, by how many threads, to where. sppm's iterations follow each other, all threads
# at work on each; those of probabilistic are computed side by side.
experiment() {
  "$photonlab" run experiments/parallel.yaml --quality "$quality" --quiet --threads "$1" \
    -o "$2" >"$2.out"
}
probabilistic() { picture probabilistic "$@"; }
sppm() { picture sppm "$@"; }
picture() {
  "$photonlab" render $scene --integrator "$1" --radius $radius --photons 20000 \
    --iterations $iterations --quiet --threads "$2" -o "$3" >"$3.out"
}

same() { # same A B: files or folders of results
  if [ -f "$1" ]; then cmp "$1" "$2"; return; fi
  cmp "$1/log.csv" "$2/log.csv" && diff -r "$1/images" "$2/images" -x '*.csv'
}

measure() { # measure WHAT THREADS REPETITION: a row
  local place=$scratch/$1-$2 load wall user system TIMEFORMAT='%R %U %S'
  [ "$1" = experiment ] || place=$place.exr
  rm -rf "$place"
  load=$(cut -d ' ' -f 1 /proc/loadavg)
  { time "$1" "$2" "$place" 2>&3; } 3>&2 2>"$scratch/time"
  read -r wall user system <"$scratch/time"
  same "$place" "${expected[$1]}" || {
    echo "photonlab: $1 by $2 threads gives other bytes" >&2
    exit 1
  }
  echo "$1,$2,$3,$wall,$(awk "BEGIN { print $user + $system }"),$load,$cores,$cpu" >>"$part"
}

measure_all() {
  declare -A expected=([experiment]=$results [probabilistic]=$scratch/a.exr [sppm]=$scratch/b.exr)
  local k n=${#counts[@]} repetition what threads
  probabilistic "$cores" "${expected[probabilistic]}"
  sppm "$cores" "${expected[sppm]}"
  for ((repetition = 1; repetition <= repetitions; repetition++)); do
    for ((k = 0; k < n; k++)); do
      threads=${counts[(k + repetition) % n]}
      for what in experiment probabilistic sppm; do
        grep -qs "^$what,$threads,$repetition," "$part" || measure $what "$threads" $repetition
      done
    done
    echo "parallel: repetition $repetition of $repetitions, ${counts[*]} threads" >&2
  done
}

if [ ! -s "$table" ]; then
  measure_all
  { echo 'what,threads,repetition,wall_s,cpu_s,load,cores,cpu' && cat "$part"; } >"$part.new"
  mv "$part.new" "$table"
  rm "$part"
fi
"$photonlab" plot "$results"
