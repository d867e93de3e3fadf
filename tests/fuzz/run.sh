#!/bin/sh
# Runs each fuzz target for a time, from the kept corpus on; fails on the first crash, leak, input of more than 10 s or
# allocation of more than 2 GB. What it finds is in BUILD/fuzz: new inputs in NAME/, findings as NAME-*.
# usage: run.sh BUILD [SECONDS [NAME...]]     BUILD: a build of the preset fuzz; 600 s each; all targets
set -eu
build=$(cd "$1" && pwd) seconds=${2:-600}
here=$(cd "$(dirname "$0")" && pwd)
[ $# -lt 2 ] && shift 1 || shift 2
[ $# -gt 0 ] || set -- $(sed -n 's/^cdem_fuzz(\([a-z0-9_]*\) .*/\1/p' "$here/CMakeLists.txt")
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 LSAN_OPTIONS="suppressions=$here/../support/lsan.supp"
mkdir -p "$build/fuzz"
for name in "$@"; do
  most=4096
  [ "$name" != restore ] || most=97 # its changes, no more
  mkdir -p "$build/fuzz/$name"
  "$build/tests/fuzz/fuzz_$name" -max_total_time="$seconds" -max_len=$most -timeout=10 -rss_limit_mb=2048 \
    -dict="$build/tests/fuzz/$name.dict" -artifact_prefix="$build/fuzz/$name-" -print_final_stats=1 -verbosity=1 \
    "$build/fuzz/$name" "$here/corpus/$name" >"$build/fuzz/$name.log" 2>&1 || {
    tail -n 40 "$build/fuzz/$name.log"
    echo "error: the target $name failed; its input is in $build/fuzz/$name-*" >&2
    exit 1
  }
  echo "$name: $(grep -o 'cov: [0-9]* ft: [0-9]*' "$build/fuzz/$name.log" | tail -n 1), $(
    sed -n 's/^stat::number_of_executed_units: */executions: /p' "$build/fuzz/$name.log"), inputs: $(ls "$build/fuzz/$name" | wc -l)"
done
