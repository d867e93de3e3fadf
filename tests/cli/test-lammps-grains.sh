#!/bin/sh
# Grains of cases in LAMMPS, by the files and the input that `cdem export` writes: places and masses to the last digit,
# forces at the start by the law of contact in awk, and the same motion as that of `cdem run`.
# usage: test-lammps-grains.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
cdem=$1/cdem here=$2/tests/cli
command -v lmp >/dev/null || { echo "lmp is not installed (Debian package lammps); skipped" >&2; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export OMP_NUM_THREADS=1

# The input of the file's own comments for `steps` steps; what came out as rows of dump columns.
lammps() { # DATA STEPS COLUMNS -> theirs
  { sed -n 's/^#> //p' "$1"
    echo "dump f all custom 1000000 lammps.state id $3"
    echo 'dump_modify f sort id format float %.17g first yes'
    echo "run $2"
    echo "write_dump all custom last.state id $3 modify sort id format float %.17g"
  } >grains.in
  lmp -in grains.in -log none -var data "$1" >log 2>&1 || { tail -5 log; exit 1; }
  sed -n '/^ITEM: ATOMS/,$p' last.state | sed 1d >theirs
}
case_of() { # TABLE DIMENSION LAW CONTACTS END THICKNESS
  cat <<END
end: $5
step: 1e-6 s
gravity: [0.3, -9.81, 0]
$6
grains: {dimension: $2, law: $3, file: $1, materials: {sand: {density: 2600, young: 50 MPa, poisson: 0.2}, clay: {density: 1700, young: 20 MPa, poisson: 0.3}}}
contacts: [$4]
END
}
pack() { # DIMENSION -> table.csv, pressed together
  if [ "$1" = 2 ]; then
    "$cdem" pack loose -q --size 0.3,0.3 --count 150 --sizes uniform --least 8e-3 --most 12e-3 --compact --pressure '10 kPa' -o packed.csv
  else
    "$cdem" pack loose -q --size 0.14,0.14,0.14 --count 200 --sizes uniform --least 8e-3 --most 12e-3 --compact --pressure '10 kPa' -o packed.csv
  fi
  awk -v speed="$2" -v spin="$3" -f "$here/grains.awk" packed.csv >table.csv
}

# Places, radii and masses to the last digit; forces at the start. Shear springs are not stretched yet.
for dim in 2 3; do
  pack $dim 0.02 5
  thick= masses=1
  [ $dim = 3 ] || { thick="thickness: 0.05"; masses=0.05; }
  # A dashpot of zeta = 0.1, z = 0.2, and none across.
  case_of table.csv $dim linear "{between: [sand, sand], normal_stiffness: 2e5, damping_ratio: 0.1, shear_damping_ratio: 0, friction: 0.5}, {between: [sand, clay], normal_stiffness: 1e5, damping_ratio: 0.1, shear_damping_ratio: 0, friction: 0.3}, {between: [clay, clay], normal_stiffness: 5e4, damping_ratio: 0.1, shear_damping_ratio: 0, friction: 0.2}" '1 ms' "$thick" >case.yaml
  "$cdem" export -q case.yaml -o case.data -o read.csv
  awk -v k=2e5,1e5,5e4 -v z=0.2 -v rho=2600,1700 -v thickness=$masses -v g=0.3,-9.81,0 -f "$here/pushes.awk" table.csv >law
  lammps case.data 0 'x y z diameter mass fx fy fz'
  awk -v dim=$dim 'FNR == NR {if (FNR > 1) {n++; split($0, w, ","); for (c = 1; c <= dim + 1; c++) row[n, c] = w[c] + 0} next}
       {for (c = 1; c <= dim; c++) if ($(c + 1) != row[FNR, c]) bad++
        if ($5 != 2 * row[FNR, dim + 1]) bad++; seen++}
       END {printf "%d-D: %d grains, %d numbers differ\n", dim, seen, bad; exit !(seen == n && n > 100 && bad == 0)}' table.csv theirs
  awk 'FNR == NR {m[$1] = $5; next} {d = $6 / m[$1] - 1; d = d < 0 ? -d : d; if (d > worst) worst = d; seen++}
       END {printf "masses differ by %.1e\n", worst; exit !(seen > 100 && worst < 1e-15)}' law theirs
  awk '{print $1, $2, $3, $4}' law >ours
  awk '{print $1, $7, $8, $9}' theirs >forces
  awk -v name="$dim-D, forces at the start" -v bound=1e-10 -f "$here/differ.awk" ours forces
done

# The same way: differences of places by the largest way. LAMMPS' arms are the radii, ours reach to the contact point:
# they differ by half the overlap over the radius, up to 3e-5 here, and so may the ways. Where a contact with a shear
# dashpot slides, LAMMPS takes the dashpot out of the spring and we do not: contacts with one are slow enough to stick.
touching() { # DIMENSION OVERLAP SPEED -> table.csv
  if [ "$1" = 2 ]; then
    "$cdem" pack inward -q --size 0.3,0.3 --sizes uniform --least 8e-3 --most 12e-3 -o packed.csv
  else
    "$cdem" pack hexagonal -q --size 0.12,0.12,0.12 --radius 0.01 -o packed.csv
  fi
  awk -v dim="$1" -v deep="$2" 'BEGIN {FS = OFS = ","} NR > 1 {for (c = 1; c <= dim; c++) $c = sprintf("%.17g", $c * (1 - deep))} 1' packed.csv >pressed.csv
  awk -v speed="$3" -v spin="$(awk -v v="$3" 'BEGIN {print 100 * v}')" -f "$here/grains.awk" pressed.csv >table.csv
}
same_way() { # DIMENSION LAW OVERLAP SPEED CONTACTS
  touching "$1" "$3" "$4"
  case_of table.csv "$1" "$2" "$5" '0.3 ms' "" >case.yaml
  "$cdem" export -q case.yaml -o case.data
  "$cdem" run -q --no-figures --no-frames case.yaml -o out
  "$cdem" export -q out -o last.csv
  lammps case.data 300 'x y z'
  awk -F, -v dim="$1" 'NR > 1 {print NR - 1, $1, $2, dim == 3 ? $3 : 0}' table.csv >start
  awk -F, -v dim="$1" 'NR > 1 {print NR - 1, $1, $2, dim == 3 ? $3 : 0}' last.csv >end
  for side in end theirs; do
    awk 'FNR == NR {for (c = 2; c <= 4; c++) x[$1, c] = $c; next}
         {printf "%d %.17g %.17g %.17g\n", $1, $2 - x[$1, 2], $3 - x[$1, 3], $4 - x[$1, 4]}' start $side >$side.way
  done
  awk -v name="$1-D, $2, ways of 300 steps" -v bound=3e-5 -f "$here/differ.awk" end.way theirs.way
  rm -r out
}
same_way 2 linear 1e-6 0.001 '{normal_stiffness: 1e6, damping_ratio: 0.2, shear_damping_ratio: 0, friction: 0.5}'
same_way 2 linear 1e-5 0.00001 '{normal_stiffness: 1e6, damping_ratio: 0.2, friction: 1e9}'
same_way 3 linear 1e-5 0.00001 '{normal_stiffness: 1e5, normal_dashpot: 3, shear_dashpot: 1, friction: 1e9}'
same_way 3 hertz 1e-6 0.001 '{restitution: 0.6, shear_damping_ratio: 0, friction: 0.4}'
same_way 3 hertz 1e-5 0.00001 '{restitution: 0.6, friction: 1e9}'
