#!/bin/bash
# experiments/numerical-stability.sh PHOTONLAB RESULTS QUALITY, of the Makefile: the scenes of
# numerical-stability.yaml scaled, moved, brighter, dimmer and degenerate, each compared with itself as it
# is, after the stresses of `photonlab validate stability`. A run is within its bound, or refused with a
# message that names the limit exactly where theory says so; all else is an error. Leaves
# RESULTS/stability.csv and report.txt; interrupted, it goes on with the next run.
set -eu
photonlab=$1 results=$2 quality=$3
yaml=experiments/numerical-stability.yaml hazards=experiments/numerical-stability.hazards
numbers=$results/numbers.csv table=$results/stability.csv report=$results/report.txt
stress=$results/stress
float=1.1920928955078125e-07 # spacing of floats at 1
power() { awk "BEGIN { printf \"%.17g\", $1 ^ ($2) }"; }

# ---- scenes ----
# stressed SCENE SCALE SHIFT LIGHT CHANGE: a new scene on standard output. Power is in proportion to area,
# so that radiance stays; lengths in a scene's text follow the transformation.
stressed() {
  awk -v scale="$2" -v shift="$3" -v light="$4" -v change="$5" '
    function number(x) { return sprintf("%.17g", x) }
    function same(word, x) { print word, number(x), number(x), number(x) }
    /^Camera/ && scale != 1 { same("Scale", 1 / scale) }
    /^Camera/ && shift != 0 { same("Translate", -shift) }
    { gsub(/"float power" \[1\]/, "\"float power\" [" number(scale * scale * light) "]")
      gsub(/"rgb L"/, "\"float scale\" [" number(light) "] \"rgb L\"")
      if (change == "slivers") sub(/\[0 1 2 0 2 3\]/, "[0 1 2 0 2 3  1 1 2  3 3 3  2 0 0]")
      print }
    world && !/^(LightSource|AreaLightSource)/ { copy = copy $0 "\n" }
    /^WorldBegin/ {
      world = 1
      if (shift != 0) same("Translate", shift)
      if (scale != 1) same("Scale", scale) }
    END { if (change == "coincident") printf "%s", copy }' "scenes/$1.pbrt"
}

# ---- runs ----
# The experiment of a stressed scene: its part of the yaml alone, or status 1 and a message.
run() { # run NAME SCENE SCALE SHIFT LIGHT CHANGE
  local name=$1 scene=$2 scale=$3 radius
  stressed "${@:2}" >"$stress/$name.pbrt"
  radius=$(sed -n "s|.*scenes/$scene.pbrt, radius: \([0-9.]*\),.*|\1|p" $yaml)
  radius=$(awk "BEGIN { printf \"%.17g\", $radius * $scale }")
  { sed '/^ *- {scene/d' $yaml
    grep "scenes/$scene.pbrt" $yaml | sed "s|scene: [^,]*, radius: [^,]*|scene: $stress/$name.pbrt, radius: $radius|"
  } >"$stress/$name.yaml"
  "$photonlab" run "$stress/$name.yaml" -o "$stress/$name" --quality "$quality" --quiet \
    >"$stress/$name.out" 2>&1 && "$photonlab" fit "$stress/$name" >>"$stress/$name.out" 2>&1
}

# Its radius at the last iteration in spacings of floats at its largest coordinate (shift + scale times
# that of the scene).
spacings() { # spacings SCENE SCALE SHIFT
  local extent
  case $1 in cornell-box) extent=2 ;; glass-ball) extent=3 ;; *) extent=4.1 ;; esac
  awk -F, -v scene="$1" -v coordinate="$(awk "BEGIN { print $3 + $2 * $extent }")" -v scale="$2" -v spacing=$float '
    $2 == scene && $8 == "average" { radius = $10 * scale }
    END { printf "%.6g", radius / (coordinate * spacing) }' "$results/log.csv"
}

# ---- comparison ----
# Moments of all iterations and averages of a scene: series,i,n,mean,m2,m3,m4.
moments() { # moments SCENE LOG
  awk -F, -v scene="$1" -v OFS=, '$2 == scene && ($8 == "iteration" || $8 == "average") {
    print $8, $9, $11, $12, $13, $14, $15 }' "$2"
}
rates() { # rates SCENE FIT: rate and its standard error, by probe
  awk -v scene="\"$1\"," '/"scene":/ { here = $2 == scene }
    here && /"rate":/ { rate = $2 }
    here && /"rate_se":/ { print rate $2 }' "$2"
}

