#!/bin/sh
# A run that is interrupted, or killed, and continued gives the same bits as an unbroken one: a column that breaks
# off its foot and falls, so that interfaces, contact and their histories are on the way.
# usage: test-run-interrupt.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
. "$2/tests/cli/runs.sh"
cat >case.yaml <<'EOC'
title: A beam that breaks under its weight and a push
end: 20 ms
mesh: {shape: quad4, count: [24, 4], size: [1.2 m, 0.2 m]}
materials: {rock: {young: 1 GPa, poisson: 0.2, density: 2500 kg/m3}}
blocks: {breakable: body}
interfaces:
  - {tension: 0.1 MPa, cohesion: 0.2 MPa, friction: 0.5, softening: linear, energy_1: 5 J/m2, energy_2: 20 J/m2}
contact: {friction: 0.5}
gravity: [0, -9.81 m/s2]
supports: [{group: x0, displacement: {x: 0, y: 0}}]
loads: [{group: x1, traction: {y: {ramp: -50 kPa, over: 2 ms}}}]
frame_every: 2 ms
checkpoint_every: 1 ms
results: {cracks: {of: cracks, take: last}}
EOC
"$cdem" run -q --no-figures case.yaml -o whole
cracks=$(sed -n 's/^    "cracks": \([0-9][0-9]*\).*/\1/p' whole/summary.json)
[ "${cracks:-0}" -gt 0 ] || { echo "the beam does not break: the test shows nothing"; exit 1; }

# Ctrl-C, twice on the way
"$cdem" run -q --no-figures case.yaml -o broken 2>err &
process=$!
wait_for_rows broken 100 $process
kill -INT $process
code=0
wait $process || code=$?
[ $code -eq 130 ] || { echo "Ctrl-C: exit code $code"; cat err; exit 1; }
grep -q '^error: interrupted at step .*continue with `cdem run --resume broken`$' err || { cat err; exit 1; }
[ ! -e broken/summary.json ] || { echo "a broken run has a summary"; exit 1; }
"$cdem" run -q --no-figures --resume broken 2>err &
process=$!
wait_for_rows broken 250 $process
kill -INT $process
code=0
wait $process || code=$?
[ $code -eq 130 ] || { echo "Ctrl-C: exit code $code"; cat err; exit 1; }
"$cdem" run -q --no-figures --resume broken
same broken

# kill -9, at several moments of one run and again after each continuation: rows and frames may be ahead of the
# checkpoint, and a frame or a row may be half written
"$cdem" run -q --no-figures case.yaml -o killed &
process=$!
for rows in 40 150 260 340; do
  wait_for_rows killed $rows $process
  kill -9 $process
  wait $process 2>/dev/null || true
  "$cdem" run -q --no-figures --resume killed &
  process=$!
done
wait $process
same killed

# killed before there is a checkpoint, there is nothing to continue; a new run takes the folder
mkdir early
: >early/.lock
cp case.yaml early/case.yaml
code=0
"$cdem" run -q --resume early 2>err || code=$?
[ $code -eq 3 ] || { echo "no checkpoint: exit code $code"; cat err; exit 1; }
grep -q "^error: there is no run to continue in 'early': .* -o early\`\$" err || { cat err; exit 1; }
"$cdem" run -q --no-figures case.yaml -o early
same early
echo "the same bits: $cracks cracks"
