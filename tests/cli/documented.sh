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
check 'there are commands and options' test -n "$commands" -a -n "$options"
done_testing
