#!/bin/sh
# Uses what was installed as a stranger would: pkg-config, CMake, both examples.
# usage: use.sh EXAMPLES_FOLDER DATA_FOLDER [PREFIX]    without PREFIX: what the system knows
set -eu
examples=$1 data=$2 prefix=${3:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [ -n "$prefix" ]; then
  PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name cdem.pc)")
  LD_LIBRARY_PATH=$(dirname "$PKG_CONFIG_PATH")
  export PKG_CONFIG_PATH LD_LIBRARY_PATH
fi
for example in cube strength; do
  # shellcheck disable=SC2046
  cc -std=c17 -Wall -Wextra -Werror "$examples/$example.c" $(pkg-config --cflags --libs cdem) -o "$work/$example"
done
"$work/cube" >"$work/cube.out"
grep -q '^1-7 body frame:' "$work/cube.out"
grep -c '^.-. edge ' "$work/cube.out" | grep -qx 12

# Strength of the shipped specimen on its plane of tan 4/3: c/(sin cos - friction cos^2) = 3 MPa/(0.48 - 0.36 friction).
"$work/strength" "$data/cases/compression.yaml" 'interfaces[0].friction' "$work/run" 0 0.3 >"$work/strength.out"
cat "$work/strength.out"
awk -F '\t' 'NR > 1 { off = $2 / (3e6 / (0.48 - 0.36 * $1)) - 1; if (off < 0) off = -off; if (off <= 0.02) good++ }
             END { exit !(NR == 3 && good == 2) }' "$work/strength.out"
[ -s "$work/run-2/summary.json" ]
code=0
"$work/strength" "$data/cases/compression.yaml" interfaces.friction "$work/bad" 1 2>"$work/error" || code=$?
[ $code -eq 3 ] && grep -q '^error: interfaces.friction = 1: ' "$work/error" && [ ! -e "$work/bad-1" ] ||
  { echo "a wrong key: exit code $code"; cat "$work/error"; exit 1; }

mkdir "$work/project"
cat >"$work/project/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.22)
project(user C)
find_package(cdem 1.0 REQUIRED)
foreach(example cube strength)
  add_executable(\${example} $examples/\${example}.c)
  target_link_libraries(\${example} PRIVATE cdem::cdem)
endforeach()
END
cmake -S "$work/project" -B "$work/project/build" ${prefix:+-DCMAKE_PREFIX_PATH="$prefix"} >/dev/null
cmake --build "$work/project/build" >/dev/null
"$work/project/build/cube" | cmp - "$work/cube.out"
echo "installed and used"
