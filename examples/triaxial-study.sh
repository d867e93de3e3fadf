#!/bin/sh
# Exact scaling and coarse graining of a triaxial test, section 3 of Wang et al. (2024), with rigid
# spheres: their specimens E1-E4, E2s-E4s, B1-B3, B2s, B3s at full size, figures 5 to 11 and table 5
# beside the printed numbers. docs/theory/triaxial-study.md reads what comes out.
#
#     examples/triaxial-study.sh OUTDIR [NAME ...]
#
# With names, only these runs are made and nothing is drawn: E4, E4s-2 (seed 2), L-E2 (law linear),
# E4s-half (half the rate), ... Without, all that are missing, then figures and tables of all that are
# there. CDEM names the program. A run whose folder has a summary.json is not run again and a broken
# one is continued. Everything takes about an hour of one processor, a quarter of it in E1 and B1.
#
#     h          the law's stiffness as in E1 (B1): "without the rule"; E1 is h = 1
#     s          scaled exactly by `cdem scale --coarse-grain`
#     D-...      grains that deform, meshed as the source's (80 ten-node tetrahedra); D-E1 and D-E2 take
#                hours and are made only when named
#     L-...      law linear in place of penalty, in a rigid smooth cylinder between smooth plates
set -eu
[ $# -ge 1 ] || { echo "usage: $0 OUTDIR [NAME ...]" >&2; exit 2; }
mkdir -p "$1/cases"
out=$(cd "$1" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
base=$here/../data/cases/triaxial.yaml
cdem=${CDEM:-cdem}
command -v "$cdem" >/dev/null || { echo "there is no program '$cdem'; set CDEM to its path" >&2; exit 2; }
shift

inertial=8e-4 # at the start of the shear; the plate keeps its speed, so 9.3e-4 at the end

# ---- one run ----

# What a name means: h of its grains against those of the base case, which are E4s and B3s; count;
# mean diameter in mm.
specimen() {
  case $1 in
    E1) size=0.25 h=1 count=15186 mean=15 ;;
    E2 | E2s) size=0.5 h=2 count=1898 mean=30 ;;
    E3 | E3s) size=0.75 h=3 count=562 mean=45 ;;
    E4 | E4s) size=1 h=4 count=237 mean=60 ;;
    B1) size=0.5 h=1 count=8543 mean=16.667 ;;
    B2 | B2s) size=0.75 h=1.5 count=2532 mean=25 ;;
    B3 | B3s) size=1 h=2 count=1072 mean=33.333 ;;
    *) echo "there is no specimen '$1'" >&2; exit 2 ;;
  esac
}

# Times of eight strains, for the distributions of forces: clock = mean diameter sqrt(density/p).
times_of() { # RATE_FACTOR
  awk -v d="$mean" -v i="$inertial" -v f="$1" 'BEGIN {
    clock = d * 1e-3 * sqrt(2650 / 9e5)
    n = split("0.01 0.02 0.03 0.045 0.06 0.08 0.105 0.14", e, " ")
    for (k = 1; k <= n; k++)
      printf "%s%.6g", (k > 1 ? ", " : ""), 50 * clock + (1 - exp(-e[k])) * clock / (i * f)
  }'
}

