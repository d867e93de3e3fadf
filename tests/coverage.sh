#!/bin/sh
# Lines of the library that the tests run, by room. Fails below 90 % of src/, or below 85 % of any room.
# The tests are those that take seconds and, of the slow ones, those whose lines no other test reaches.
# usage: coverage.sh SOURCE_FOLDER [--report]     --report: of the counts that are there, without running anything
set -u
cd "$1" || exit 2
command -v gcovr >/dev/null || { echo "gcovr is not installed"; exit 77; }
build=build/coverage
report=$build/coverage.csv
slow='^(verify.verify|fdem.specimen_slow|run.coupled_slow)$'
# What gcov says belongs to no test's stderr. Tests whose program meets a full disk are left out: its counts would be cut off, too;
# and that of the documentation's commands, whose runs are others' and take a quarter of an hour without optimisation.
export GCOV_ERROR_FILE="$PWD/$build/gcov.log"
export OMP_NUM_THREADS=2 OMP_WAIT_POLICY=passive OPENBLAS_NUM_THREADS=1
if [ "${2:-}" != --report ]; then
  cmake --preset coverage -G Ninja >/dev/null || exit 1
  cmake --build --preset coverage >"$build/build.log" || { tail -20 "$build/build.log"; exit 1; }
  find $build -name '*.gcda' -delete
  ctest --test-dir $build -j "$(nproc)" -LE 'slow|long' -E '^house|disk|bad-output|^cli.docs' --output-on-failure >"$build/tests.log" 2>&1 || { tail -60 "$build/tests.log"; exit 1; }
  ctest --test-dir $build -j "$(nproc)" -R "$slow" --output-on-failure >"$build/tests.log" 2>&1 || { tail -60 "$build/tests.log"; exit 1; }
fi
# Counts of branches, which nobody reads here, can be negative where a run was killed; gcovr would stop at them.
gcovr --gcov-ignore-parse-errors --root . --filter 'src/' --object-directory $build --csv "$report" $build/src || exit 1
awk -F, '
  NR == 1 { for (i = 1; i <= NF; i++) column[$i] = i; next }
  { split($1, part, "/"); room = part[2]
    lines[room] += $column["line_total"]; run[room] += $column["line_covered"] }
  END {
    for (room in lines) {
      percent = 100 * run[room] / lines[room]
      printf "%-10s %6d lines  %5.1f %%\n", room, lines[room], percent | "sort"
      if (percent < 85) { low = low " " room }
      all += lines[room]; covered += run[room]
    }
    close("sort")
    if (all == 0) { print "no lines were counted"; exit 1 }
    printf "%-10s %6d lines  %5.1f %%\n", "src", all, 100 * covered / all
    if (low != "") print "below 85 %:" low
    exit low != "" || covered < 0.9 * all
  }' "$report"
