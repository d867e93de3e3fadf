#!/bin/sh
# LAMMPS (gran/hooke/history with walls) and our solver on the same 256 spheres in a box: forces at the start, and
# places, velocities, spins and forces after a hundred steps. Both take the velocity half a step back for dashpots and
# histories, so that nothing but rounding and the arms (LAMMPS: radii; ours: to the contact point) may differ.
# usage: test-lammps-dem.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
grains=$1/tests/cli/test_cli_grains
command -v lmp >/dev/null || { echo "lmp is not installed (Debian package lammps); skipped" >&2; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export OMP_NUM_THREADS=1

cat >box.in <<'END'
units         si
atom_style    sphere
boundary      f f f
newton        off
comm_modify   vel yes
read_data     ${data}
neighbor      0.002 bin
neigh_modify  every 1 delay 0 check yes
pair_style    gran/hooke/history ${kn} ${kt} ${gn} 0 ${mu} 0 limit_damping
pair_coeff    * *
timestep      1e-5
fix           x all wall/gran hooke/history ${kn} ${kt} ${gw} 0 ${mu} 0 limit_damping xplane 0 ${width}
fix           y all wall/gran hooke/history ${kn} ${kt} ${gw} 0 ${mu} 0 limit_damping yplane 0 ${width}
fix           z all wall/gran hooke/history ${kn} ${kt} ${gw} 0 ${mu} 0 limit_damping zplane 0 ${width}
fix           move all nve/sphere
thermo        ${steps}
dump          state all custom 100000 lammps.state id x y z vx vy vz omegax omegay omegaz fx fy fz
dump_modify   state sort id format float %.17g first yes
run           ${steps}
write_dump    all custom last.state id x y z vx vy vz omegax omegay omegaz fx fy fz modify sort id format float %.17g
END

# Largest difference over the largest value: of ways (places less those of the start), velocities, spins, forces.
compare() { # STATE_A STATE_B START NAME TOLERANCES(4)
  awk -v name="$4" -v allowed="$5" '
    FNR == 1 { file++ } NF != 13 { next }
    file == 1 { for (k = 2; k <= 13; k++) a[$1, k] = $k; rows++; next }
    file == 2 { for (k = 2; k <= 13; k++) b[$1, k] = $k; seen++; next }
    { for (k = 2; k <= 13; k++) {
        start = k <= 4 ? $k : 0
        d = a[$1, k] - b[$1, k]; v = a[$1, k] - start; g = int((k - 2) / 3)
        if (d < 0) d = -d; if (v < 0) v = -v
        if (d > worst[g]) worst[g] = d; if (v > largest[g]) largest[g] = v } }
    END { split(allowed, bound); split("way velocity spin force", word)
      for (g = 0; g < 4; g++) {
        if (bound[g + 1] == "-") continue
        share = largest[g] > 0 ? worst[g] / largest[g] : 1
        printf "%s: %s differs by %.2e of the largest, %.3e (allowed %s)\n", name, word[g + 1], share, largest[g], bound[g + 1]
        if (!(share <= bound[g + 1])) failed = 1 }
      exit !(rows == 256 && seen == 256 && !failed) }' "$1" "$2" "$3"
}
both() { # KIND STEPS
  "$grains" "$1" "$2" box.data >ours.state
  "$grains" "$1" 0 box.data >start.state
  rm -f lammps.state last.state
  lmp -in box.in -log none $("$grains" numbers "$1") -var data box.data -var steps "$2" >log 2>&1 ||
    { tail -5 log; exit 1; }
  sed -n '/^ITEM: ATOMS/,$p' last.state | sed 1d >theirs.state
}
both pressed 0
compare ours.state theirs.state start.state "256 pressed spheres, at once" "- - - 1e-10"
both loose 100
compare ours.state theirs.state start.state "256 loose spheres, 100 steps" "1e-5 1e-5 1e-5 1e-5"
# The arms' difference is an overlap over a diameter, 2e-6 and 2e-7: what differs after many contacts is ten times that,
# and a tenth with a tenth of the overlap.
both held 100
compare ours.state theirs.state start.state "256 held spheres, 100 steps" "3e-5 3e-5 3e-5 3e-5"
both finer 100
compare ours.state theirs.state start.state "256 held spheres, a tenth as deep" "3e-6 3e-6 3e-6 3e-6"
