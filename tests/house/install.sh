#!/bin/sh
# Installs into a fresh folder and uses what was installed: the program, pkg-config, the CMake package.
# usage: install.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
build=$1 source=$2
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
cmake --install "$build" --prefix "$root" >/dev/null
"$root/bin/cdem" --version | grep -q '^cdem [0-9]'
PKG_CONFIG_PATH=$(dirname "$(find "$root" -name cdem.pc)")
export PKG_CONFIG_PATH
# shellcheck disable=SC2046
cc -std=c17 "$source/examples/cube.c" $(pkg-config --define-variable=prefix="$root" --cflags --libs cdem) \
  -Wl,-rpath,"$(dirname "$PKG_CONFIG_PATH")" -o "$root/cube"
"$root/cube" | grep -q '^1-7 body frame:'
mkdir "$root/project"
cat >"$root/project/CMakeLists.txt" <<EOF
cmake_minimum_required(VERSION 3.22)
project(user C)
find_package(cdem REQUIRED)
add_executable(cube $source/examples/cube.c)
target_link_libraries(cube PRIVATE cdem::cdem)
EOF
cmake -S "$root/project" -B "$root/project/build" -DCMAKE_PREFIX_PATH="$root" >/dev/null
cmake --build "$root/project/build" >/dev/null
"$root/project/build/cube" | grep -c 'edge' | grep -qx 12
echo "installed and used"
