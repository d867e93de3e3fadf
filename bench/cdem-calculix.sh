#!/bin/sh
# CalculiX explicit dynamics on a box of C3D8 bricks, as a peer of bench_cdem: element-steps a second.
#
#     bench/cdem-calculix.sh [BRICKS A SIDE, 12] [STEPS, 200] [THREADS, 1]
#
# The deck is run twice, with few steps and with many; the difference is the time of the steps alone.
# C3D8 is the fully integrated brick (2x2x2 points), as is hex8 here. ccx is slow at this: the default
# box is smaller than that of bench_cdem, and both numbers are rates, so that they compare.
set -eu
side=${1:-12} steps=${2:-200} threads=${3:-1}
command -v ccx > /dev/null || { echo "ccx is not installed (Debian package calculix-ccx)" >&2; exit 2; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# ccx chooses the step itself (with DIRECT, 2.20 does not come to an end); the step it says it has
# selected is about the time of a compression wave through a brick. Steps = time / that step.
deck() {
  awk -v n="$side" -v steps="$1" 'BEGIN {
    h = 1.0 / n; m = n + 1
    print "*NODE, NSET=ALL"
    for (k = 0; k <= n; k++) for (j = 0; j <= n; j++) for (i = 0; i <= n; i++)
      printf "%d, %.9g, %.9g, %.9g\n", 1 + i + m * (j + m * k), i * h, j * h, k * h
    print "*ELEMENT, TYPE=C3D8, ELSET=BODY"
    for (k = 0; k < n; k++) for (j = 0; j < n; j++) for (i = 0; i < n; i++) {
      a = 1 + i + m * (j + m * k)
      printf "%d, %d, %d, %d, %d, %d, %d, %d, %d\n", ++e, a, a + 1, a + m + 1, a + m,
             a + m * m, a + m * m + 1, a + m * m + m + 1, a + m * m + m
    }
    print "*MATERIAL, NAME=ROCK\n*ELASTIC\n30e9, 0.25\n*DENSITY\n2700.\n*SOLID SECTION, ELSET=BODY, MATERIAL=ROCK"
    print "*INITIAL CONDITIONS, TYPE=VELOCITY"
    print "ALL, 1, 1e-3"
    dt = h / sqrt(36e9 / 2700.0)
    printf "*STEP, INC=1000000, NLGEOM\n*DYNAMIC, EXPLICIT\n%.9g, %.9g\n", dt / 10, steps * dt
    print "*CLOAD\n1, 1, 1e3"
    print "*NODE PRINT, NSET=ALL, FREQUENCY=1000000, TOTALS=ONLY\nRF\n*END STEP"
  }' > "$folder/box.inp"
}

# Seconds of a run with time for $1 steps, that time, and the step ccx selected.
timed() {
  deck "$1"
  start=$(date +%s.%N)
  (cd "$folder" && OMP_NUM_THREADS=$threads timeout 300 ccx box > box.log 2>&1) ||
    { echo "ccx failed or took more than 300 s" >&2; tail -5 "$folder/box.log" >&2; exit 1; }
  stop=$(date +%s.%N)
  selected=$(sed -n 's/.*SELECTED time increment: *//p' "$folder/box.log" | tail -1)
  span=$(awk -F', ' 'line == 1 { print $2; line = 0 } /^\*DYNAMIC/ { line = 1 }' "$folder/box.inp")
  echo "$start $stop $span $selected" | awk '{ print $2 - $1, $3, $4 }'
}

few=$(timed $((steps / 10)))
many=$(timed "$steps")
echo "$few $many $side" | awk -v threads="$threads" '{
  cells = $7 ^ 3; seconds = $4 - $1
  if ($6 <= 0 || seconds <= 0) { print "no steps were counted" > "/dev/stderr"; exit 1 }
  count = ($5 - $2) / $6
  printf "ccx explicit, %d C3D8, %d thread(s): %.0f steps in %.2f s, %.3f million element-steps a second\n",
         cells, threads, count, seconds, cells * count / seconds / 1e6
}'