make() { # NAME
  name=$1 rate=1 seed=1 law=penalty
  if [ -s "$out/$name/summary.json" ]; then return; fi
  plain=${name#[LD]-}
  case $name in L-*) law=linear ;; D-*) law=deformable ;; esac
  case $plain in
    *-half) rate=0.5 ;;
    *-double) rate=2 ;;
    *-[0-9]*) seed=${plain##*-} ;;
  esac
  specimen "${plain%%-*}"
  case ${plain%%-*} in
    *s | ?1) rule= ;; # E1 and B1 are where the numbers belong: h = 1
    *) rule=--no-rule ;;
  esac
  set -- # changes of the base case
  case $plain in B*)
    set -- "$@" --set grains.packing.sizes=table \
      --set 'grains.packing.classes=[{radius: 15 mm, fraction: 0.5}, {radius: 30 mm, fraction: 0.5}]' \
      --set grains.packing.count=1072 ;;
  esac
  # Numbers of E1 and B1, by the rule those of the base: penalty stiffness over h, stiffness times h.
  case $plain in E*) most=4 ;; *) most=2 ;; esac
  [ -z "$rule" ] || most=1
  if [ $law != linear ]; then
    set -- "$@" --set "contacts[0].penalty_stiffness=$(awk "BEGIN { print 1.8e11 / $most }") N/m3"
  else
    numbers="normal_stiffness: $(awk "BEGIN { print 1.1e6 * $most }") N/m, shear_ratio: 1, damping_ratio: 0.2"
    set -- "$@" --set grains.law=linear --set triaxial.boundary=cylinder --set triaxial.material=smooth \
      --set 'grains.materials={rock: {density: 2650 kg/m3}, smooth: {}}' \
      --set "contacts=[{between: [rock, smooth], friction: 0, $numbers}, {friction: 0.3, $numbers}]"
  fi
  "$cdem" scale -q "$base" --coarse-grain --h $size $rule --set results='{}' "$@" -o "$out/cases/$name.yaml"
  echo "$name"
  times >"$out/cases/$name.before"
  if [ -s "$out/$name/checkpoint.h5" ]; then
    "$cdem" run -q --no-frames --resume "$out/$name"
  else
    if [ $law = deformable ]; then # pushes and pictures are theirs without being asked
      set -- --set safety=0.8 --set 'grains.deformable={shape: icosphere, refinement: 1}' \
        --set 'grains.materials={rock: {density: 2650 kg/m3, young: 40 GPa, poisson: 0.2}}'
    else
      set -- --set safety=0.6 --set 'grains.pictures=[pushes]' \
        --set 'probes={mean_push: {quantity: mean_push}, boundary_push: {quantity: boundary_push}, anisotropy: {quantity: anisotropy}, mechanical: {quantity: mechanical_coordination}}'
    fi
    "$cdem" run -q --no-frames "$out/cases/$name.yaml" -o "$out/$name" \
      --set grains.packing.count=$count --set grains.packing.seed=$seed \
      --set triaxial.inertial_number="$(awk "BEGIN { print $inertial * $rate }")" \
      --set "grains.picture_times=[$(times_of $rate)]" \
      "$@"
  fi || [ $? -eq 1 ]
  times >"$out/cases/$name.after" # children's user time: seconds of one processor
}

