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
# one is continued. Everything takes some three hours of one processor, half of them in E1 and B1.
#
#     h          the law's stiffness as in E1 (B1): "without the rule"; E1 is h = 1
#     s          scaled exactly by `cdem scale --coarse-grain`
#     L-...      law linear in place of penalty, in a rigid cylinder in place of the membrane
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
  plain=${name#L-}
  [ "$plain" = "$name" ] || law=linear
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
  if [ $law = penalty ]; then
    set -- "$@" --set "contacts[0].penalty_stiffness=$(awk "BEGIN { print 1.8e11 / $most }") N/m3"
  else
    set -- "$@" --set grains.law=linear --set triaxial.boundary=cylinder \
      --set "contacts=[{normal_stiffness: $(awk "BEGIN { print 1.1e6 * $most }") N/m, shear_ratio: 1, friction: 0.3, damping_ratio: 0.2}]"
  fi
  "$cdem" scale -q "$base" --coarse-grain --h $size $rule --set results='{}' "$@" -o "$out/cases/$name.yaml"
  echo "$name"
  times >"$out/cases/$name.before"
  if [ -s "$out/$name/checkpoint.h5" ]; then
    "$cdem" run -q --no-frames --resume "$out/$name"
  else
    "$cdem" run -q --no-frames "$out/cases/$name.yaml" -o "$out/$name" --set safety=0.6 \
      --set grains.packing.count=$count --set grains.packing.seed=$seed \
      --set triaxial.inertial_number="$(awk "BEGIN { print $inertial * $rate }")" \
      --set 'grains.pictures=[pushes]' --set "grains.picture_times=[$(times_of $rate)]" \
      --set 'probes={mean_push: {quantity: mean_push}, boundary_push: {quantity: boundary_push}, anisotropy: {quantity: anisotropy}, mechanical: {quantity: mechanical_coordination}}'
  fi || [ $? -eq 1 ]
  times >"$out/cases/$name.after" # children's user time: seconds of one processor
}

if [ $# -gt 0 ]; then
  for wanted; do make "$wanted"; done
  exit
fi
