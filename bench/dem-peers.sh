#!/bin/sh
# The granular solver and its peers on the same work in the same call: particle-steps a second.
#
#     bench/dem-peers.sh [--quick] [--cpu] [BUILD FOLDER, build/release]
#
# Works (bench/dem-work.c has their numbers): `box`, 10 000 and 50 000 equal spheres settled in a box with five walls,
# linear law with dashpots and tangential history; `plate`, 20 000 discs in a lattice at 45 degrees, pushed by a row of
# discs at 1 m/s. Our solver settles the box once; the places are kept in the build folder. --quick: 10 000 spheres
# and the lattice, a fifth of the steps. --cpu: processor time instead of the clock, of all steps less that of one, for a
# machine that has other things to do; one core only.
#
# What makes it the same work, and fair:
# - Every program starts from the same places at rest and goes the same number of steps of the same length, on one core
#   (then ours and LAMMPS on two: threads against MPI). Times are those of the loop alone, by each program's own timer.
# - The law: F_n = kn overlap + c v_n, not below zero, shear spring with history, Coulomb's bound, no shear dashpot, no
#   rolling resistance. LAMMPS: gran/hooke/history with limit_damping; LIGGGHTS: hooke/stiffness tangential history;
#   YADE: CundallStrack with the same springs, without dashpots (less to compute), local damping 0.2 instead.
# - Each peer's neighbour skin is tried at several widths and its best time counts; ours keeps its automatic one, best of
#   three. Lists are renewed when grains moved half the skin, not on a schedule. Debian's builds as they are: without
#   LAMMPS' OPENMP, INTEL and KOKKOS packages.
# - Plane: LAMMPS has discs (inertia m r^2/2) by enforce2d, YADE by blocked freedoms, LIGGGHTS by its dimension 2.
# - The last column is the kinetic energy at the end, J, of translation + rotation (plate: of translation for LAMMPS and
#   LIGGGHTS, the plate's own with it): with equal physics the first three agree. YADE goes a tenth of the steps, and its
#   damping differs.
set -eu
export LC_ALL=C OMP_NUM_THREADS=1 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
quick=false cpu=false
while :; do
  case ${1:-} in
    --quick) quick=true ;;
    --cpu) cpu=true ;;
    -*) sed -n '2,/^set -eu/{/^set/d;s/^# \{0,1\}//;p}' "$0"; exit 2 ;;
    *) break ;;
  esac
  shift
