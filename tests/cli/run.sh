#!/bin/bash
# An experiment from the command line: the same bytes however it was computed, interrupted and gone on
# with, or refused with one line.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

cat > "$scratch/small.yaml" <<'YAML'
alpha: [0.5, 2/3]
seed: small
parts:
  - {scene: scenes/cornell-box.pbrt, radius: 0.3, photons: 300, iterations: 4, runs: 19,
     kernel: [box, gaussian], images: [1, 4], probes: [[20, 60], [32, 20]], direct: [photons, nee],
     reference: {integrator: path, se: 0.02}}
  - {scene: scenes/plane-quadratic-beam.pbrt, radius: 0.5, photons: 250, iterations: 20, runs: 18,
     depth: 1, probes: [[32, 32]], pixel: [centre, footprint]}
  - {scene: scenes/cornell-box.pbrt, photons: 300, iterations: 3, runs: 2, probes: [[20, 60]],
     reference-radius: [pixel, knn, ray-differentials], pixel: [centre, footprint]}
  - {scene: tests/data/scenes/fog.pbrt, integrator: [probabilistic, sppm], radius: 0.3, alpha: 1/2,
     radius-volume: [0.2, 0.4], photons: 300, iterations: 3, runs: 2, direct: [photons, nee]}
YAML

cat > "$scratch/long.yaml" <<'YAML'
scene: scenes/plane-quadratic-beam.pbrt
radius: 0.5
photons: 250
iterations: 300
runs: 100
depth: 1
probes: [[32, 32]]
YAML

run() { "$photonlab" run "$scratch/small.yaml" --quiet -o "$scratch/$1" "${@:2}" > /dev/null; }

# The measured bytes of two results directories.
same() {
  cmp "$scratch/$1/log.csv" "$scratch/$2/log.csv" &&
    cmp "$scratch/$1/probes.csv" "$scratch/$2/probes.csv" || return 1
  for image in "$scratch/$1"/images/*.exr; do
    cmp "$image" "$scratch/$2/images/${image##*/}" || return 1
  done
  [ "$(ls "$scratch/$1/images" | wc -l)" = 16 ] # 2 alpha x 2 kernels x 2 direct x 2 N
}

check 'an experiment runs' run one --threads 1
for name in manifest.json log.csv probes.csv timing.csv small.yaml; do
  check "it leaves $name" test -s "$scratch/one/$name"
done
check_fails 'it leaves no blocks' test -e "$scratch/one/blocks"
rm -rf "$scratch/references"
run two --threads 2
check 'two threads give the same bytes' same one two
run three --threads 3
check 'three threads give the same bytes' same one three
run again --threads 1
check 'a second run gives the same bytes' same one again
rm -rf "$scratch/references"
run noskip --no-skip=all
check 'what is skipped changes no byte' same one noskip
run seed --seed 2
check_fails 'another seed gives other bytes' cmp "$scratch/one/log.csv" "$scratch/seed/log.csv"

# Interrupted after at least one block, it goes on to the same bytes.
long() { "$photonlab" run "$scratch/long.yaml" --quiet -o "$scratch/$1" > /dev/null; }
long whole
"$photonlab" run "$scratch/long.yaml" --quiet --threads 1 -o "$scratch/broken" 2> "$scratch/said" &
child=$!
for _ in $(seq 500); do
  [ -n "$(ls "$scratch"/broken/blocks/*/ 2> /dev/null)" ] && break
  sleep 0.02
done
kill -TERM $child
wait $child
check 'a terminated run exits with 143' test $? = 143
check 'it says how to go on' grep -q 'same command' "$scratch/said"
check 'it keeps finished blocks' test -n "$(ls "$scratch"/broken/blocks/*/)"
check_fails 'it leaves no log' test -e "$scratch/broken/log.csv"
echo 'not a block' > "$(echo "$scratch"/broken/blocks/*/*block-000000)"
check 'the same command goes on, past a damaged block' long broken
check 'and gives the same bytes' cmp "$scratch/whole/log.csv" "$scratch/broken/log.csv"