# The share of numbers that are not the bits of before, times the power of two by which light changed.
compare_bits() { # compare_bits SCENE NAME LIGHT
  paste -d, <(moments "$1" "$results/log.csv") <(moments "$2" "$stress/$2/log.csv") | awk -F, -v light="$3" '
    { for (k = 1; k <= 4; k++) different += $(10 + k) != $(3 + k) * light ^ k; if ($1 $2 != $8 $9) exit 1 }
    END { print NR ? different / NR : 1, 0 }'
}

# The largest error of the last averages over probes and integrators, and what it may be. A vertex is
# rounded by half a spacing in each coordinate, so a photon and the point that asks for it move by at most
# sqrt(3) / 2 spacings each, and the share p = 4 sqrt(3) spacing / r of a disc is that close to its rim. At
# worst all of it changes sides together; or it is drawn anew, and the difference has 2 p times the variance:
# four of its standard deviations. On top come 1000 roundings of doubles. The relative error of a variance of
# n runs, were it all new, is sqrt(2 / (n - 1)), with as much again for kurtosis.
compare() { # compare mean|variance SCENE NAME LIGHT SHARE
  local last
  last=$(awk -F, '$8 == "average" && $9 > last { last = $9 } END { print last }' "$stress/$3/log.csv")
  paste -d, <(moments "$2" "$results/log.csv") <(moments "$3" "$stress/$3/log.csv") |
    awk -F, -v what="$1" -v light="$4" -v share="$5" -v last="$last" '
    function abs(x) { return x < 0 ? -x : x }
    $1 != $8 || $2 != $9 { print "nan", 0; exit 1 }
    $1 == "average" && $2 == last {
      error = what == "mean" ? abs($11 / ($4 * light) - 1) : abs($12 / ($5 * light * light) - 1)
      se = what == "mean" ? sqrt($5 / ($3 - 1) / $3) / $4 : 2 * sqrt(2 / ($3 - 1))
      bound = share + 4 * sqrt(2 * share) * se + 1000 / 2 ^ 53
      if (error / bound >= worst) { worst = error / bound; is = error; most = bound } }
    END { print is, most }'
}

# The same of the fitted rate, which the fit finds to 1e-9.
compare_rates() { # compare_rates SCENE NAME SHARE
  paste -d, <(rates "$1" "$results/fit.json") <(rates "$2" "$stress/$2/fit.json") | awk -F, -v share="$3" '
    function abs(x) { return x < 0 ? -x : x }
    { error = $1 == "null" || $4 == "null" ? 1 : abs($4 - $1)
      bound = 1e-9 + share + 4 * sqrt(2 * share) * $2
      if (error / bound >= worst) { worst = error / bound; is = error; most = bound } }
    END { print is, most }'
}

row() { # row FAMILY WHAT LEVEL VERDICT ERROR BOUND, to be judged where VERDICT is "?"
  awk -v row="$1,$2,$3" -v verdict="$4" -v error="$5" -v bound="$6" 'BEGIN {
    if (verdict == "?") verdict = error == error + 0 && error + 0 <= bound + 0 ? "ok" : "FAIL"
    print row "," error "," bound "," verdict }' >>"$table.part"
}

