#!/bin/sh
# How much faster grains inside a continuum are than grains everywhere: the foundation of assembly A
# with the same fine region in domains of growing size, coupled and full, one after the other, the
# same step, the same rows, one thread, no pictures.
#
#     bench/bsm-speed.sh [--quick] [BUILD_FOLDER, build/release] [FIGURE, docs/figures/bsm/speed-up]
#
# Time of a run is that of the whole command: packing, set-up, steps, rows, files. "wall" is by the
# clock and worth what the machine was idle; "cpu" is the processor's. Of the two coupled runs the
# faster one counts, as it is over in seconds. --quick: to 6 ms, the two smaller domains.
# Nothing is asserted: docs/performance.md says what was found, and on which machine.
set -eu
end='60 ms' sizes='6 9 15'
if [ "${1:-}" = --quick ]; then
  end='6 ms' sizes='6 9'
  shift
fi
here=$(cd "$(dirname "$0")/.." && pwd)
cdem=${1:-$here/build/release}/cdem
figure=${2:-$here/docs/figures/bsm/speed-up}
[ -x "$cdem" ] || { echo "there is no '$cdem'; build it first" >&2; exit 2; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# Wall and processor seconds of a run. ROWS elements of 7/6 m deep, twice as many across.
timed() { # VERSION ROWS NAME
  half=$(awk -v n="$2" 'BEGIN { printf "%.17g", n * 7 / 6 }')
  begun=$(date +%s.%N)
  (
    "$cdem" run -q --threads 1 --no-figures --no-frames "$here/data/cases/foundation-a.yaml" -o "$folder/$3" \
      --set "coupling.version=$1" --set "end=$end" --set 'history_every=2 ms' --set 'results={}' \
      --set "mesh.count=[$((2 * $2)), $2]" --set "mesh.size=[$(awk -v h="$half" 'BEGIN { printf "%.17g", 2 * h }'), $half]" \
      --set "mesh.origin=[-$half, -$half]" --set "grains.packing.low=[-$half, -$half]" \
      --set "grains.packing.high=[$half, 0]" >"$folder/log" 2>&1 || { cat "$folder/log" >&2; exit 1; }
    times >"$folder/times"
  )
  ended=$(date +%s.%N)
  awk -v wall="$begun $ended" 'NR == 2 {
    split(wall, w, " ")
    gsub(/[ms]/, " ")
    printf "%.3f %.3f\n", w[2] - w[1], 60 * $1 + $2 + 60 * $3 + $4 }' "$folder/times"
}
number() { sed -n "s/^  \"$2\": \([^,]*\),*/\1/p" "$folder/$1/summary.json"; }

echo "machine: $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores, load $(cut -d' ' -f1-3 /proc/loadavg)"
echo "cdem $(git -C "$here" rev-parse --short HEAD 2>/dev/null || echo -), to $end, one thread"
echo "   areas    grains      wall, s    cpu, s   |  fine + interface   wall, s    cpu, s   |  speed-up: wall   cpu"
: >"$folder/table"
for rows in $sizes; do
  one=$(timed coupled "$rows" bsm)
  two=$(timed coupled "$rows" bsm)
  bsm=$(printf '%s\n%s\n' "$one" "$two" | sort -g -k2 | head -1)
  split="$(number bsm wall_fine) $(number bsm wall_coarse) $(number bsm wall_transfer) $(number bsm wall_time)"
  fine="$(number bsm fine_grains) $(number bsm interface_grains)"
  full=$(timed grains "$rows" dem)
  echo "$rows $full $bsm $(number dem grains) $fine $split" | awk '{
    printf "%8.1f %9d %12.1f %9.1f   | %9d + %-6d %9.2f %9.2f   | %12.1f %9.1f\n",
      2 * $1 * $1 / 18, $6, $2, $3, $7, $8, $4, $5, $2 / $4, $3 / $5
    printf "         of the coupled run: grains %.2f s, medium %.3f s, transfer %.3f s, rows and files %.2f s\n",
      $9, $10, $11, $12 - $9 - $10 - $11
    print 2 * $1 * $1 / 18, $2 / $4, $3 / $5 >>"'"$folder"'/table" }'
done

mkdir -p "$(dirname "$figure")"
for kind in png svg; do
  size=420,300 font=10
  [ $kind = svg ] || size=840,600 font=18
  gnuplot <<END
set terminal $([ $kind = svg ] && echo svg || echo pngcairo) enhanced size $size font 'DejaVu Sans,$font' background rgb 'white'
set output '$figure.$kind'
set encoding utf8
set border 3 lw 1
set tics nomirror out scale 0.5
set xlabel 'area of the domain over that of the fine region'
set ylabel 'time of grains everywhere over coupled'
set key left top reverse Left
set xrange [0:*]
set yrange [0:*]
plot x lc rgb '#999999' dt 2 title 'ratio of the areas', \
  '$folder/table' using 1:2 with linespoints lw 2 pt 7 lc rgb '#1b6c90' title 'by the clock', \
  '' using 1:3 with linespoints lw 2 pt 4 lc rgb '#d95f02' title 'of the processor'
END
done
echo "drawn: $figure.png and .svg"
