#!/bin/sh
# Bonded spheres in bricks (data/cases/foundation-3d.yaml): the coupled load agrees with that of spheres everywhere within 2 %,
# its error is below a fifth of the null test's, and the energy books close to 1e-3.
# usage: test-solid.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
cdem=$1/cdem case=$2/data/cases/foundation-3d.yaml
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export OMP_WAIT_POLICY=passive
for version in coupled frozen grains; do
  "$cdem" run -q --no-figures "$case" --set coupling.version=$version -o $version
done
# Mean of the load over the last 2 ms, mean of |difference| over the whole curve, largest error of the book.
awk -F, '
  FNR == 1 {run++; for (i = 1; i <= NF; i++) {if ($i ~ /^load\.plate\.fz/) f = i; if ($i ~ /^energy_error/) e = i}; next}
  {load[run, FNR] = $f; rows = FNR; if (run < 3 || $e > 0) worst = $e > worst ? $e : worst}
  END {
    for (i = 2; i <= rows; i++) {
      off[1] += (d = load[1, i] - load[3, i]) < 0 ? -d : d
      off[2] += (d = load[2, i] - load[3, i]) < 0 ? -d : d
      all += load[3, i]
    }
    for (i = rows - 2; i <= rows; i++) {last[1] += load[1, i]; last[2] += load[2, i]; last[3] += load[3, i]}
    end1 = last[1]/last[3] - 1; end2 = last[2]/last[3] - 1
    printf "coupled: %.4f at the end, %.4f in the mean; null: %.4f, %.4f; book %.2g\n", end1, off[1]/all, end2, off[2]/all, worst
    if (!(all > 0) || end1 > 0.02 || end1 < -0.02 || off[1] > 0.02*all) {print "not within 2 % of spheres everywhere"; bad = 1}
    if (off[1] > off[2]/5 || (end1 < 0 ? -end1 : end1) > end2/5) {print "not below a fifth of the null"; bad = 1}
    if (!(worst < 1e-3)) {print "the energy book is off"; bad = 1}
    exit bad
  }' coupled/history.csv frozen/history.csv grains/history.csv
