#!/bin/sh
# Replays a transcript: command lines and what they must print.
#
#   # comment
#   $ command        run by sh in the transcript's own empty folder, `cdem` in the PATH
#   > line           expected on stdout
#   ! line           expected on stderr
#   ? 3              expected exit code (0 when not given)
#
# In expected lines "..." stands for any text, and a line of only "..." for any number of lines.
# Silence is expected where nothing is said.
# usage: transcript.sh BUILD_FOLDER SOURCE_FOLDER FILE
set -u
PATH=$1:$PATH
CDEM_SOURCE=$2
MESHES=$2/data/meshes
MATERIALS=$2/data/materials
file=$(cd "$(dirname "$3")" && pwd)/$(basename "$3")
export PATH CDEM_SOURCE MESHES MATERIALS LC_ALL=C
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/run"
passed=0 failed=0

# matches EXPECTED ACTUAL: line by line with the wildcards above
matches() {
  awk -v expected="$1" -v actual="$2" '
    function same(pattern, text,   part, n, i, at) {
      n = split(pattern, part, /\.\.\./)
      if (n <= 1) return pattern == text
      if (substr(text, 1, length(part[1])) != part[1]) return 0
      text = substr(text, length(part[1]) + 1)
      for (i = 2; i < n; i++) {
        if (part[i] == "") continue
        at = index(text, part[i])
        if (at == 0) return 0
        text = substr(text, at + length(part[i]))
      }
      return length(text) >= length(part[n]) && substr(text, length(text) - length(part[n]) + 1) == part[n]
    }
    function walk(e, a) {
      for (; e <= ne; e++) {
        if (E[e] == "...") {
          for (; a <= na + 1; a++) if (walk(e + 1, a)) return 1
          return 0
        }
        if (a > na || !same(E[e], A[a])) return 0
        a++
      }
      return a > na
    }
    BEGIN {
      while ((getline line < expected) > 0) E[++ne] = line
      while ((getline line < actual) > 0) A[++na] = line
      exit !walk(1, 1)
    }' </dev/null
}

# judge: runs the command in $work/command against $work/expected.{out,err,code}
judge() {
  [ -s "$work/command" ] || return 0
  (cd "$work/run" && timeout 300 sh "$work/command" >"$work/out" 2>"$work/err" </dev/null)
  code=$? good=yes
  for stream in out err; do
    matches "$work/expected.$stream" "$work/$stream" && continue
    good=no
    printf '%s: %s\n  std%s should be\n' "$(basename "$file")" "$(cat "$work/command")" "$stream"
    sed 's/^/    /' "$work/expected.$stream"
    echo "  but is"
    head -40 "$work/$stream" | sed 's/^/    /'
  done
  wanted=$(cat "$work/expected.code")
  if [ "$code" -ne "$wanted" ]; then
    good=no
    printf '%s: %s\n  exit code %s, expected %s\n' "$(basename "$file")" "$(cat "$work/command")" "$code" "$wanted"
    sed 's/^/    /' "$work/err" | head -5
  fi
  if [ "$good" = yes ]; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
}

: >"$work/command"
while IFS= read -r line || [ -n "$line" ]; do
  case $line in
    '$ '*)
      judge
      printf '%s\n' "${line#??}" >"$work/command"
      : >"$work/expected.out"; : >"$work/expected.err"; echo 0 >"$work/expected.code" ;;
    '> '*) printf '%s\n' "${line#??}" >>"$work/expected.out" ;;
    '! '*) printf '%s\n' "${line#??}" >>"$work/expected.err" ;;
    '? '*) printf '%s\n' "${line#??}" >"$work/expected.code" ;;
    '' | '#'*) ;;
    *) echo "$file: this line means nothing: $line"; exit 2 ;;
  esac
done <"$file"
judge
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
