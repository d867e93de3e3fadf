#!/bin/sh
# Static runs against CalculiX, node by node to 1e-6 of the largest displacement (its output has 7 digits): distorted
# bricks (C3D8) of data/cases/cantilever.yaml, and distorted quadrilaterals in plane strain (CPE4).
# usage: test-calculix-run.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
cdem=$1/cdem compare=$1/tests/cli/test_cli_displacements cases=$2/data/cases
command -v ccx >/dev/null || { echo "ccx is not installed (Debian package calculix-ccx); skipped" >&2; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
LC_ALL=C
export LC_ALL

solve() { # deck without its ending: displacements of all nodes to DECK.u
  ccx "$1" >"$1.log" 2>&1 || { tail -20 "$1.log"; exit 1; }
  awk 'NF == 4 && $1 + 0 > 0' "$1.dat" >"$1.u"
  [ -s "$1.u" ] || { tail -20 "$1.log"; exit 1; }
}

# Bricks.
sed 's/^\*NODE PRINT, NSET=END/*NODE PRINT, NSET=ALL/' "$2/data/meshes/cantilever.inp" >solid.inp
awk -f "$cases/inp-to-msh.awk" "$2/data/meshes/cantilever.inp" | cmp - "$cases/cantilever.msh"
solve solid
"$cdem" run -q "$cases/cantilever.yaml" -o solid >/dev/null
"$compare" solid/checkpoint.h5 solid.u 1e-6

# Quadrilaterals, 10 x 4, inner nodes moved.
awk 'BEGIN {nx = 10; ny = 4
  print "*NODE, NSET=ALL"
  for (j = 0; j <= ny; j++) for (i = 0; i <= nx; i++) {
    inner = i > 0 && i < nx && j > 0 && j < ny; seed = (seed * 137 + 41) % 1009; a = inner * (seed / 1009 - 0.5) * 0.4
    seed = (seed * 137 + 41) % 1009; b = inner * (seed / 1009 - 0.5) * 0.4
    printf "%d, %.6f, %.6f, 0.\n", j * 100 + i + 1, (i + a) / nx, (j + b) * 0.3 / ny}
  print "*ELEMENT, TYPE=CPE4, ELSET=beam"
  for (j = 0; j < ny; j++) for (i = 0; i < nx; i++) {
    n = j * 100 + i + 1; printf "%d, %d, %d, %d, %d\n", ++e, n, n + 1, n + 101, n + 100}
  print "*NSET, NSET=FIX"; for (j = 0; j <= ny; j++) printf "%d,\n", j * 100 + 1
  print "*NSET, NSET=END"; for (j = 0; j <= ny; j++) printf "%d,\n", j * 100 + nx + 1
  print "*MATERIAL, NAME=STEEL\n*ELASTIC\n210e9, 0.3\n*SOLID SECTION, ELSET=beam, MATERIAL=STEEL\n1.\n*STEP\n*STATIC"
  print "*BOUNDARY\nFIX, 1, 2\n*CLOAD\nEND, 2, -200.\n*NODE PRINT, NSET=ALL\nU\n*END STEP"}' >plane.inp
awk -f "$cases/inp-to-msh.awk" plane.inp >plane.msh
solve plane
cat >plane.yaml <<'EOF'
title: Quadrilaterals in plane strain
analysis: static
plane: strain
mesh: plane.msh
materials:
  steel: {young: 210 GPa, poisson: 0.3}
supports:
  - {group: fixed, displacement: {x: 0, y: 0}}
loads:
  - {group: end, force: {y: -1 kN}}
EOF
"$cdem" run -q plane.yaml -o plane >/dev/null
"$compare" plane/checkpoint.h5 plane.u 1e-6
