#!/bin/bash
# What the program says of itself, the man page says too.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
page=src/app/photonlab.1
commands=$("$photonlab" --help | awk '/^  [a-z]/ { print $1 }')

for command in $commands; do
  check "the man page has the command $command" grep -qE "^\.(B|BI|BR) $command( |$)" $page
done

options=$(for command in $commands; do "$photonlab" "$command" --help; done |
  grep -oE '^ +--[a-z-]+' | sort -u)
for option in $options; do
  check "the man page has the option $option" grep -qF -- "${option//-/\\-}" $page
done
for command in $commands; do
  for option in --seed --threads --quiet; do
    check "$command takes $option" grep -q -- "^ *$option " <("$photonlab" "$command" --help)
  done
done
check 'a command says where an option has no effect' \
  grep -q -- '--seed SEED *accepted, without effect here' <("$photonlab" fit --help)
for experiment in experiments/*.yaml; do
  name=$(basename "$experiment" .yaml)
  check "experiment $name has a figure" test -s "paper-figures/$name.gp" -a -s "paper-figures/$name.png"
  check "the README shows it" grep -q "paper-figures/$name.png" README.md
done
check 'list takes the options all take' "$photonlab" list laws --seed 1 --threads 2 --quiet
check 'info takes the options all take' \
  "$photonlab" info scenes/cornell-box.pbrt --seed name --threads 2 --quiet
check 'there are commands and options' test -n "$commands" -a -n "$options"
done_testing
