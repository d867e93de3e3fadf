#!/bin/sh
# The Debian package on a clean Debian 12: made by cpack, installed into a fresh root by apt, used by a user without rights,
# removed without a trace. Prints what it does. Needs root, debootstrap and a mirror, else it is skipped (77).
# usage: package.sh BUILD_FOLDER SOURCE_FOLDER
# CDEM_CACHE=FOLDER keeps what was downloaded for the next time; CDEM_MIRROR=URL is another mirror than that of this machine.
set -eu
build=$1 source=$2
skip() { echo "skipped: $1"; exit 77; }
[ "$(id -u)" -eq 0 ] || skip "a clean root needs root"
command -v debootstrap >/dev/null || skip "there is no debootstrap"
command -v cpack >/dev/null || skip "there is no cpack"
mirror=${CDEM_MIRROR:-$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Codename: bookworm' 2>/dev/null | head -1)}
mirror=${mirror:-http://deb.debian.org/debian}
work=$(mktemp -d)
root=$work/root
# Whatever debootstrap has mounted is let go before anything is removed.
clean() {
  for place in proc sys dev; do umount -l "$root/$place" 2>/dev/null || true; done
  if grep -q " $root" /proc/mounts; then echo "something is still mounted in $root; it stays"; else rm -rf --one-file-system "$work"; fi
}
trap clean EXIT
trap 'exit 1' INT TERM
/usr/lib/apt/apt-helper download-file "${mirror%/}/dists/bookworm/InRelease" "$work/InRelease" >/dev/null 2>&1 ||
  skip "there is no mirror at $mirror"

cache=${CDEM_CACHE:-$work/cache}
mkdir -p "$cache/archives"
start=$(date +%s)
step() { printf '\n== %4d s  %s\n' $(($(date +%s) - start)) "$*"; }
as_root() { printf '# %s\n' "$*"; chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive sh -ec "$*"; }
as_user() { printf '$ %s\n' "$*"; chroot --userspec=1000:1000 "$root" /usr/bin/env -i PATH=/usr/bin:/bin HOME=/home/someone LC_ALL=C.UTF-8 \
  OMP_WAIT_POLICY=passive sh -ec "cd; $*"; }
fetch() { as_root "apt-get install -y -qq --no-install-recommends -o Dpkg::Use-Pty=0 $* >/tmp/apt.log 2>&1 || { cat /tmp/apt.log; exit 1; }"
  cp -n "$root"/var/cache/apt/archives/*.deb "$cache/archives/" 2>/dev/null || true; }

step "the package"
(cd "$build" && cpack -G DEB -B "$work/pack" >"$work/cpack.log" 2>&1) || { cat "$work/cpack.log"; exit 1; }
package=$(find "$work/pack" -maxdepth 1 -name 'cdem_*.deb')
ls -l "$package"
dpkg-deb -f "$package" Version Architecture Depends Recommends Installed-Size
if command -v lintian >/dev/null; then
  lintian --allow-root --fail-on error "$package" || { echo "lintian finds errors"; exit 1; }
fi

step "a clean root from $mirror"
[ -s "$cache/bookworm.tar" ] ||
  { debootstrap --variant=minbase --make-tarball="$cache/bookworm.part" bookworm "$root" "$mirror" >"$work/boot.log" 2>&1 && mv "$cache/bookworm.part" "$cache/bookworm.tar"; } ||
  { tail "$work/boot.log"; exit 1; }
debootstrap --variant=minbase --unpack-tarball="$cache/bookworm.tar" bookworm "$root" "$mirror" >"$work/boot.log" 2>&1 || { tail "$work/boot.log"; exit 1; }
cp "$cache"/archives/*.deb "$root/var/cache/apt/archives/" 2>/dev/null || true
cp "$package" "$root/root/"
mkdir "$root/home/someone"
chown 1000:1000 "$root/home/someone"
as_root "apt-get update -qq"

step "installed"
fetch "/root/$(basename "$package")"
as_root "dpkg -V cdem"
as_root "dpkg -L cdem >/root/files"
for file in usr/bin/cdem "$(cd "$root" && find usr/lib -name 'libcdem.so.*.*')"; do
  as_root "! ldd /$file | grep 'not found'"
done

step "used"
as_user "cdem --version"
as_user "cdem verify springs >verify.txt 2>verify.err || { grep -v ^pass verify.txt; exit 1; }; cat verify.err; wc -l <verify.txt"
as_user "cdem springs /usr/share/cdem/meshes/block-with-hole.geo -E 40GPa --nu 0.25 -o springs.csv --certify"
as_user "cdem run /usr/share/cdem/cases/brazilian-disc.yaml --set mesh.parameters.h=0.008 -o plain 2>plain.err; tail -1 plain.err; grep -q gnuplot plain.err"
fetch gnuplot-nox
as_user "cdem run /usr/share/cdem/cases/brazilian-disc.yaml --set mesh.parameters.h=0.008 -o disc; ls disc disc/figures"
as_user 'for f in disc/figures/*.png; do head -c 4 "$f" | grep -q PNG; done; ls disc/figures/*.png | wc -l | grep -qvx 0; cdem compare plain disc'
as_user 'bash -c ". /usr/share/bash-completion/completions/cdem; COMP_WORDS=(cdem sp); COMP_CWORD=1; _cdem; echo \${COMPREPLY[*]}" | grep -x springs'
fetch mandoc
as_user "for page in /usr/share/man/man1/cdem*.1.gz; do mandoc -T lint -W warning \$page; done; mandoc -T ascii /usr/share/man/man1/cdem-run.1.gz | head -12"

step "built against"
fetch gcc libc6-dev pkg-config cmake make
cp "$source/tests/house/use.sh" "$root/home/someone/use.sh"
as_user "sh use.sh /usr/share/doc/cdem/examples /usr/share/cdem"

step "removed"
as_root "apt-get purge -y -qq cdem >/dev/null 2>&1; dpkg -s cdem 2>/dev/null && exit 1 || true"
# Folders that others use stay.
as_root 'left=0; while read -r path; do [ ! -e "$path" ] || [ -d "$path" ] || { echo "$path is left"; left=1; }; done </root/files; exit $left'
as_root '! find / -xdev \( -path /root -o -path /home -o -path /proc -o -path /var/cache/apt -o -path /var/log \) -prune -o -name "*cdem*" -print | grep .'
step "done"
