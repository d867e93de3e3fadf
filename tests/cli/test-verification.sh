#!/bin/sh
# The page of verifications says what the tables say, all but the values it was made with, each of which its tolerance
# allows (slow checks may lack theirs, since they take minutes); and every test that the page names is one.
# usage: test-verification.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
cdem=$1/cdem page=$2/docs/reference/verification.md
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Rows of checks have six cells; a bar inside of one is written \|.
without_values() {
  sed 's/\\|/BAR/g' "$1" | awk -F'|' -v OFS='|' 'NF == 8 { $3 = " – " } { print }'
}
"$cdem" verify --list --markdown >"$work/tables"
without_values "$work/tables" >"$work/wanted"
without_values "$page" >"$work/found"
diff "$work/wanted" "$work/found" >"$work/diff" || {
  echo "$page is not that of the tables; make it again: cdem verify --slow --markdown >$page"
  head -20 "$work/diff"
  exit 1
}
sed 's/\\|/BAR/g' "$page" | awk -F'|' '
  NF == 8 && $3 + 0 == $3 {
    off = $3 - $4; if (off < 0) off = -off
    if (off > $5 * 1.05 + 1e-5 * ($4 < 0 ? -$4 : $4)) { print "off by more than it may be: " $0; bad = 1 }
    values++
  }
  NF == 8 && $3 ~ /–/ && $2 !~ /\(slow\)/ { print "no value: " $0; bad = 1 }
  END { if (values < 300) { print "only " values + 0 " values"; bad = 1 } exit bad }'
ctest --test-dir "$1" -N | sed -n 's/^ *Test *#[0-9]*: //p' >"$work/tests"
sed -n 's/^| `\([a-z]*\.[a-z_-]*\)` |.*/\1/p' "$page" >"$work/named"
[ -s "$work/named" ]
while read -r name; do
  grep -qxF "$name" "$work/tests" || { echo "$page: there is no test '$name'"; exit 1; }
done <"$work/named"
echo "$(wc -l <"$work/named") tests named"
