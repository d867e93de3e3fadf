# Displacements of the nodes of a lattice.awk deck, "TAG X Y Z UX UY UZ" a line.
# awk -v n=CELLS_A_SIDE -v size=U -v inside=0|1 [-v angle=A] -f move.awk DECK
# Without an angle random, up to `size` in each direction; inside=1: of nodes within the body alone.
# With an angle that of a rotation about z by it, whatever its size.
BEGIN { srand(7); FS = ", *" }
/^\*/ { reading = /^\*NODE/; next }
reading { tag[++nodes] = $1; for (c = 1; c <= 3; c++) x[nodes, c] = $(c + 1); if ($4 > 0) solid = 1 }
# Is the node with this tag on no side of the lattice?
function within(tag, place, c) {
  place = tag / 10 - 1
  for (c = 1; c <= (solid ? 3 : 2); c++) {
    if (place % (n + 1) == 0 || place % (n + 1) == n) return 0
    place = int(place / (n + 1))
  }
  return 1
}
END {
  for (i = 1; i <= nodes; i++) {
    free = !inside || within(tag[i])
    for (c = 1; c <= 3; c++) u[c] = free && (c < 3 || solid) ? size * (2 * rand() - 1) : 0
    if (angle != "") {
      u[1] = (cos(angle) - 1) * x[i, 1] - sin(angle) * x[i, 2]
      u[2] = (cos(angle) - 1) * x[i, 2] + sin(angle) * x[i, 1]
    }
    printf "%d %.17g %.17g %.17g %.17g %.17g %.17g\n", tag[i], x[i, 1], x[i, 2], x[i, 3], u[1], u[2], u[3]
  }
}
