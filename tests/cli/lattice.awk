# A lattice as an Abaqus deck, for the tests of networks in other programs.
# awk -v kind=tri3|quad4|hex8 -v n=CELLS_A_SIDE -v h=EDGE -f lattice.awk
function node(i, j, k) { return 10 * (1 + i + (n + 1) * (j + (n + 1) * k)) }
function put_node(i, j, k) {
  printf "%d, %.17g, %.17g, %.17g\n", node(i, j, k), h * (i + (kind == "tri3" ? j / 2 : 0)),
    h * j * (kind == "tri3" ? sqrt(3) / 2 : 1), h * k
}
function put_cell(i, j, k) {
  if (kind == "tri3") {
    print ++cells ", " node(i, j, 0) ", " node(i + 1, j, 0) ", " node(i, j + 1, 0)
    print ++cells ", " node(i + 1, j, 0) ", " node(i + 1, j + 1, 0) ", " node(i, j + 1, 0)
    return
  }
  printf "%d, %s", ++cells, ring(i, j, k)
  print kind == "hex8" ? ", " ring(i, j, k + 1) : ""
}
function ring(i, j, k) {
  return node(i, j, k) ", " node(i + 1, j, k) ", " node(i + 1, j + 1, k) ", " node(i, j + 1, k)
}
BEGIN {
  solid = kind == "hex8"
  print "*NODE"
  for (k = 0; k <= (solid ? n : 0); k++)
    for (j = 0; j <= n; j++)
      for (i = 0; i <= n; i++) put_node(i, j, k)
  print "*ELEMENT, TYPE=" (kind == "tri3" ? "CPE3" : solid ? "C3D8" : "CPE4")
  for (k = 0; k < (solid ? n : 1); k++)
    for (j = 0; j < n; j++)
      for (i = 0; i < n; i++) put_cell(i, j, k)
}
