#!/bin/sh
# The face of libcdem: what it exports, what its header declares, the list of the linker and the page of the reference are one;
# the header stands alone in C17 and C++17.
# usage: api.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
header=$source/src/api/libcdem.h page=$source/docs/reference/library.md

grep '^libcdem_' "$source/cmake/public-api.txt" >list
LC_ALL=C sort -u list | cmp -s - list || { echo "cmake/public-api.txt is not sorted, or names a function twice"; exit 1; }
[ "$(wc -l <list)" -gt 0 ]

# Prototypes, each on one line, without comments.
one_line() { tr '\n' ' ' | sed 's/;/;\n/g' | sed 's/[[:space:]]\{1,\}/ /g; s/^ //' | grep -E '^[a-z].* \**libcdem_[a-z_]*\(.*\);$' | grep -v '^typedef'; }
cc -fpreprocessed -dD -E -P "$header" | grep -v '^ *#\|extern "C"' | one_line >prototypes
awk '/^```/ { on = /^```c$/; next } on' "$page" | one_line >documented
sed 's/(.*//; s/.*[ *]//' prototypes | LC_ALL=C sort >declared
# The compiler's view of the same header, lest the text above misses one.
printf '#include <libcdem.h>\n' >all.c
cc -std=c17 -I"$source/src/api" -aux-info all.info -fsyntax-only all.c
grep -oE 'libcdem_[a-z_]+ \(' all.info | tr -d ' (' | LC_ALL=C sort -u >seen
nm -D --defined-only "$build/libcdem.so" | awk '$2 != "A" { sub(/@.*/, "", $3); print $3 }' | LC_ALL=C sort -u >exported
for what in declared seen exported; do
  diff list "$what" >difference || { echo "cmake/public-api.txt (<) and what is $what (>) differ:"; cat difference; exit 1; }
done
LC_ALL=C sort prototypes >a
LC_ALL=C sort documented >b
diff a b >difference || { echo "src/api/libcdem.h (<) and docs/reference/library.md (>) differ:"; cat difference; exit 1; }

# Each function stands under a comment, alone or in a block of them.
awk '/^\/\*/ { said = 1 } /^$/ { said = 0 } /^[a-z].*libcdem_[a-z_]*\(/ && !said && !/_(nodes|cells|destroy)\(/ { print "no comment: " $0; bad = 1 }
     END { exit bad }' "$header"

# The library file has the name of its major version.
version=$("$build/cdem" --version | sed -n '1s/^cdem \([0-9]*\)\..*/\1/p')
readelf -d "$build/libcdem.so" | grep -q "SONAME.*\[libcdem\.so\.$version\]" || { echo "the soname is not libcdem.so.$version"; exit 1; }

flags="-Wall -Wextra -Wpedantic -Werror -fsyntax-only -I$source/src/api"
# shellcheck disable=SC2086
for standard in c99 c17; do cc -std=$standard $flags all.c; done
cp all.c all.cc
# shellcheck disable=SC2086
c++ -std=c++17 $flags -Wold-style-cast all.cc
# What the header holds can be used in C++, with these names.
cat >use.cc <<'END'
#include <libcdem.h>
#include <cstdio>
int main() {
  libcdem_fault fault = {};
  libcdem_springs springs = {};
  const double block[4] = {2.0, 0.0, 0.0, 1.0};
  if (libcdem_springs_of_block(2, block, true, &springs, &fault) != LIBCDEM_OK)
    return 1;
  std::printf("%s %g\n", libcdem_form_name(springs.form), springs.term[0].stiffness);
}
END
c++ -std=c++17 -Wall -Wextra -Wpedantic -Werror -I"$source/src/api" use.cc -L"$build" -lcdem -Wl,-rpath,"$build" -o use
[ "$(./use)" = 'diagonal 2' ]
echo "$(wc -l <list) functions, one face"
