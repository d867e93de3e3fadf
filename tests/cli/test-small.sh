#!/bin/sh
# One small case of every engine (tests/small): one thread and three write the same history and the same frames to the last byte, and the
# energy book closes. Steps are coarse there, so it closes to half a percent; data/cases keep a tenth (cli.cases).
# usage: test-small.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
cdem=$1/cdem cases=$2/tests/small
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
for file in "$cases"/*.yaml; do
  name=$(basename "$file" .yaml)
  for threads in 1 3; do
    "$cdem" run -q --no-figures --threads $threads "$file" -o "$work/$threads"
  done
  frames=$(cd "$work/1" && find . -name '*.vtu' -o -name '*.vtp')
  [ -n "$frames" ] || { echo "$name: there are no frames"; failed=1; }
  for result in history.csv $frames; do
    cmp "$work/1/$result" "$work/3/$result" || { echo "$name: three threads change $result"; failed=1; }
  done
  # At the end, since the error is relative to the work done so far.
  awk -F, -v name="$name" 'NR == 1 {for (i = 1; i <= NF; i++) if ($i == "energy_error") c = i; next} {last = $c}
    END {if (!c || last !~ /^[0-9][0-9.e+-]*$/ || !(last + 0 < 5e-3)) {print name ": energy error " last; exit 1}}' "$work/1/history.csv" || failed=1
  rm -r "$work/1" "$work/3"
done
exit $failed
