#!/bin/sh
# Runs every command block marked "sh run" of the README and the tutorials, in a copy of what they name.
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
echo "$pages pages run"
