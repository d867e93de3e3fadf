#!/bin/sh
# cdem --version, and how the commit gets into it: a new commit, changed files, an archive without git, neither.
# usage: version.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$build/cdem" --version >"$work/version"
sed -n 1p "$work/version" | grep -qE '^cdem [0-9]+\.[0-9]+\.[0-9]+ \(([^ ]*[0-9a-f]{7,}(-dirty)?|unknown)\)$'
sed -n 2p "$work/version" | grep -qE '^built by .+, (Release|Debug|RelWithDebInfo|MinSizeRel).*, OpenMP'
for library in OpenBLAS GSL gmsh CHOLMOD HDF5 libyaml zlib; do
  grep -qE "$library [0-9]+\.[0-9]" "$work/version" || { echo "--version does not say which $library"; exit 1; }
done
grep -q 'GPL-3.0-or-later' "$work/version"

# says FOLDER EXPECTED: what the build of these sources would say
says() {
  cmake -D SOURCE="$1" -D HEADER="$work/commit.h" -P "$1/cmake/commit.cmake"
  grep -qx "#define CDEM_COMMIT \"$2\"" "$work/commit.h" || { echo "$1: expected $2:"; cat "$work/commit.h"; exit 1; }
}
repository=$work/repository
mkdir -p "$repository/cmake"
cp "$source/cmake/commit.cmake" "$source/cmake/commit.txt" "$repository/cmake/"
cp "$source/.gitattributes" "$repository/"
says "$repository" unknown
git_in() { git -C "$repository" -c user.name=test -c user.email=test@example.org -c init.defaultBranch=main -c commit.gpgsign=false "$@"; }
if command -v git >/dev/null; then
  git_in init -q
  git_in add -A
  git_in commit -qm first
  says "$repository" "$(git_in rev-parse --short HEAD)"
  touch -d @0 "$work/commit.h" # not touched again while nothing has changed
  says "$repository" "$(git_in rev-parse --short HEAD)"
  [ "$(stat -c %Y "$work/commit.h")" -eq 0 ]
  echo '# changed' >>"$repository/cmake/commit.cmake"
  says "$repository" "$(git_in rev-parse --short HEAD)-dirty"
  git_in commit -qam second
  says "$repository" "$(git_in rev-parse --short HEAD)"
  mkdir "$repository/inside"
  git_in archive HEAD | tar -x -C "$repository/inside" # an archive, and in another repository at that
  says "$repository/inside" "$(git_in rev-parse --short HEAD)"
fi
echo "versions are right"
