#!/bin/sh
# The user's locale, with a decimal comma, changes no byte of what the program writes or says. (A program that uses the
# library and has switched to such a locale: tests/robust/locale.c.)
# usage: test-locale.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cdem=$1/cdem
cases=$2/tests/robust/cases
meshes=$2/data/meshes
export OMP_NUM_THREADS=1 OMP_WAIT_POLICY=passive OPENBLAS_NUM_THREADS=1
if ! localedef -i de_DE -f UTF-8 "$work/de_DE.UTF-8" >/dev/null 2>&1; then
  echo "no locale with a decimal comma can be made: skipped"
  exit 77
fi
export LOCPATH="$work"
[ "$(LC_ALL=de_DE.UTF-8 locale decimal_point)" = , ] || { echo "the locale has no comma: skipped"; exit 77; }

# Each command in a folder of its own; errors too.
cat >commands <<'EOC'
springs "$meshes/mixed.msh" -E '1.5 GPa' --nu 0.25 -o s.csv -o s.vtp -o s.mtx -o s.inp
springs "$meshes/plate.geo" -E 1.5e9 --nu 0.25 --thickness '0.5 m' -o s.csv --json
springs "$meshes/mixed.msh" --material "$2/data/materials/granite.yaml" -o s.csv
springs "$meshes/mixed.msh" -E 1,5e9 --nu 0.25
poisson --element quad4 --plane strain --thickness 1 --from -0.2 --to 0.45 --step 0.05 -o t.csv
poisson --element quad4 --plane strain --thickness 1 --roots -o t.json
poisson --compare gusev
pack loose --size 0.5,0.5 --radius 0.05 --fraction 0.25 -o p.csv -o p.vtp
pack loose --size 0,5,0.5 --radius 0.05 --count 5 -o p.csv
scale "$cases/heap.yaml" --h 2.5 -o x.yaml
scale "$cases/bonded.yaml" --h 0.5 -o x.yaml
run -q "$cases/breaking.yaml" --set 'end=0.15 ms' -o run
run -q --no-figures "$cases/grid-file.yaml" --set mesh.parameters.n=2.5 -o run
run -q "$cases/heap.yaml" --set 'end=1.5 ms' -o run
run --no-figures "$cases/static.yaml" --set 'end=0,15 ms' -o run
help case
list
EOC
number=0
while read -r command; do
  number=$((number + 1))
  for locale in C de_DE.UTF-8; do
    mkdir -p "$locale/$number"
    (cd "$locale/$number" && set -- . "$2" && LC_ALL=$locale && export LC_ALL && code=0
      eval "\"$cdem\" $command" >printed 2>said || code=$?
      echo $code >code)
    # What is the time of day or of the run.
    sed -E -i '/wall|_per_second|"seconds"|[0-9] s( |$)/d' "$locale/$number"/printed "$locale/$number"/said
    find "$locale/$number" -name checkpoint.h5 -delete -o -name .lock -delete
    [ ! -e "$locale/$number/run/summary.json" ] ||
      sed -E -i '/"(wall_[a-z]*|grain_steps_per_second)":/d' "$locale/$number/run/summary.json"
  done
  diff -r "C/$number" "de_DE.UTF-8/$number" || { echo "another locale, another result: $command"; exit 1; }
done <commands
# The list has commands that do their work and commands that fail.
grep -qx 0 C/1/code && grep -qx 3 C/4/code && [ -s C/12/run/history.csv ] || { cat C/*/said; exit 1; }
echo "$number commands give the same bytes with a decimal comma"
