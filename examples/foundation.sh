#!/bin/sh
# Section 3 of Li & Wan (2010): a foundation of grains inside a Cosserat continuum, all its figures
# and its table 2 by one command. docs/tutorials/foundation.md walks through what comes out.
#
#     examples/foundation.sh OUTDIR
#
# CDEM names the program (cdem in the PATH). A run whose folder has a summary.json is not run again
# and a broken one is continued, so the command may be stopped and given again; figures are drawn
# anew each time. It takes about four minutes, most of them in the five runs with grains everywhere;
# on a machine that has other things to do, OMP_NUM_THREADS=1 is faster.
#
#     OUTDIR/a b c              coupled, the three assemblies
#     OUTDIR/a-grains           grains everywhere (the source's "DEM")
#     OUTDIR/a-frozen           the null test: the same grains inside frozen ones, no continuum
#     OUTDIR/a-continuum        the Cosserat continuum everywhere
#     OUTDIR/a-CM, -grains, -frozen   mass damping of 100, 300, 700 and 900 1/s in place of 500
#     OUTDIR/fig03.png ... fig12.png, damping.png, table2.txt, bands.txt, damping.txt
set -eu
[ $# -eq 1 ] || { echo "usage: $0 OUTDIR" >&2; exit 2; }
mkdir -p "$1"
out=$(cd "$1" && pwd)
cases=$(cd "$(dirname "$0")/../data/cases" && pwd)
cdem=${CDEM:-cdem}
command -v "$cdem" >/dev/null || { echo "there is no program '$cdem'; set CDEM to its path" >&2; exit 2; }

run() { # NAME CASE [--set KEY=VALUE ...]
  name=$1 case=$2
  shift 2
  if [ -s "$out/$name/summary.json" ]; then return; fi
  echo "$name"
  if [ -s "$out/$name/checkpoint.h5" ]; then
    "$cdem" run -q --no-frames --resume "$out/$name"
  else
    "$cdem" run -q --no-frames "$cases/$case.yaml" -o "$out/$name" "$@"
  fi || [ $? -eq 1 ] # 1: a key result is off its reference, which is for the reader to see
}

states='grains.picture_times=[15 ms, 33 ms, 60 ms]' # hardening, peak, softening
run a foundation-a --set "$states"
run b foundation-b
run c foundation-c
run a-frozen foundation-a --set coupling.version=frozen
run a-continuum foundation-a --set coupling.version=continuum --set 'mesh.count=[84, 42]' \
  --set plates.plate.stiffness_factor=20 \
  --set 'grains.picture_ranges.pressure=[0, 10 MPa]' --set 'grains.picture_ranges.effective_stress=[0, 10 MPa]'
run a-grains foundation-a --set coupling.version=grains
for cm in 100 300 700 900; do
  for version in coupled frozen grains; do
    suffix=-$version
    [ $version != coupled ] || suffix=
    run "a-$cm$suffix" foundation-a --set "mass_damping=$cm 1/s" --set coupling.version=$version
  done
done

# ---- figures ----

curves() { # FILE RUN LABEL [RUN LABEL ...]: load against displacement
  file=$1
  shift
  count=$(($# / 2)) i=0
  while [ $i -lt $count ]; do # turns RUN LABEL into RUN --label LABEL, once around
    run=$1 label=$2
    shift 2
    set -- "$@" "$out/$run" --label "$label"
    i=$((i + 1))
  done
  "$cdem" compare -q "$@" --columns load.plate.fy --x load.plate.moved_y --x-scale -1000 \
    --y-scale 1e-6 --x-label 'displacement of the plate, mm' --y-label 'load, MN' \
    --figure "$out/$file.png" >/dev/null
}

size_of() { # PNG: its width and height, of its header
  od -An -tu1 -j16 -N8 "$1" | awk '{ print (($1 * 256 + $2) * 256 + $3) * 256 + $4, (($5 * 256 + $6) * 256 + $7) * 256 + $8 }'
}

# Pictures of runs as panels of one figure, row by row, as wide as the widest, a line above each.
panels() { # FILE COLUMNS PICTURE LABEL [PICTURE LABEL ...]
  file=$1 columns=$2 wide=0 high=0 head=44 i=0 labels= plot=
  shift 2
  count=$(($# / 2)) rows=$(($# / 2 / columns))
  for picture; do
    case $picture in
      *.png) set -- "$@" "$picture" "$(size_of "$out/$picture")" ;; # the list grows behind its end
      *) set -- "$@" "$picture" '' ;;
    esac
  done
  shift $((2 * count))
  for value; do # sizes: the widest, then the highest of all made as wide
    case $value in [0-9]*' '[0-9]*) [ "${value% *}" -le $wide ] || wide=${value% *} ;; esac
  done
  for value; do
    case $value in [0-9]*' '[0-9]*)
      scaled=$((${value#* } * wide / ${value% *}))
      [ $scaled -le $high ] || high=$scaled ;;
    esac
  done
  cell=$((high + head))
  while [ $i -lt $count ]; do # PICTURE SIZE LABEL ''
    across=${2% *} up=${2#* }
    scaled=$((up * wide / across))
    x=$((i % columns * wide)) y=$(((rows - 1 - i / columns) * cell + high - scaled))
    labels="$labels
set label $((i + 1)) '$3' at $((x + 16)),$((y + scaled + head / 2)) left front"
    plot="$plot${plot:+, }'$out/$1' binary filetype=png origin=($x,$y) dx=$wide./$across dy=$wide./$across with rgbimage notitle"
    shift 4
    i=$((i + 1))
  done
  gnuplot <<END
set terminal pngcairo size $((columns * wide)),$((rows * cell)) font 'DejaVu Sans,19' background rgb 'white'
set output '$out/$file.png'
set encoding utf8
set margins 0, 0, 0, 0
unset border
unset tics
unset key
set xrange [0:$((columns * wide))]
set yrange [0:$((rows * cell))]
$labels
plot $plot
END
}

curves fig03 a 'assembly A' b 'assembly B' c 'assembly C'
n=4
for field in pressure effective_stress volumetric_strain effective_strain; do
  panels fig0$n 1 a/figures/$field.png '(a) assembly A' b/figures/$field.png '(b) assembly B' \
    c/figures/$field.png '(c) assembly C'
  n=$((n + 1))
done
n=8
for field in chains velocities; do
  panels fig0$n 1 a/figures/$field-15ms.png '(a) hardening, 15 mm' \
    a/figures/$field-33ms.png '(b) peak, 33 mm' a/figures/$field-60ms.png '(c) softening, 60 mm'
  n=$((n + 1))
done
panels fig10 1 a-continuum/figures/pressure.png '(a) pressure' \
  a-continuum/figures/effective_stress.png '(b) effective stress'
curves fig11 a-grains 'all grains' a 'coupled' a-frozen 'null test'
panels fig12 2 a/figures/volumetric_strain.png '(a) coupled' \
  a-grains/figures/volumetric_strain.png '(b) grains everywhere' \
  a/figures/effective_strain.png '(c) coupled' a-grains/figures/effective_strain.png '(d) grains everywhere'
curves damping a-100-grains 'all, 100 1/s' a-100 'coupled' a-900-grains 'all, 900 1/s' a-900 'coupled'

# ---- tables ----

"$cdem" compare -q "$out/a-grains" "$out/a" "$out/a-frozen" >"$out/table2.txt"
"$cdem" compare -q "$out/a" "$out/b" "$out/c" --from '58 ms' \
  --columns left_angle,left_slenderness,right_angle,right_slenderness >"$out/bands.txt"
for cm in 100 300 500 700 900; do
  name=a-$cm
  [ $cm -ne 500 ] || name=a
  echo "mass damping $cm 1/s"
  "$cdem" compare -q "$out/$name-grains" "$out/$name" "$out/$name-frozen"
done >"$out/damping.txt"
cat "$out/table2.txt"
