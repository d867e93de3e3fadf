#!/bin/sh
# LAMMPS pulls the bonds we export; its forces at displaced nodes are -K u of the assembled matrix, which awk reads and
# multiplies. Networks whose pairs are springs along and across their lines must agree wherever the nodes go; in the
# others the inner pairs are such, so their inner nodes move alone.
# usage: test-lammps-net.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
cdem=$1/cdem here=$2/tests/cli
command -v lmp >/dev/null || { echo "lmp is not installed (Debian package lammps); skipped" >&2; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export OMP_NUM_THREADS=1

# The input is that of the file's own comments, then each node where it belongs.
forces() { # DATA DISPLACEMENTS -> theirs
  { sed -n 's/^#> //p' "$1"
    awk '{printf "set atom %d x %.17g y %.17g z %.17g\n", $1, $2 + $5, $3 + $6, $4 + $7}' "$2"
    echo 'dump f all custom 1 lammps.forces id fx fy fz'
    echo 'dump_modify f sort id format float %.17g'
    echo 'run 0'
  } >net.in
  lmp -in net.in -log none -var data "$1" >log 2>&1 || { tail -5 log; exit 1; }
  sed -n '/^ITEM: ATOMS/,$p' lammps.forces | sed 1d >theirs
}
network() { # KIND CELLS INSIDE OPTIONS...
  kind=$1 cells=$2 inside=$3
  shift 3
  awk -v kind="$kind" -v n="$cells" -v h=0.3 -f "$here/lattice.awk" >net.inp
  "$cdem" springs -q net.inp -E 40e9 "$@" -o net.data -o net.mtx >said 2>&1
  awk -v n="$cells" -v size=3e-8 -v inside="$inside" -f "$here/move.awk" net.inp >moved
  awk -f "$here/pull.awk" net.mtx moved >ours
  forces net.data moved
  awk -v name="$kind $*" -v bound=1e-6 -f "$here/differ.awk" ours theirs
}
# lambda = G: nothing but bonds along the lines.
network tri3 5 0 --nu 0.25 --carry exact
network tri3 5 0 --nu 0.33333333333333331 --plane stress --carry central
grep -q ' 85 are a spring along their line' said
# One stiffness across, on the boundary too.
network quad4 5 0 --nu 0.25 --carry exact
# Boundary pairs of these hold more; inner nodes know none of them.
network tri3 5 1 --nu 0.4
network quad4 5 1 --nu 0.1 --plane stress --thickness 0.02
network hex8 3 1 --nu 0.25
network hex8 3 1 --nu 0.4
grep -q 'lacks a part of' said

# At rest no force, although bonds of rest length 0 pull with across times length; 26 bonds a node, rounded to 46 bits.
awk -v size=0 -f "$here/move.awk" net.inp >moved
forces net.data moved
awk 'FNR == NR {if ($1 == "Balance") on = 1; if (on) for (c = 2; c <= NF; c++) {v = $c < 0 ? -$c : $c; if (v > pull) pull = v}; next}
     {for (c = 2; c <= 4; c++) {if ($c !~ /^[-+0-9.e]+$/) bad = 1; v = $c < 0 ? -$c : $c; if (v > worst) worst = v}; seen++}
     END {printf "at rest: %d nodes, %.2e N, with balancing forces up to %.2e N\n", seen, worst, pull
          exit !(!bad && seen == 64 && pull > 0 && worst <= 1e-12 * pull)}' net.data theirs

# Bonds along the lines alone follow any rotation without a force.
awk -v kind=quad4 -v n=5 -v h=0.3 -f "$here/lattice.awk" >net.inp
"$cdem" springs -q net.inp -E 40e9 --nu 0.25 --carry central -o net.data -o net.mtx >said 2>&1
# 60 edges and 50 diagonals; each has stiffness across its line, G/6 an element.
grep -q ' 110 are cut' said
awk -v angle=0.7 -f "$here/move.awk" net.inp >moved
forces net.data moved
awk '{for (c = 2; c <= 4; c++) {if ($c !~ /^[-+0-9.e]+$/) bad = 1; v = $c < 0 ? -$c : $c; if (v > worst) worst = v}; seen++}
     END {printf "turned by 0.7: %.2e N\n", worst; exit !(!bad && seen == 36 && worst <= 1e-12 * 40e9 * 0.3)}' theirs
