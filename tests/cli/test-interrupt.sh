#!/bin/sh
# Ctrl-C in the middle of writing: exit code 130, one message, no file, no temporary file; what was there stays.
# usage: test-interrupt.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
cdem=$1/cdem
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cat >box.geo <<'EOF'
Point(1) = {0, 0, 0};
Extrude {1, 0, 0} { Point{1}; Layers{40}; Recombine; }
Extrude {0, 1, 0} { Line{1}; Layers{40}; Recombine; }
Extrude {0, 0, 1} { Surface{5}; Layers{30}; Recombine; }
EOF
for kind in csv h5 vtp; do
  echo old >s.$kind
  "$cdem" springs box.geo -E 1e9 --nu 0.2 -o s.$kind --threads 1 2>err &
  process=$!
  # The temporary file beside the target says that conversion has begun.
  tries=0
  while ! ls -A | grep -q part; do
    kill -0 $process 2>/dev/null || { echo "$kind: ended before it could be interrupted"; cat err; exit 1; }
    tries=$((tries + 1))
    [ $tries -lt 3000 ] || { echo "$kind: no temporary file appeared"; exit 1; }
    sleep 0.01
  done
  kill -INT $process
  code=0
  wait $process || code=$?
  [ $code -eq 130 ] || { echo "$kind: exit code $code"; cat err; exit 1; }
  grep -q '^error: interrupted while converting' err || { echo "$kind:"; cat err; exit 1; }
  [ "$(cat s.$kind)" = old ] || { echo "$kind: the old file is gone"; exit 1; }
  ! ls -A | grep part || { echo "$kind: a temporary file stayed"; exit 1; }
done
echo "interrupted cleanly"
