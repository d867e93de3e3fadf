#!/bin/sh
# Every shipped case runs, its key results agree with their references, and its energy book closes to 1e-3.
# usage: test-cases.sh BUILD_FOLDER SOURCE_FOLDER [CASE...]
set -eu
cdem=$1/cdem cases=$2/data/cases
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
[ $# -gt 0 ] || set -- cantilever plate-with-hole bar-wave compression brazilian-disc notched-beam slope-joint block-stack impact angle-of-repose biaxial \
  settling hopper drum foundation-a triaxial
failed=0
for name; do
  if ! "$cdem" run -q "$cases/$name.yaml" -o "$work/$name" >"$work/out" 2>&1; then
    echo "$name: the run failed, or a key result is off"
    cat "$work/out"
    failed=1
    continue
  fi
  # The largest entry of the column energy_error.
  error=$(awk -F, 'NR == 1 {for (i = 1; i <= NF; i++) if ($i ~ /^"?energy_error/) c = i; next}
                   $c + 0 > worst {worst = $c + 0} END {print c ? worst + 0 : "none"}' "$work/$name/history.csv")
  awk -v e="$error" 'BEGIN {exit !(e != "none" && e + 0 < 1e-3)}' ||
    { echo "$name: the energy book is off by $error of the work"; failed=1; }
  ls "$work/$name/figures/"*.png >/dev/null 2>&1 || [ "$name" = cantilever ] || [ "$name" = plate-with-hole ] ||
    { echo "$name: no figure was drawn"; failed=1; }
done
exit $failed
