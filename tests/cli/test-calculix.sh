#!/bin/sh
# CalculiX solves its own C3D8 model of the distorted cantilever, and the springs we export from the same
# mesh; the displacements must agree to 1e-6 of the largest (its output has 7 digits).
# usage: test-calculix.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
cdem=$1/cdem mesh=$2/data/meshes/cantilever.inp
command -v ccx >/dev/null || { echo "ccx is not installed (Debian package calculix-ccx); skipped" >&2; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The deck as it is, printing all nodes; and the same supports and loads on the springs alone.
sed 's/^\*NODE PRINT, NSET=END/*NODE PRINT, NSET=ALL/' "$mesh" >solid.inp
"$cdem" springs -q "$mesh" -E 210e9 --nu 0.3 -o springs.inp >/dev/null
{ echo '*INCLUDE, INPUT=springs.inp'
  awk '/^\*/ {on = /^\*NSET/ || stepping || /^\*STEP/; if (/^\*STEP/) stepping = 1} on' "$mesh" |
    sed 's/^\*NODE PRINT, NSET=END/*NODE PRINT, NSET=Nall/'
} >network.inp

for deck in solid network; do
  ccx $deck >$deck.log 2>&1 || { tail -20 $deck.log; exit 1; }
  awk 'NF == 4 && $1 + 0 > 0' $deck.dat | sort -n >$deck.u
  [ -s $deck.u ] || { tail -20 $deck.log; exit 1; }
done
awk 'NR == FNR {for (i = 2; i <= 4; i++) u[$1, i] = $i; nodes++; next}
     {for (i = 2; i <= 4; i++) {d = u[$1, i] - $i; d = d < 0 ? -d : d; a = $i < 0 ? -$i : $i
        if (d > worst) worst = d; if (a > largest) largest = a} seen++}
     END {printf "%d nodes, largest displacement %.6e m, largest difference %.2e of it\n", seen, largest, worst / largest
          exit !(seen == nodes && seen > 0 && largest > 0 && worst <= 1e-6 * largest)}' solid.u network.u
