#!/bin/bash
# experiments/time-to-error.sh PHOTONLAB RESULTS QUALITY, of the Makefile: time-to-error.yaml with the parts
# of time-to-error.scenes whose scenes are in the folder $SCENES, their errors against time, and what a
# verdict costs: alpha.yaml's beams, uniform and quadratic, until every rate's standard error is 0.004, beside
# what `photonlab plan` expects. Leaves RESULTS/*.csv and RESULTS/verdict; interrupted, it goes on.
set -eu
photonlab=$1 results=${2%/} quality=$3
yaml=experiments/time-to-error.yaml scenes=experiments/time-to-error.scenes se=0.004
case $quality in
paper) most=16384 ;;
*) most=208 ;; # runs; what they do not reach is extrapolated, as se ~ runs^(-1/2)
esac
links=$results.scenes # not in it: other results there are set aside

# Links, so that a scene has a name of its own and finds its meshes: none is copied.
link() { # link NAME
  local from
  from=$(realpath "${SCENES:?}/$1")
  mkdir -p "$links/$1"
  ln -sfn "$from/small.pbrt" "$links/$1/$1.pbrt"
  [ ! -d "$from/models" ] || ln -sfn "$from/models" "$links/$1/models"
}

parts() { # of the scenes that are there
  local name radius reference what
  while read -r _ name radius reference what; do
    if [ ! -f "${SCENES:-}/$name/small.pbrt" ]; then
      echo "time-to-error: no $name in SCENES=${SCENES:-}" >&2
      continue
    fi
    link "$name"
    awk -v scene="$links/$name/$name.pbrt" -v r="$radius" -v reference="$reference" -v what="$what" '
      /^(TRUTH|FIRST):/ { more[substr($1, 1, 5)] = substr($0, 8) }
      $1 == what || $1 == "both" { line[++n] = substr($0, 10) }
      END {
        for (k = 1; k <= n; k++) {
          for (word in more) sub(word, more[word], line[k])
          sub(/SCENE/, scene, line[k])
          for (m = 1; m <= 16; m *= 2) sub(": R" m ",", ": " reference * m ",", line[k])
          sub(/: R,/, ": " r ",", line[k])
          print "  " line[k]
        }
      }' $scenes
  done < <(grep '^scene ' $scenes)
}

# The beams of alpha.yaml alone: what comes before its parts, and the first two of these.
verdict_experiment() {
  awk -v se=$se -v most=$most '
    /^parts:/ { print "until: rate_se <= " se }
    /^  - / { part++ }
    part > 2 { exit }
    { sub(/runs: [0-9]+/, "runs: " most) }
    { print }' experiments/alpha.yaml
}

# Lines "SCENE ALPHA QUANTITY plan RUNS", "... fit RUNS ITERATIONS SE" and "SCENE cpu SECONDS".
verdict_rows() {
  "$photonlab" plan "$results/verdict.yaml" --quality default |
    awk '$1 ~ /^[0-9]+$/ { print $2, $4, $6, "plan", $9 }'
  awk '
    { gsub(/[",]/, "") }
    $1 == "scene:" { scene = $2 }
    $1 == "alpha:" { alpha = $2 }
    $1 == "runs:" { runs = $2 }
    $1 == "iterations:" { iterations = $2 }
    $1 == "quantity:" { quantity = $2 }
    $1 == "rate_se:" && $2 != "null" {
      printf "%s %.4f %s fit %d %.0f %s\n", scene, alpha, quantity, runs, runs * iterations, $2 }' "$results/verdict/fit.json"
  awk -F, 'NR > 1 { s[$3] += $10 } END { for (k in s) print k, "cpu", s[k] }' "$results/verdict/timing.csv"
}

verdict() {
  verdict_experiment >"$results/verdict.yaml"
  "$photonlab" run "$results/verdict.yaml" -o "$results/verdict" --quality default
  "$photonlab" fit "$results/verdict" >"$results/verdict.txt"
  verdict_rows | awk -v se=$se '
    BEGIN { print "scene,alpha,quantity,planned_runs,planned_cpu_s,runs,iterations,cpu_s,rate_se,needed_cpu_s" }
    $2 == "cpu" { cpu[$1] = $3; next }
    { key = $1 "," $2 "," $3; if (!(key in scene)) { order[n++] = key; scene[key] = $1 } }
    $4 == "plan" { planned[key] = $5 }
    $4 == "fit" { runs[key] = $5; iterations[key] = $6; reached[key] = $7 }
    END { for (k = 0; k < n; k++) { key = order[k]; if (!(key in reached)) continue
      s = cpu[scene[key]]
      printf "%s,%d,%.6g,%d,%.0f,%.6g,%.6g,%.6g\n", key, planned[key], planned[key] * s / runs[key], runs[key],
        iterations[key], s, reached[key], s * (reached[key] / se) ^ 2 } }' >"$results/verdict.csv.new"
  mv "$results/verdict.csv.new" "$results/verdict.csv"
}

print_verdict() {
  awk -F, -v se=$se '
    NR == 1 {
      printf "cost of a verdict: rates of %s to a standard error of %g\n", "experiments/alpha.yaml", se
      printf "  %-22s %6s %-8s  %7s %7s  %5s %10s %7s %7s  %s\n", "scene", "alpha", "quantity", "planned", "CPU s",
        "runs", "iterations", "CPU s", "reached", "CPU s for " se
      next }
    { printf "  %-22s %6s %-8s  %7d %7.3g  %5d %10.3g %7.3g %7.4f  %.3g\n", $1, $2, $3, $4, $5, $6, $7, $8, $9, $10
      if ($10 > most[$1]) most[$1] = $10 }
    END {
      for (scene in most) all += most[scene]
      printf "  all of these: %.3g CPU s; those of a scene are of all its alphas, which share their photons\n", all }' "$results/verdict.csv"
}

mkdir -p "$links"
{ cat $yaml && parts; } >"$links/time-to-error.yaml"
"$photonlab" run "$links/time-to-error.yaml" -o "$results" --quality "$quality"
if [ ! "$results/verdict.csv" -nt "$results/manifest.json" ]; then verdict; fi
"$photonlab" efficiency "$results"
print_verdict
"$photonlab" plot "$results"