# measure FAMILY LEVEL EXACT|ROUNDED SCENE SCALE SHIFT LIGHT CHANGE: the rows of one run
measure() {
  local family=$1 level=$2 how=$3 scene=$4 name spacings share
  name=$(printf '%s-%s-%s-%s' "$scene" "${family// /-}" "$level" "$5")
  spacings=$(spacings "$scene" "$5" "$6")
  [ "$family" != moved ] || level=$spacings
  if ! run "$name" "${@:4}"; then
    if awk "BEGIN { exit !($spacings < 100) }" && [ "$(wc -l <"$stress/$name.out")" = 1 ] &&
      grep -q 'radius .* is too small for a scene with coordinates up to' "$stress/$name.out"; then
      row "$family" "$scene" "$level" refused nan nan
    else
      cat "$stress/$name.out" >&2
      row "$family" "$scene" "$level" FAIL nan nan
    fi
    return
  fi
  if awk "BEGIN { exit !($spacings < 100) }"; then row "$family" "$scene; not refused" "$level" FAIL nan nan; fi
  share=$(awk "BEGIN { print 4 * sqrt(3) / $spacings }")
  [ "$scene" != glass-ball ] || share=$(awk "BEGIN { print $share / 2 ^ 29 }") # doubles
  [ "$family" != light ] && [ "$how" != exact ] || share=0
  # shellcheck disable=SC2046 # an error and its bound
  if [ "$how" = exact ]; then
    row "$family" "$scene; bits" "$level" '?' $(compare_bits "$scene" "$name" "$7")
  else
    row "$family" "$scene; mean" "$level" '?' $(compare mean "$scene" "$name" "$7" "$share")
    row "$family" "$scene; variance" "$level" '?' $(compare variance "$scene" "$name" "$7" "$share")
  fi
  # shellcheck disable=SC2046
  [ "$scene" != plane-point-light ] || row "$family" "$scene; rate" "$level" '?' $(compare_rates "$scene" "$name" "$share")
}

measure_all() {
  local scene k
  for scene in plane-point-light cornell-box glass-ball; do
    for k in -6 -5 -4 -3 -2 -1 1 2 3 4 5 6; do
      measure scale 1e$k rounded $scene "$(power 10 $k)" 0 1 none
    done
    for k in -20 -7 7 20; do measure scale "$(power 2 $k)" exact $scene "$(power 2 $k)" 0 1 none; done
    for k in -12 -9 -6 -3 3 6 9 12; do
      measure light 1e$k rounded $scene 1 0 "$(power 10 $k)" none
    done
    for k in -40 -13 13 40; do measure light "$(power 2 $k)" exact $scene 1 0 "$(power 2 $k)" none; done
    for k in 0 1 2 3 4 5 6; do measure moved 1e$k rounded $scene 1 1e$k 1 none; done
    measure moved 1e6 rounded $scene 1e3 1e6 1 none
    measure moved 1e6 rounded $scene 1e4 1e6 1 none
    echo "numerical-stability: $scene done" >&2
  done
  measure degenerate slivers exact cornell-box 1 0 1 slivers
  measure degenerate coincident exact cornell-box 1 0 1 coincident
  measure degenerate slivers exact plane-point-light 1 0 1 slivers
}

# ---- report: the worst level of each row, and where each hazard is caught ----
write_report() {
  { awk -F, '
      NR == 1 { next }
      { key = $1 ": " $2; if (!(key in seen)) { seen[key] = 1; order[n++] = key } count[key]++ }
      $6 == "refused" { refused[key]++; next }
      $6 == "FAIL" { failed[key]++ }
      $6 == "not used" { unused[key] = 1 }
      { ratio = $6 == "not used" ? $4 : $5 > 0 ? $4 / $5 : $4
        if (!(key in worst) || ratio > worst[key]) { worst[key] = ratio; at[key] = $3; is[key] = $4; most[key] = $5 } }
      END {
        printf "%-48s %6s  %12s  %9s  %9s  %s\n", "error of", "levels", "worst at", "is", "at most", "verdict"
        for (k = 0; k < n; k++) { key = order[k]
          verdict = unused[key] ? "not used" : failed[key] ? failed[key] " FAIL" : "ok"
          if (refused[key]) verdict = verdict ", " refused[key] " refused"
          printf "%-48s %6d  %12s  %9s  %9s  %s\n", key, count[key], at[key], is[key], most[key], verdict } }' "$table"
    echo
    sed 's/^#.*//; /^$/d' $hazards
    echo
    awk -F, '{ n[$6]++ } END {
      printf "numerical-stability: %s: %d within their bounds, %d refused as they must be, %d FAIL\n",
        n["FAIL"] ? "FAIL" : "green", n["ok"], n["refused"], n["FAIL"] }' "$table"
  } >"$report"
}

mkdir -p "$stress"
"$photonlab" run $yaml -o "$results" --quality "$quality"
"$photonlab" fit "$results"
"$photonlab" validate stability -o "$numbers" >/dev/null
cp "$numbers" "$table.part"
measure_all
mv "$table.part" "$table"
write_report
cat "$report"
"$photonlab" plot "$results"
! grep -q ',FAIL$' "$table"
