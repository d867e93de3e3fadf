#!/bin/sh
# Installs into a fresh folder, moves it, and uses what was installed: program, library, man pages, examples.
# usage: install.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/first" >/dev/null
mv "$work/first" "$work/moved"
root=$work/moved
"$root/bin/cdem" --version | grep -q '^cdem [0-9]'
for file in "$root/bin/cdem" "$(find "$root" -name 'libcdem.so.*.*')"; do
  ! readelf -d "$file" | grep -E 'R(UN)?PATH' || { echo "$file has a path of this machine in it"; exit 1; }
done
# One header, and no library that the program would need of its own.
[ "$(find "$root/include" -name '*.h')" = "$root/include/libcdem.h" ]
! readelf -d "$root/bin/cdem" | grep libcdem || { echo "cdem needs libcdem.so"; exit 1; }
"$root/bin/cdem" springs "$root/share/cdem/meshes/block-with-hole.geo" --material "$root/share/cdem/materials/granite.yaml" -q >/dev/null
if [ -d "$build/man" ]; then # help2man was there
  commands=$("$root/bin/cdem" --help | sed -n 's/^  \([a-z]*\)  .*/\1/p')
  [ -n "$commands" ]
  for name in cdem $(echo "$commands" | sed 's/^/cdem-/'); do
    page=$root/share/man/man1/$name.1
    gunzip "$page.gz"
    grep -q '^\.SH SYNOPSIS' "$page" && grep -q '^\.SH DESCRIPTION' "$page" || { echo "$page says too little"; exit 1; }
    awk '/^\.SH/ { on = /EXAMPLES/; next } on && !/^(\.|cdem |    )/ { print FILENAME ": an example is broken: " $0; bad = 1 } END { exit bad }' "$page"
    ! command -v mandoc >/dev/null || mandoc -T lint -W warning "$page"
  done
fi
sh "$source/tests/house/use.sh" "$root/share/doc/cdem/examples" "$root/share/cdem" "$root"