if [ $# -gt 0 ]; then
  for wanted; do make "$wanted"; done
  exit
fi

all='E1 E2 E3 E4 E2s E3s E4s B1 B2 B3 B2s B3s'
seeds='E2-2 E2s-2 E3-2 E3s-2 E3-3 E3s-3 E4-2 E4s-2 E4-3 E4s-3 E4-4 E4s-4 E4-5 E4s-5 B3-2 B3s-2 B3-3 B3s-3'
deformable='D-E3 D-E4 D-E3s D-E4s'
linear='L-E1 L-E2 L-E3 L-E4 L-E2s L-E3s L-E4s L-E3-2 L-E3s-2 L-E4-2 L-E4s-2 L-E4-3 L-E4s-3'
for name in $all $seeds $linear $deformable E4s-half E4s-double E2s-half E2s-double; do
  [ -n "${DRAW_ONLY:-}" ] || make $name
done

# ---- numbers of each run ----

# One line: name, solid fraction at the start of the shear, peak of the stress ratio, axial strain
# there, mean ratio of the last tenth of the strain, largest contraction, volumetric strain at the
# end, mean push between grains, on the plates, of both at the peak, N; largest inertial number; time
# of the peak, s; stress ratio at the axial strain 0.01, how stiff it begins.
numbers() { # NAME
  [ -s "$out/$1/summary.json" ] || return 0
  awk -F, -v name="$1" '
    NR == 1 { for (i = 1; i <= NF; i++) { key = $i; sub(/ \[.*/, "", key); at[key] = i }; next }
    $at["axial_strain"] == "" || $at["axial_strain"] == "nan" { next }
    {
      e[n] = $at["axial_strain"]; q[n] = $at["stress_ratio"]; v = $at["volumetric_strain"]
      if (n == 0) solid = $at["solid_fraction"]
      if (v > most) most = v
      if (e[n] <= 0.01) early = q[n]
      if ($at["inertial_number"] > inertial) inertial = $at["inertial_number"]
      if (q[n] > peak) {
        peak = q[n]; place = e[n]; time = $at["time"]
        push = $at["mean_push" in at ? "mean_push" : "probe.mean_push"]
        plates = $at["boundary_push" in at ? "boundary_push" : "probe.boundary_push"]; contacts = $at["contacts"]
        top = $at["wall.top.fz"]; bottom = $at["wall.bottom.fz"]
      }
      n++
    }
    END {
      for (i = 0; i < n; i++) if (e[i] > 0.9 * e[n - 1]) { sum += q[i]; count++ }
      on_plates = ((top < 0 ? -top : top) + (bottom < 0 ? -bottom : bottom)) / plates
      both = (push * (contacts - on_plates) + plates * on_plates) / contacts
      printf "%s %.4f %.3f %.4f %.3f %.4f %.4f %.1f %.1f %.1f %.2e %.6g %.3f\n", name, solid, peak, place,
        sum / count, most, v, push, plates, both, inertial, time, early
    }' "$out/$1/history.csv"
}

{
  echo '# run solid peak strain_at_peak late_ratio contraction volume_at_end push push_on_plates push_of_both inertial time ratio_at_0.01'
  for name in $all $seeds $linear $deformable E4s-half E4s-double E2s-half E2s-double; do numbers $name; done
} >"$out/runs.txt"

# ---- table 5: ratios of the mean push at the peak, means over seeds ----

table() { # PREFIX: "" penalty, L- linear
  awk -v prefix="$1" '
    BEGIN {
      split("E1 E2 E3 E4 E2s E3s E4s B1 B2 B3 B2s B3s", name, " ")
      split("1 4.18 9.64 13.67 3.73 7.39 11.09 1 2.57 4.32 2.15 3.66", printed, " ")
      split("280.30 1172.19 2703.42 3831.52 1046.27 2070.92 3109.17 306.42 788.65 1323.10 658.55 1122.34", newton, " ")
    }
    /^#/ { next }
    {
      run = $1
      if (prefix != "" && sub("^" prefix, "", run) == 0) next
      if (run ~ /^[LD]-/ || run ~ /-(half|double)$/) next
      sub(/-[0-9]+$/, "", run)
      n[run]++; push[run] += $8; square[run] += $8 * $8; both[run] += $10
      peak[run] += $3; peaks[run] += $3 * $3; place[run] += $4; volume[run] += $7; solid[run] += $2; late[run] += $5
      early[run] += $13; most[run] += $6
    }
    function scatter(sum, squares, n, v) { v = n > 1 ? (squares - sum * sum / n) / (n - 1) : 0; return v > 0 ? sqrt(v) : 0 }
    END {
      printf "%-4s %5s %6s %7s %6s %6s %7s %6s %8s %8s %8s %7s %8s %6s %8s %7s %5s\n", "run", "seeds", "solid", "at 0.01", "peak", "+-",
        "strain", "late", "contract", "volume", "push, N", "+-", "printed", "ratio", "printed", "diff, %", "15 %"
      for (k = 1; k <= 12; k++) {
        r = name[k]
        if (!n[r]) continue
        m = push[r] / n[r]
        one = substr(r, 1, 1) "1"
        if (n[one]) ratio = m / (push[one] / n[one]); else ratio = 0
        diff = ratio > 0 ? 100 * (ratio / printed[k] - 1) : 0
        printf "%-4s %5d %6.4f %7.3f %6.3f %6.3f %7.4f %6.3f %8.4f %8.4f %8.1f %7.1f %8.2f %6.2f %8.2f %7.1f %5s\n", r, n[r], solid[r] / n[r],
          early[r] / n[r], peak[r] / n[r], scatter(peak[r], peaks[r], n[r]), place[r] / n[r], late[r] / n[r], most[r] / n[r],
          volume[r] / n[r], m, scatter(push[r], square[r], n[r]), newton[k], ratio, printed[k], diff,
          (n[one] == 0 ? "" : diff < 15 && diff > -15 ? "yes" : "no")
      }
    }' "$out/runs.txt"
}
{
  echo '# law penalty, membrane'
  table ''
  echo '# law linear, rigid smooth cylinder'
  table L-
  echo '# grains that deform, membrane'
  table D-
} >"$out/table5.txt"

# ---- figures ----

column() { # NAME COLUMN: strain and column, to a file
  awk -F, -v y="$2" '
    NR == 1 { for (i = 1; i <= NF; i++) { key = $i; sub(/ \[.*/, "", key); at[key] = i }; next }
    $at["axial_strain"] != "" && $at["axial_strain"] != "nan" { print $at["axial_strain"], $at[y] }
  ' "$out/$1/history.csv" >"$out/$1/$2.dat"
}

style() { # RUN: colour by h, dashes with the rule, thin further seeds
  case ${1#[LD]-} in
    ?1*) colour='#000000' ;;
    E2* | B2*) colour='#1f77b4' ;;
    E3* | B3*) colour='#2ca02c' ;;
    *) colour='#d62728' ;;
  esac
  case ${1#[LD]-} in ??s*) dash=2 ;; *) dash=1 ;; esac
  case $1 in *-[0-9]) echo "lc rgb '$colour' dt $dash lw 0.7 notitle" ;; *) echo "lc rgb '$colour' dt $dash lw 2.2 title '$1'" ;; esac
}

lines() { # FILE COLUMN TITLE YLABEL RUN...
  file=$1 what=$2 title=$3 label=$4 plot=
  shift 4
  for run; do
    [ -s "$out/$run/summary.json" ] || continue
    column "$run" "$what"
    plot="$plot${plot:+, }'$out/$run/$what.dat' with lines $(style "$run")"
  done
  [ -n "$plot" ] || return 0
  gnuplot <<END
set terminal pngcairo size 1000,700 font 'DejaVu Sans,15' background rgb 'white'
set output '$out/$file.png'
set title "$title"
set xlabel 'axial strain'
set ylabel '$label'
set key outside right
set grid lc rgb '#dddddd'
plot $plot
END
}

