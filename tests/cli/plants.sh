#!/bin/bash
# The harness of tests/plants, in a repository of three files: what it accepts and what it rejects.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
unset MAKEFLAGS MAKELEVEL
tree=$scratch/tree
mkdir -p "$tree/tests/plants"
cp tests/plants/run "$tree/tests/plants/run"
check "the patch of pbrt-v4's coat applies" git apply --check tests/conformance/pbrt-coat.patch
cd "$tree" || exit
printf 'all build/value:\n\tmkdir -p build\n\tcat value >build/value\n.PHONY: build/value\n' >Makefile
echo 3 >value
git init -q . && git add .

# planted SENTENCE OLD NEW RUN EXPECT VERDICT: the verdict on the patch that replaces OLD by NEW
planted() {
  cat >tests/plants/value.patch <<END
# what: another value
# run: $4
${5:+# expect: $5}
--- a/value
+++ b/value
@@ -1 +1 @@
-$2
+$3
END
  local output status=0
  output=$(tests/plants/run) || status=$?
  if [[ $output == *"$6"* && $(tail -n 1 <<<"$output") == [01]" passed, $status failed" ]]; then
    ok "$1"
  else
    not_ok "$1" "$output"
  fi
}

# shellcheck disable=SC2016 # for the harness to expand
is3='echo "value $(cat build/value)"; grep -q 3 build/value'
planted 'a bug the test finds' 3 4 "$is3" '' 'ok - tests/plants/value.patch: another value'
planted 'a bug the test finds, and says so' 3 4 "$is3" '^value 4$' ': another value'
planted 'a bug found for another reason' 3 4 "$is3" '^value 5$' 'no line matches: ^value 5$'
planted 'a bug the test does not find' 3 33 "$is3" '' 'not found by the test'
planted 'a patch that no longer applies' 5 4 "$is3" '' 'no longer applies'
planted 'a test that fails without the bug' 3 4 'grep -q 7 build/value' '' 'fails without the bug too'
planted 'a patch without a command' 3 4 '' '' 'has no "# run:" line'
done_testing
