#!/bin/sh
# Installs the Debian packages that are missing of sections of cmake/packages.txt; sudo only when not root.
# usage: install-packages.sh SECTION...   (from anywhere)
set -eu
here=$(cd "$(dirname "$0")" && pwd)
[ $# -gt 0 ] || { echo "usage: $0 SECTION..., sections of $here/packages.txt" >&2; exit 2; }
missing=
for section in "$@"; do
  grep -q "^# $section:" "$here/packages.txt" || { echo "error: $here/packages.txt has no section '$section'" >&2; exit 2; }
  for package in $(awk -v wanted="# $section:" '/^#/ { on = index($0, wanted) == 1; next } on' "$here/packages.txt"); do
    state=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)
    [ "$state" = "install ok installed" ] || missing="$missing $package"
  done
done
[ -n "$missing" ] || exit 0
sudo=
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "error: these packages are missing and sudo is not there to install them:$missing" >&2; exit 1; }
  sudo=sudo
fi
echo "installing:$missing"
export DEBIAN_FRONTEND=noninteractive
$sudo apt-get update -qq
# shellcheck disable=SC2086
$sudo apt-get install -y -qq --no-install-recommends $missing >/dev/null
