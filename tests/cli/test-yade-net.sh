#!/bin/sh
# YADE pulls the interactions we export; its forces at displaced nodes are -K u of the assembled matrix, which awk reads
# and multiplies. What contacts cannot carry acts in the script's own loop, so every network agrees, on its boundary too.
# usage: test-yade-net.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
cdem=$1/cdem here=$2/tests/cli
command -v yade >/dev/null || { echo "yade is not installed (Debian package yade); skipped" >&2; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

nets=
network() { # NAME KIND CELLS OPTIONS...
  name=$1 kind=$2 cells=$3
  shift 3
  awk -v kind="$kind" -v n="$cells" -v h=0.3 -f "$here/lattice.awk" >net.inp
  "$cdem" springs -q net.inp -E 40e9 "$@" -o "$name.py" -o "$name.mtx" >"$name.said" 2>&1
  awk -v n="$cells" -v size=3e-8 -v inside=0 -f "$here/move.awk" net.inp >"$name.moved"
  awk -f "$here/pull.awk" "$name.mtx" "$name.moved" >"$name.ours"
  nets="$nets $name"
}
network central tri3 4 --nu 0.25 --carry exact
network across quad4 4 --nu 0.25 --carry exact
network skew quad4 4 --nu 0.4
network solid hex8 3 --nu 0.4 --carry exact
grep -q 'hold more, in a loop of the script' skew.said
if grep -q 'hold more, in a loop' across.said; then echo "a pair of line form is in the loop" >&2; exit 1; fi

# Each node jumps to its place within one step: shear is what the velocity adds up to.
cat >pull.py <<'END'
import sys
for name in sys.argv[1:]:
    O.reset()
    exec(open(name + '.py').read())
    O.step()
    start = max(abs(c) for b in body for c in O.forces.f(b))
    for line in open(name + '.moved'):
        word = line.split()
        state = O.bodies[id_of[int(word[0])]].state
        u = Vector3(*[float(w) for w in word[4:7]])
        state.pos = state.pos + u
        state.vel = u / O.dt
    O.step()
    with open(name + '.theirs', 'w') as file:
        for tag, b in id_of.items():
            file.write('%d %.17g %.17g %.17g\n' % ((tag,) + tuple(O.forces.f(b))))
    if start != 0:
        sys.exit('%s: force %g at the start' % (name, start))
print('all pulled')
END
yade -x -n -j1 pull.py $nets >log 2>&1 || { tail -5 log; exit 1; }
grep -q 'all pulled' log || { tail -5 log; exit 1; }
for name in $nets; do
  awk -v name="$name" -v bound=1e-6 -f "$here/differ.awk" "$name.ours" "$name.theirs"
done