# The picture of forces nearest to the peak.
forces_at_peak() { # NAME
  peak=$(awk -v r="$1" '$1 == r { print $12 }' "$out/runs.txt")
  for picture in "$out/$1"/figures/pushes-*ms.dat "$out/$1"/figures/pushes-*[0-9]s.dat; do
    [ ! -s "$picture" ] || echo "$picture"
  done | awk -v peak="$peak" '{
    t = $0; sub(/.*pushes-/, "", t); factor = t ~ /ms\.dat$/ ? 1e-3 : 1; sub(/m?s\.dat$/, "", t)
    d = t * factor - peak; d = d < 0 ? -d : d
    if (best == "" || d < least) { best = $0; least = d }
  } END { print best }'
}

forces() { # FILE TITLE RUN...
  file=$1 title=$2 plot=
  shift 2
  for run; do
    [ -s "$out/$run/summary.json" ] || continue
    plot="$plot${plot:+, }'$(forces_at_peak "$run")' with linespoints pt 7 ps 0.5 $(style "$run")"
  done
  [ -n "$plot" ] || return 0
  gnuplot <<END
set terminal pngcairo size 1000,700 font 'DejaVu Sans,15' background rgb 'white'
set output '$out/$file.png'
set title "$title"
set xlabel 'log_{10} of normal force over its mean'
set ylabel 'log_{10} of probability density'
set key outside right
set grid lc rgb '#dddddd'
plot [-2:1] [-4:0.5] $plot
END
}

ratio='stress ratio 3 (σ_l - σ_0)/(σ_l + 2 σ_0)' volume='volumetric strain, contraction positive'
equal='E1 E2 E3 E4 E2s E3s E4s' binary='B1 B2 B3 B2s B3s'
lines fig05 stress_ratio 'Figure 5: equal spheres' "$ratio" $equal
lines fig06 volumetric_strain 'Figure 6: equal spheres' "$volume" $equal
lines fig07 stress_ratio 'Figure 7: two sizes' "$ratio" $binary
lines fig08 volumetric_strain 'Figure 8: two sizes' "$volume" $binary
forces fig09 'Figure 9: equal spheres, at the peak' $equal
forces fig10 'Figure 10: two sizes, at the peak' $binary
lines linear-ratio stress_ratio 'Law linear, rigid smooth cylinder' "$ratio" L-E1 L-E2 L-E3 L-E4 L-E2s L-E3s L-E4s
lines linear-volume volumetric_strain 'Law linear, rigid smooth cylinder' "$volume" L-E1 L-E2 L-E3 L-E4 L-E2s L-E3s L-E4s
lines deformable-ratio stress_ratio 'Grains that deform' "$ratio" D-E1 D-E2 D-E3 D-E4 D-E2s D-E3s D-E4s
lines deformable-volume volumetric_strain 'Grains that deform' "$volume" D-E1 D-E2 D-E3 D-E4 D-E2s D-E3s D-E4s
lines scatter-ratio stress_ratio 'Specimens of 60 mm: seeds' "$ratio" E4 E4-2 E4-3 E4-4 E4-5 E4s E4s-2 E4s-3 E4s-4 E4s-5

# ---- figure 11: time of one processor ----

seconds() { # FILE: user time of the children
  awk 'NR == 2 { split($1, t, /[ms]/); print t[1] * 60 + t[2] }' "$1"
}
for name in $equal $binary; do
  [ -s "$out/$name/summary.json" ] && [ -s "$out/cases/$name.after" ] || continue
  specimen $name
  case $name in E*) kind=0 ;; *) kind=1 ;; esac
  echo "$kind $h $(awk "BEGIN { print $(seconds "$out/cases/$name.after") - $(seconds "$out/cases/$name.before") }") $name"
done >"$out/cost.txt"
gnuplot <<END
set terminal pngcairo size 800,600 font 'DejaVu Sans,15' background rgb 'white'
set output '$out/fig11.png'
set title 'Figure 11: time of one processor'
set xlabel 'h'
set ylabel 'seconds'
set logscale y
set grid lc rgb '#dddddd'
set xrange [0.8:4.2]
plot '$out/cost.txt' using (\$1 == 0 ? \$2 : 1/0):3 with points pt 7 ps 1.6 lc rgb '#1f77b4' title 'equal spheres', \
  '' using (\$1 == 1 ? \$2 : 1/0):3 with points pt 5 ps 1.6 lc rgb '#d62728' title 'two sizes'
END
cat "$out/table5.txt"
