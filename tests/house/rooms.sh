#!/bin/sh
# Reads every #include "ROOM/..." of every room against cmake/rooms.txt: no way back, no cycles.
# usage: rooms.sh SOURCE_FOLDER
cd "$1" || exit 2
awk '
  FILENAME == "cmake/rooms.txt" {
    if ($0 ~ /^#/ || $0 == "") next
    room = $1; sub(/:$/, "", room)
    known[room] = 1; allowed[room, room] = 1
    for (i = 2; i <= NF; i++) {
      if (!($i in known)) { printf "cmake/rooms.txt: %s may include %s, which comes later: a cycle\n", room, $i; bad = 1 }
      allowed[room, $i] = 1
    }
    next
  }
  FNR == 1 { split(FILENAME, part, "/"); here = part[1] == "tools" ? "tools" : part[2]
             if (!(here in known)) { printf "%s: room %s is not in cmake/rooms.txt\n", FILENAME, here; bad = 1 } }
  /^[ \t]*#[ \t]*include[ \t]*"[a-z0-9_]+\// {
    split($0, quoted, "\""); split(quoted[2], path, "/")
    if (!((here, path[1]) in allowed)) { printf "%s:%d: room %s may not include %s\n", FILENAME, FNR, here, path[1]; bad = 1 }
    files++
  }
  END { if (files == 0) { print "no includes found"; bad = 1 } exit bad }
' cmake/rooms.txt $(find src tools -name '*.[ch]' -o -name '*.def' | sort) || exit 1
# Only io opens files, only tools print, exit or read the environment.
grep -nE '\b([fvd]*printf|f?put[sc]|putchar|perror|exit|abort|getenv|stdout|stderr)\b[[:space:]]*[(,;)]' -r src --include='*.[ch]' |
  grep -vE '^src/io/|^[^:]*:[0-9]+: \*|s(n)?printf|format\(printf' && exit 1
grep -nE '\b(fopen|fdopen|freopen|gzopen|open|H5F(create|open))[[:space:]]*\(' -r src --include='*.[ch]' |
  grep -vE '^src/io/|->open|\(\*open\)' && exit 1
# Only base/memory.c allocates, so that a test can make every allocation fail (tests/robust/memory.c).
grep -nE '\b(malloc|calloc|realloc|reallocarray|aligned_alloc|posix_memalign|strn?dup|v?asprintf)[[:space:]]*\(' -r src tools \
  --include='*.[ch]' | grep -vE '^src/base/memory\.c:|^[^:]*:[0-9]+: \*' && exit 1
echo "rooms hold"
