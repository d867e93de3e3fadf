#!/bin/sh
# The thread sanitizer, three threads: the small cases of every engine (tests/small), springs, packings, and the tests of the rooms.
# clang and its OpenMP, whose tool libarcher tells the sanitizer what waits for what; under gcc's every barrier would be a false report.
# usage: threads.sh SOURCE_FOLDER [--cases]     --cases: without the tests of the rooms
set -u
cd "$1" || exit 2
archer=$(find /usr/lib/llvm-*/lib -name libarcher.so 2>/dev/null | sort | tail -1)
command -v clang >/dev/null && [ -n "$archer" ] || { echo "clang or its OpenMP's libarcher.so is not installed"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export OMP_TOOL_LIBRARIES="$archer" OMP_NUM_THREADS=3 OMP_WAIT_POLICY=passive OPENBLAS_NUM_THREADS=1
# Other libraries are not built for the sanitizer: what happens inside them alone is not looked at.
export TSAN_OPTIONS="ignore_noninstrumented_modules=1 exitcode=66 history_size=4"

# Silence means something only if a race is reported, and a report only if a loop without one is not.
for kind in RACE NO_RACE; do
  clang -g -O1 -fopenmp -fsanitize=thread -D$kind tests/threads.c -o "$work/$kind" || exit 1
  "$work/$kind" >/dev/null 2>"$work/$kind.log"
  code=$?
  case $kind-$code in
    RACE-66 | NO_RACE-0) ;;
    *) echo "threads.c with $kind ends with exit code $code:"; cat "$work/$kind.log"; exit 1 ;;
  esac
done

cmake --preset tsan -G Ninja >/dev/null || exit 1
if [ "${2:-}" = --cases ]; then target=cdem_program; else target=all; fi
cmake --build --preset tsan --target $target >"$work/build.log" || { tail -20 "$work/build.log"; exit 1; }
cdem=$PWD/build/tsan/cdem
failed=0

# watch NAME COMMAND...: one line, and the report if there is one
watch() {
  name=$1
  shift
  if "$@" >"$work/out" 2>&1; then
    echo "$name: clean"
  else
    echo "$name: exit code $?"
    head -80 "$work/out"
    failed=1
  fi
}

for file in tests/small/*.yaml; do
  name=$(basename "$file" .yaml)
  watch "$name" "$cdem" run -q --threads 3 --no-figures "$file" -o "$work/$name"
done
# Bodies are cut into tiles of 512 cells, one a thread: a few steps of some that have several.
for larger in "blocks mesh.count=[50,24]" "plate mesh.count=[40,16]" "solid mesh.count=[6,6,8]"; do
  name=${larger%% *}
  watch "$name, larger" "$cdem" run -q --threads 3 --no-figures --set "${larger#* }" --set end=20us "tests/small/$name.yaml" -o "$work/$name-larger"
done
watch springs "$cdem" springs data/meshes/mixed.msh -E 1 --nu 0.2 --certify -o "$work/springs.csv"
watch pack "$cdem" pack loose --size 0.2,0.2,0.2 --radius 0.01 --count 300 --compact --fraction 0.5 --threads 3 -o "$work/loose.csv"
if [ $target = all ]; then
  ctest --test-dir build/tsan -LE 'slow|long' -E '^house|^cli' --output-on-failure || failed=1
fi
exit $failed
