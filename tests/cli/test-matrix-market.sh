#!/bin/sh
# The matrix of a network against the springs themselves: awk reads both files, adds up the pulls of all rows of the
# table, and multiplies the matrix. The table is held against another derivation of the elements in rebuild.c.
# usage: test-matrix-market.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
cdem=$1/cdem here=$2/tests/cli meshes=$2/data/meshes
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

network() { # MESH OPTIONS...
  mesh=$1
  shift
  "$cdem" springs -q "$mesh" "$@" -o net.csv -o net.mtx >/dev/null
  # "TAG 0 0 0 UX UY UZ" for every node of the table.
  awk -F, 'BEGIN {srand(7)}
    NR > 1 {for (c = 3; c <= 4; c++) if (!($c in seen)) {seen[$c] = 1
      printf "%s 0 0 0 %.17g %.17g %.17g\n", $c, rand() - 0.5, rand() - 0.5, rand() - 0.5}}' net.csv >moved
  awk -f "$here/pull.awk" net.mtx moved | sort >matrix
  awk '
    FNR == NR {for (c = 1; c <= 3; c++) u[$1, c] = $(c + 4); f[$1, 1] = f[$1, 2] = f[$1, 3] = 0; next}
    FNR == 1 {FS = ","; $0 = $0; for (c = 1; c <= NF; c++) at[$c] = c; next}
    {set = $at["element"] " " $at["node_i"] " " $at["node_j"]
     if (set != last) {add(); last = set; rows = 0; i = $at["node_i"]; j = $at["node_j"]}
     row[++rows] = $0}
    END {add(); for (key in f) {split(key, part, SUBSEP); if (part[2] == 1)
      printf "%s %.17g %.17g %.17g\n", part[1], f[part[1], 1], f[part[1], 2], f[part[1], 3]}}
    # f_i += S (u_j - u_i), f_j -= transpose of S times that, S = sum of dir (x) (stiffness dual + coupling dual[to])
    function add(r, a, b, n, of, value, d, q, g) {
      for (r = 1; r <= rows; r++) {
        split(row[r], value, ",")
        for (a = 1; a <= 3; a++) if (value[at["coupling"]] == "" || value[at["stiffness"]] != 0)
          dual[value[at["spring"]], a] = value[at["dual_x"] + a - 1]
      }
      for (r = 1; r <= rows; r++) {
        split(row[r], value, ",")
        for (a = 1; a <= 3; a++) for (b = 1; b <= 3; b++) {
          q = value[at["stiffness"]] * value[at["dual_x"] + b - 1]
          if (value[at["couples_to"]] != "") q += value[at["coupling"]] * dual[value[at["couples_to"]], b]
          g = value[at["dir_x"] + a - 1] * q
          f[i, a] += g * (u[j, b] - u[i, b])
          f[j, b] -= g * (u[j, a] - u[i, a])
        }
      }
    }' moved net.csv | sort >springs
  awk -v name="$(basename "$mesh") $*" -v bound=1e-12 -f "$here/differ.awk" springs matrix
}
network "$meshes/cantilever.inp" -E 210e9 --nu 0.3
network "$meshes/mixed.msh" -E 40e9 --nu 0.01
awk -v kind=quad4 -v n=5 -v h=0.3 -f "$here/lattice.awk" >net.inp
network net.inp -E 40e9 --nu=-0.2 --plane stress --thickness 0.02
