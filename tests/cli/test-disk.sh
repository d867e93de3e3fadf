#!/bin/sh
# Places that cannot be written, for the whole program: standard output on a full device, file systems that are full or
# read-only, folders of others. Each time exit code 6 and one error that says what to do; what was there before stays,
# and a run goes on when there is room again. (tests/robust/disk.c cuts off every file the library writes.)
# usage: test-disk.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
work=$(mktemp -d)
mounted=
finish() {
  [ -z "$mounted" ] || umount "$mounted"
  rm -rf "$work"
}
trap finish EXIT
cd "$work"
. "$2/tests/cli/runs.sh"
cases=$2/tests/robust/cases
mesh=$2/data/meshes/mixed.msh
export OMP_NUM_THREADS=1
here=$PWD

# refused COMMAND...: exit code 6 and one line, an error, with a remedy
refused() {
  code=0
  "$@" >out 2>err || code=$?
  [ $code -eq 6 ] || { echo "exit code $code: $*"; cat err; exit 1; }
  [ "$(grep -c '^error: cannot ' err)" -eq 1 ] && [ "$(wc -l <err)" -eq 1 ] || { echo "$*"; cat err; exit 1; }
}

# ---- whatever prints, into a full device ----

"$cdem" run -q --no-figures "$cases/static.yaml" -o whole
cp -r whole other
while read -r command; do
  code=0
  eval "\"$cdem\" $command" >/dev/full 2>err || code=$?
  [ $code -eq 6 ] || { echo "exit code $code: $command"; cat err; exit 1; }
  [ "$(grep -c '^error: ' err)" -eq 1 ] || { echo "$command"; cat err; exit 1; }
done <<'EOC'
--version
--help
help
help case
help case --schema
help case --markdown
help springs
help errors
springs --help
poisson --usage
run --help
list
list laws
springs -q "$mesh" -E 1e9 --nu 0.2
springs -q "$mesh" -E 1e9 --nu 0.2 --json
springs -q "$mesh" -E 1e9 --nu 0.2 -o -
springs -q "$mesh" -E 1e9 --nu 0.2 -o printed.csv
poisson -q --element quad4 --plane strain --thickness 1 --roots
poisson -q --from 0 --to 0.1 --step 0.05
run --check "$cases/static.yaml"
run --no-figures "$cases/static.yaml" -o printed
scale "$cases/static.yaml" --h 2
scale -q "$cases/static.yaml" --h 2 -o -
scale "$cases/static.yaml" --h 2 -o printed.yaml
pack cubic --size 1,1 --radius 0.1 -o printed.csv
compare whole other
compare --json whole other
verify --list
EOC

# ---- folders of others ----

as_other="$cdem"
if [ "$(id -u)" -eq 0 ]; then
  chmod 755 "$here"
  as_other="setpriv --reuid 65534 --regid 65534 --clear-groups $cdem"
fi
mkdir closed
cp -r whole closed/run
rm closed/run/summary.json
chmod -R a-w closed
refused $as_other springs -q "$mesh" -E 1e9 --nu 0.2 -o closed/s.csv
refused $as_other springs -q "$mesh" -E 1e9 --nu 0.2 -o closed/s.h5
refused $as_other poisson -q --figures closed
refused $as_other pack cubic -q --size 1,1 --radius 0.1 -o closed/c.csv
refused $as_other scale -q "$cases/static.yaml" --h 2 -o closed/c.yaml
refused $as_other run -q --no-figures "$cases/static.yaml" -o closed
refused $as_other run -q --no-figures "$cases/static.yaml" -o closed/deeper
refused $as_other run -q --no-figures --resume closed/run
chmod 000 closed/run/case.yaml
refused $as_other run -q "$PWD/closed/run/case.yaml" -o here
chmod -R u+rwX closed
[ "$(ls -A closed)" = run ] || { ls -lA closed; exit 1; }

# ---- a small file system: a run meets its end, and goes on when it is larger ----

mkdir small
if ! mount -t tmpfs -o size=16k none small 2>/dev/null; then
  echo "no file system can be mounted here: that part is skipped"
  exit 0
fi
mounted=$here/small
rm -rf whole
case=$cases/breaking.yaml
"$cdem" run -q --no-figures "$case" -o whole
size=16 met=0
while [ $size -le 4096 ]; do
  mount -o "remount,size=${size}k" small
  code=0
  if [ -e small/run/checkpoint.h5 ]; then
    "$cdem" run -q --no-figures --resume small/run >out 2>err || code=$?
  else
    "$cdem" run -q --no-figures "$case" -o small/run >out 2>err || code=$?
  fi
  [ $code -ne 0 ] || break
  [ $code -eq 6 ] && grep -q "^error: cannot .*small/run.*; free some space" err || { echo "${size}k: $code"; cat err; exit 1; }
  ! ls -AR small | grep part- || { echo "${size}k: an unfinished file stays"; exit 1; }
  met=$((met + 1)) size=$((size + 8))
done
[ $met -ge 3 ] || { echo "the file system was never full"; exit 1; }
same small/run

# Read-only, what is there can still be read, and nothing is lost.
mount -o remount,ro small
"$cdem" compare whole small/run >out
refused "$cdem" run -q "$case" -o small/run
refused "$cdem" springs -q "$mesh" -E 1e9 --nu 0.2 -o small/s.csv
refused "$cdem" scale -q "$case" --h 2 -o small/c.yaml
same small/run
echo "a run met the end of its disk $met times and came to the same bits"
