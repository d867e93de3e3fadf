#!/bin/sh
# Runs every command block marked "sh run" of the README and the tutorials, in a copy of what they name; then looks that
# links lead somewhere, every page is linked, equations that are cited exist, and the picture of the rooms is that of the
# tables.
# usage: test-docs.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
PATH=$build:$PATH
export PATH
pages=0
for page in "$source/README.md" "$source"/docs/tutorials/*.md; do
  mkdir -p "$work/run"
  ln -sfn "$source/data" "$work/run/data"
  awk '/^```/ {on = /^```sh run/; next} on' "$page" >"$work/commands"
  [ -s "$work/commands" ] || { echo "$page has no block marked \"sh run\""; exit 1; }
  (cd "$work/run" && sh -eu "$work/commands" >"$work/out" 2>"$work/err") ||
    { echo "$page: a command failed:"; tail -5 "$work/out" "$work/err"; exit 1; }
  rm -rf "$work/run"
  pages=$((pages + 1))
done
# Links between pages lead somewhere.
cd "$source"
bad=0
for page in README.md CHANGELOG.md $(find docs -name '*.md'); do
  for target in $(grep -oE '\]\([^)#]+' "$page" | sed 's/^](//' | grep -vE '^https?:'); do
    [ -e "$(dirname "$page")/$target" ] || { echo "$page: link to $target leads nowhere"; bad=1; }
  done
done
[ $bad -eq 0 ]
# Every page can be reached from the README.
links() { # PAGE: the pages it links to
  grep -oE '\]\([^)#]+\.md' "$1" | sed 's/^](//' | grep -vE '^https?:' | while read -r target; do
    realpath --relative-to=. "$(dirname "$1")/$target"
  done
}
echo README.md >"$work/reached"
before=0
while now=$(wc -l <"$work/reached"); [ "$now" -gt "$before" ]; do
  before=$now
  while read -r page; do links "$page"; done <"$work/reached" | sort -u - "$work/reached" >"$work/more"
  mv "$work/more" "$work/reached"
done
for page in $(find docs -name '*.md'); do
  grep -qxF "$page" "$work/reached" || { echo "$page: no page leads to it"; bad=1; }
done
# Equations of theory pages that code, tests and the page of verifications cite; labels stand at the ends of lines,
# or before "source".
cited=0
grep -rhoE 'docs/theory/[a-z-]+\.md, eqs?\.? [^;"*]*' src tests bench tools docs/reference/verification.md |
  sed 's/ | .*//' >"$work/citations"
while read -r citation; do
  page=${citation%%,*}
  for label in $(echo "${citation#*,}" | grep -oE '\(?[0-9]+[a-z]?\)?' | tr -d '()'); do
    grep -qE "^ {4}.* \($label\)( +source.*| \.)?\$" "$page" || { echo "$page has no equation ($label): $citation"; bad=1; }
    cited=$((cited + 1))
  done
done <"$work/citations"
[ $cited -ge 100 ] || { echo "only $cited equations are cited"; bad=1; }
awk -f docs/figures/rooms.awk cmake/rooms.txt docs/rooms/index.md | cmp -s - docs/figures/rooms.svg ||
  { echo "docs/figures/rooms.svg is old; make it again by the command of docs/rooms/index.md"; bad=1; }
[ $bad -eq 0 ]
echo "$pages pages run, $cited equations cited"
