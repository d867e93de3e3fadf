#!/bin/sh
# Memory under valgrind: the small cases of every engine (tests/small), springs in every format, and what else the program does.
# An error of memory or a block that is lost fails; what other libraries do so is in valgrind.supp, with reasons.
# usage: valgrind.sh BUILD_FOLDER SOURCE_FOLDER [NAME...]     names of small cases, or of the commands below; default: all
set -u
cdem=$(cd "$1" && pwd)/cdem source=$(cd "$2" && pwd)
shift 2
command -v valgrind >/dev/null || { echo "valgrind is not installed"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
failed=0 watched=0

# under_valgrind COMMAND...: its exit code, or 99 after an error; the errors are in $work/log
under_valgrind() {
  rm -f "$work/log"
  valgrind --quiet --leak-check=full --show-leak-kinds=definite,indirect --errors-for-leak-kinds=definite,indirect \
    --num-callers=25 --suppressions="$source/tests/valgrind.supp" --error-exitcode=99 --log-file="$work/log" "$@"
}

# watch NAME COMMAND...: one line, and the errors if there are any
watch() {
  name=$1
  shift
  [ -z "$wanted" ] || case " $wanted " in *" $name "*) ;; *) return ;; esac
  watched=$((watched + 1))
  (cd "$work" && under_valgrind "$@" >"$work/out" 2>&1)
  code=$?
  if [ "$code" -eq 0 ] && [ ! -s "$work/log" ]; then
    echo "$name: clean"
    return
  fi
  failed=1
  echo "$name: exit code $code"
  tail -5 "$work/out"
  sed 's/^/  /' "$work/log" | head -60
}

# Silence means something only if an error is reported: a choice by a number that was never set, a block that is lost.
cat >"$work/bad.c" <<'C'
#include <stdlib.h>
int main(int argc, char **argv) {
  double *number = malloc(8 * sizeof *number);
  (void)argv;
  return argc > 1 ? (number = NULL) != NULL : number[3] > 1.0 ? 1 : 0;
}
C
cc -g -O0 "$work/bad.c" -o "$work/bad" || exit 1
for bad in "$work/bad" "$work/bad lose"; do
  # shellcheck disable=SC2086
  under_valgrind $bad
  [ $? -eq 99 ] && [ -s "$work/log" ] || { echo "an error planted in '$bad' is not reported"; exit 1; }
done

wanted=$*
for file in "$source"/tests/small/*.yaml; do
  name=$(basename "$file" .yaml)
  watch "$name" "$cdem" run -q --no-figures "$file" -o "$name-run"
done
meshes=$source/data/meshes
for format in csv h5 vtp vtu mtx inp data py; do
  watch "springs-$format" "$cdem" springs "$meshes/mixed.msh" -E 1 --nu 0.2 -o "springs.$format"
done
watch springs-inp-mesh "$cdem" springs "$meshes/cantilever.inp" --material "$source/data/materials/granite.yaml" -o deck.csv
watch springs-geo "$cdem" springs "$meshes/plate.geo" -E 1 --nu 0.2 -o plate.csv
watch poisson "$cdem" poisson --element quad4 --from 0 --to 0.4 --step 0.1 -o poisson.csv
watch poisson-roots "$cdem" poisson --element tet4 --from -0.9 --to 0.4 --step 0.1 --roots -o roots.csv
watch pack-square "$cdem" pack square --size 0.1,0.1 --radius 0.005 -o square.csv
watch pack-inward "$cdem" pack inward --size 0.1,0.1 --sizes uniform --least 0.002 --most 0.005 -o inward.csv
watch pack-loose "$cdem" pack loose --size 0.1,0.1,0.1 --radius 0.01 --count 60 --compact --fraction 0.4 -o loose.vtp
watch report "$cdem" report discs-run
watch export "$cdem" export discs-run -o discs.data -o discs.py -o discs.csv
watch scale "$cdem" scale "$source/tests/small/discs.yaml" --h 2 -o scaled.yaml
rm -f "$work/discs-run/summary.json" # as if it had been killed at its end
watch resume "$cdem" run -q --no-figures --resume discs-run
watch compare "$cdem" compare discs-run discs-run
watch list "$cdem" list
[ "$watched" -gt 0 ] || { echo "nothing has a name among: $wanted"; exit 1; }
echo "$watched watched"
exit $failed