done
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "${1:-$here/../build/release}" && pwd)
ours=$build/bench/bench_dem-work
[ -x "$ours" ] || { echo "$ours is not built (cmake -DCDEM_BENCH=ON)" >&2; exit 2; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$build/bench/works"

# Places as LAMMPS and LIGGGHTS read them. In the plane LIGGGHTS knows the mass of a disc; for LAMMPS a sphere of another
# density has it.
data() { # FILE TYPES DISC(yes/no)
  awk -v types="$2" -v disc="$3" -v dim="$dim" -v rho="$rho" -v width="$width" '
    { n++; if ($3 > top) top = $3; if ($2 > high) high = $2
      line[n] = n " " $5 + 1 " " 2 * $4 " " (dim == 2 && disc == "no" ? rho * 0.75 / $4 : rho) " " $1 " " $2 " " $3; r = $4 }
    END { print "grains\n\n" n " atoms\n" types " atom types\n0 " width " xlo xhi"
      if (dim == 2) printf "0 %.17g ylo yhi\n%.17g %.17g zlo zhi\n", high + 20 * r, -r, r
      else printf "0 %s ylo yhi\n0 %.17g zlo zhi\n", width, top + 20 * r
      print "\nAtoms\n"
      for (i = 1; i <= n; i++) print line[i] }' "$1"
}

# One run of a program: $1 steps, $2 skin over the radius, $3 cores. Prints seconds of the loop and energies.
loop() { # LOG STEPS: of LAMMPS or LIGGGHTS
  awk -v steps="$2" '/^ *[0-9]+ +[0-9]+ / && $1 == steps { energy = $3 (NF > 3 ? " + " $4 : "") }
    /^Loop time/ { print $4, energy } /ERROR/ { print > "/dev/stderr" }' "$1"
}
run_cdem() { "$ours" run "$work" "$grains" "$file" "$1" "$3" | awk '{ print $2, $3 " + " $4 }'; }
run_lammps() {
  launch=
  [ "$3" -eq 1 ] || launch="mpirun --oversubscribe --bind-to none -np $3"
  $launch lmp -in "$here/peers/lammps-$work.in" -log none $numbers -var data "$folder/one.data" \
    -var skin "$(echo "$2 $radius" | awk '{ print $1 * $2 }')" -var steps "$1" >"$folder/log" 2>&1 || tail -3 "$folder/log" >&2
  loop "$folder/log" "$1"
}
run_liggghts() {
  (cd "$folder" && liggghts -in "$here/peers/liggghts-$work.in" -log none $numbers -var data "$folder/two.data" \
    -var skin "$(echo "$2 $radius" | awk '{ print $1 * $2 }')" -var steps "$1" >"$folder/log" 2>&1) || tail -3 "$folder/log" >&2
  loop "$folder/log" "$1"
}
run_yade() {
  (cd "$folder" && KN=$kn KT_KN=$kt_kn MU=$mu DT=$dt WIDTH=$width SPEED=$speed DENSITY=$rho \
    yade -n -x -j 1 "$here/peers/yade_work.py" "$work" "$file" "$1" "$2" >"$folder/log" 2>&1) || tail -3 "$folder/log" >&2
  sed -n 's/^YADE .* steps \([0-9.]*\) s, kinetic energy \([^ ]*\) J.*/\1 \2/p' "$folder/log"
}
cpu_of() { # COMMAND: processor seconds, then what follows the seconds it prints
  (once=$("$@"); times >"$folder/times"
   awk -v rest="${once#* }" 'NR == 2 { gsub(/[ms]/, " "); print 60 * $1 + $2 + 60 * $3 + $4, rest }' "$folder/times")
}
timed() { # PROGRAM STEPS SKIN CORES
  if $cpu; then
    { cpu_of "run_$1" "$2" "$3" "$4"; cpu_of "run_$1" 1 "$3" "$4"; } |
      awk 'NR == 1 { all = $1; $1 = ""; rest = $0 } NR == 2 { print all - $1 rest }'
  else "run_$1" "$2" "$3" "$4"; fi
}
best() { # PROGRAM STEPS CORES SKINS...
  program=$1 run=$2 cores=$3
  shift 3
  for skin in "$@"; do timed "$program" "$run" "$skin" "$cores"; done | sort -g | head -1
}

row() { # NAME SECONDS+ENERGY STEPS
  echo "$2" | awk -v name="$1" -v grains="$count" -v steps="$3" -v own="$own" '
    NF == 0 { printf "  %-22s no result\n", name; next }
    { seconds = $1; $1 = ""
      printf "  %-22s %8.3f s %8.2f million/s   ratio %5.2f  %s\n", name, seconds, grains * steps / seconds / 1e6,
             own == 0 ? 1 : seconds / steps / own, $0 }'
}
peer() { # PROGRAM COMMAND NAME STEPS CORES SKINS...
  command -v "$2" >/dev/null 2>&1 || { echo "  $3 is not installed"; return; }
  program=$1 title=$3 go=$4 on=$5
  shift 5
  row "$title" "$(best "$program" "$go" "$on" "$@")" "$go"
}
compare() { # WORK GRAINS STEPS
  work=$1 grains=$2 steps=$3
  eval "$("$ours" numbers "$work" "$grains")"
  numbers="-var kn $kn -var kt $kt -var gn $gn -var gw $gw -var mu $mu -var dt $dt -var width $width -var speed $speed"
  file=$build/bench/works/$work-$grains.txt
  [ -s "$file" ] || { "$ours" make "$work" "$grains" "$file.new" && mv "$file.new" "$file"; }
  count=$(wc -l <"$file")
  data "$file" "$((dim == 2 ? 2 : 1))" no >"$folder/one.data"
  data "$file" "$((dim == 2 ? 3 : 2))" yes >"$folder/two.data"
  echo "$work, $count grains, $steps steps of $(printf %.3g "$dt") s; ratio: time over ours on as many cores"
  for cores in 1 2; do
    if $cpu && [ $cores -eq 2 ]; then continue; fi
    own=0
    result=$(best cdem "$steps" $cores 0 0 0)
    row "cdem, $cores core(s)" "$result" "$steps"
    own=$(echo "$result $steps" | awk '{ print $1 / $NF }')
    peer lammps lmp "LAMMPS, $cores core(s)" "$steps" $cores 0.02 0.05 0.1 0.2
    [ $cores -eq 1 ] || continue
    peer liggghts liggghts "LIGGGHTS, 1 core" "$steps" 1 0.02 0.05 0.1 0.2
    peer yade yade "YADE, 1 core" "$((steps / 10))" 1 0.02 0.05 0.15
  done
}

echo "machine: $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc --all) cores, load $(cut -d' ' -f1 /proc/loadavg)"
echo "versions: cdem $(git -C "$here" rev-parse --short HEAD 2>/dev/null || echo -)," \
  "$(dpkg-query -W -f '${Package} ${Version}, ' lammps liggghts yade 2>/dev/null | sed 's/, $//')"
! $cpu || echo "times are processor times"
if $quick; then
  compare box 10000 400
  compare plate 20000 400
else
  compare box 10000 2000
  compare box 50000 500
  compare plate 20000 2000
fi