cp "$scratch/one/log.csv" "$scratch/kept"
check 'a finished experiment is not run again' run one
check 'and is left as it was' cmp "$scratch/one/log.csv" "$scratch/kept"
# A program of uncommitted source is its bytes; one of a commit is that commit, whatever compiled it.
cp "$photonlab" "$scratch/rebuilt" && echo >> "$scratch/rebuilt"
"$scratch/rebuilt" run "$scratch/long.yaml" -o "$scratch/whole" > /dev/null 2> "$scratch/said"
case $("$photonlab" --version) in
*-dirty | *unknown) expected='held other results' ;;
*) expected='up to date' ;;
esac
check 'another program of uncommitted source runs again' grep -q "$expected" "$scratch/said"
run one --seed 2
check 'results of something else are set aside, not lost' cmp "$scratch/one.1/log.csv" "$scratch/kept"

check 'fit writes fit.json and curves.csv' "$photonlab" fit "$scratch/two"
check 'fit.json is there' test -s "$scratch/two/fit.json"
cp "$scratch/two/fit.json" "$scratch/kept"
"$photonlab" fit "$scratch/two" > /dev/null
check 'fit gives the same bytes twice' cmp "$scratch/two/fit.json" "$scratch/kept"
cp "$scratch/two/curves.csv" "$scratch/curves"
"$photonlab" fit "$scratch/two" --method ols > "$scratch/said"
check 'fit.json says which method was used' grep -q '"method": "ols"' "$scratch/two/fit.json"
check 'a straight line has no verdict, and says why' grep -q 'none (.*; ols: .* cover 56 %' "$scratch/said"
check 'another method leaves the curves alone' cmp "$scratch/two/curves.csv" "$scratch/curves"
"$photonlab" fit "$scratch/two" > /dev/null
check 'the default method comes back' cmp "$scratch/two/fit.json" "$scratch/kept"

{ sed 's/runs: 100/runs: 20/; s/iterations: 300/iterations: 30/' "$scratch/long.yaml"; echo 'keep: runs'; } \
  > "$scratch/kept-runs.yaml"
"$photonlab" run "$scratch/kept-runs.yaml" -o "$scratch/runs" --quiet > /dev/null
"$photonlab" fit "$scratch/runs" --method bootstrap > /dev/null
check 'runs that were kept are resampled' grep -q '"method": "bootstrap"' "$scratch/runs/fit.json"
cp "$scratch/runs/fit.json" "$scratch/kept"
"$photonlab" fit "$scratch/runs" --method bootstrap > /dev/null
check 'and always the same ones' cmp "$scratch/runs/fit.json" "$scratch/kept"

# One line, status 1 (2: usage), nothing left behind.
refuses() { # refuses SENTENCE STATUS PATTERN COMMAND...
  local name=$1 status=$2 pattern=$3 output got=0
  shift 3
  output=$("$@" 2>&1 > /dev/null) || got=$?
  if [ $got = "$status" ] && [ "$(printf '%s\n' "$output" | wc -l)" = 1 ] &&
    [[ $output =~ $pattern ]]; then
    ok "$name"
  else
    not_ok "$name" "status $got: $output"
  fi
}
experiment() { # experiment NAME LINES...: a file with one change
  printf '%s\n' 'scene: scenes/plane-uniform-beam.pbrt' 'radius: 0.2' 'runs: 2' 'iterations: 3' \
    "${@:2}" > "$scratch/$1.yaml"
  echo "$scratch/$1.yaml"
}
scene() { # scene NAME LINE: the box with a line appended
  { cat scenes/plane-uniform-beam.pbrt; printf '%s\n' "$2"; } > "$scratch/$1.pbrt"
  echo "$scratch/$1.pbrt"
}
out=$scratch/refused
refuses 'alpha = 1.5' 1 ':5:8: alpha' "$photonlab" run "$(experiment a 'alpha: 1.5')" -o "$out"
refuses 'zero photons' 1 ':5:10: photons' "$photonlab" run "$(experiment b 'photons: 0')" -o "$out"
refuses 'a duplicate key' 1 ':5:1: ' "$photonlab" run "$(experiment c 'runs: 3')" -o "$out"
refuses 'a missing experiment' 1 'none.yaml' "$photonlab" run "$scratch/none.yaml" -o "$out"
refuses 'a missing scene' 1 ':5:17: .*gone.pbrt' \
  "$photonlab" run "$(experiment d 'parts: [{scene: gone.pbrt}]')" -o "$out"
