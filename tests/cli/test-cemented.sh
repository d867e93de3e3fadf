#!/bin/sh
# Grains inside a body that breaks (data/cases/footing-cemented.yaml):
#   broken     faces crack and bonds break, the energy book closes to 1e-3, and the load differs by less than 5 % from that
#              with a fine region one element larger on each side, in the mean over the curve and at the end;
#   unbroken   tied faces too strong to fail give the load of one unbreakable body to 1e-10.
# usage: test-cemented.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
cdem=$1/cdem case=$2/data/cases/footing-cemented.yaml
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export OMP_WAIT_POLICY=passive
run() { # FOLDER OVERRIDE...
  folder=$1
  shift
  for override; do set -- "$@" --set "$override"; shift; done
  "$cdem" run -q --no-figures "$case" "$@" -o "$folder"
}
run broken
run larger 'coupling.regions=[{low: [-1.25 m, -1.25 m], high: [1.25 m, 0.1 m]}]'
run strong 'interfaces=[{insertion: tied, tension: 1e9 MPa, cohesion: 1e9 MPa, friction: 0.5}]'
run body 'blocks={}' 'interfaces=[]'
bad=0

# compare A B: mean of |difference| over mean, and the relative difference of the last 2 ms; the largest difference over the
# largest load; of A: largest error of the book, cracked faces, broken bonds.
compare() {
  awk -F, '
    FNR == 1 {
      run++
      for (i = 1; i <= NF; i++) {
        if ($i ~ /^load\.plate\.fy/) f[run] = i
        if ($i ~ /^energy_error/) e = i
        if ($i ~ /^coarse\.cracks/) c = i
        if ($i ~ /^fine\.bonds_broken/) b = i
      }
      next
    }
    {load[run, FNR] = $(f[run]); rows[run] = FNR}
    run == 1 {if ($e > worst) worst = $e; cracks = c ? $c : 0; broken = b ? $b : 0}
    END {
      if (rows[1] != rows[2]) {print "rows differ" >"/dev/stderr"; exit 1}
      for (i = 2; i <= rows[1]; i++) {
        x = load[1, i]; d = load[2, i] - x; d = d < 0 ? -d : d
        all += x; off += d; if (d > most) most = d; if (x > top) top = x
      }
      for (i = rows[1] - 2; i <= rows[1]; i++) {a += load[1, i]; z += load[2, i]}
      end = z/a - 1
      print off/all, end < 0 ? -end : end, most/top, worst, cracks, broken
    }' "$1/history.csv" "$2/history.csv"
}

set -- $(compare broken larger)
echo "larger fine region: $1 in the mean, $2 at the end; book $4; $5 cracked faces, $6 broken bonds"
awk -v mean="$1" -v end="$2" 'BEGIN {exit !(mean > 0 && mean < 0.05 && end < 0.05)}' || { echo "the load is not within 5 %"; bad=1; }
awk -v error="$4" 'BEGIN {exit !(error > 0 && error < 1e-3)}' || { echo "the energy book is off"; bad=1; }
[ "$5" -ge 10 ] && [ "$6" -ge 10 ] || { echo "hardly anything breaks: the test shows nothing"; bad=1; }
set -- $(compare strong body)
echo "unbroken: $3 of the largest load"
awk -v most="$3" 'BEGIN {exit !(most >= 0 && most < 1e-10)}' || { echo "tied faces are not one body"; bad=1; }
[ "$5" -eq 0 ] || { echo "strong faces have cracked"; bad=1; }
exit $bad