refuses 'a probe outside the film' 1 'probe \[65, 0\]' \
  "$photonlab" run "$(experiment e 'probes: [[65, 0]]')" -o "$out"
refuses 'a radius that floats cannot resolve' 1 'radius' \
  "$photonlab" run "$(experiment f 'parts: [{radius: 1e-5}]')" -o "$out"
refuses 'an unknown directive' 1 'pbrt:[0-9]+:1: .*Shpae' \
  "$photonlab" info "$(scene a 'Shpae "sphere"')"
refuses 'a NaN vertex' 1 'pbrt:[0-9]+:[0-9]+: ' "$photonlab" info \
  "$(scene b 'Shape "trianglemesh" "point3 P" [0 0 0 1 0 nan 0 1 0]')"
refuses 'an empty scene' 1 'no Shape' "$photonlab" info <(echo WorldBegin)
refuses 'a missing scene file' 1 'none.pbrt' "$photonlab" render "$scratch/none.pbrt" -o "$out.exr"
refuses 'an unknown image format' 1 'known: .exr' "$photonlab" render scenes/cornell-box.pbrt -o "$out.gif"
refuses 'a picture in a folder that is not there, before it is rendered' 1 'x.exr: cannot write it' \
  timeout 5 "$photonlab" render scenes/cornell-box.pbrt --spp 1e6 -o "$scratch/none/x.exr"
refuses 'an unknown command' 2 "did you mean 'render'" "$photonlab" rendr
refuses 'an unknown option' 2 "did you mean '--radius'" \
  "$photonlab" render scenes/cornell-box.pbrt --raduis 3
refuses 'an unknown list' 2 "did you mean 'kernels'" "$photonlab" list kernel
refuses 'an unknown option with a value' 2 "did you mean '--radius'" \
  "$photonlab" render scenes/cornell-box.pbrt --raduis=3.141592653589
refuses 'an empty value' 2 "'-o' needs a value" "$photonlab" run "$(experiment h)" -o ''
refuses 'an empty value behind =' 2 'needs a value' "$photonlab" run "$(experiment h)" --output=
refuses 'a missing value' 2 "'--seed' needs a value" "$photonlab" list --seed
refuses 'a full standard output' 1 'standard output' bash -c '"$0" list > /dev/full' "$photonlab"
refuses 'a missing argument' 2 SCENE "$photonlab" render
refuses 'an option out of range' 1 'alpha' \
  "$photonlab" render scenes/cornell-box.pbrt -o "$out.exr" --alpha 1.5
refuses 'a results directory that cannot be made' 1 'file' \
  "$photonlab" run "$(experiment g)" -o "$scratch/small.yaml/x"
refuses 'a method that is none' 1 "no method 'jackknife'" "$photonlab" fit "$scratch/two" --method jackknife
refuses 'a bootstrap of runs that were not kept' 1 'keep: runs.*--method gls' \
  "$photonlab" fit "$scratch/two" --method bootstrap
refuses 'fit of what is no results directory' 1 'manifest' "$photonlab" fit "$scratch"
refuses 'more photons than memory holds' 1 'photons: 1000000000000' \
  "$photonlab" render scenes/cornell-box.pbrt -o "$out.exr" --photons 1e12
refuses 'a scene without light' 1 'no light' \
  "$photonlab" render <(sed '/AreaLight/d' scenes/cornell-box.pbrt) -o "$out.exr"
refuses 'an integrator of the scene that is not ours' 1 'pbrt: integrator: photonmapper is unknown' \
  "$photonlab" render "$(sed 's/"probabilistic"/"photonmapper"/' scenes/cornell-box.pbrt > "$scratch/mapper.pbrt"; echo "$scratch/mapper.pbrt")" -o "$out.exr"
sed -i '5s/0\./1./' "$scratch/two/log.csv"
refuses 'a log that was edited' 1 'changed after the run' "$photonlab" fit "$scratch/two"
check_fails 'no refused run leaves anything' ls "$out" "$out.exr" "$out.gif"

done_testing
