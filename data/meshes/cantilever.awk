# Writes cantilever.inp: `LC_ALL=C awk -f cantilever.awk > cantilever.inp`. A beam of 1 m x 0.3 m x 0.2 m in
# 12 x 4 x 3 hexahedra; smooth waves move the inner nodes by up to a quarter of an element.
BEGIN {
  nx = 12; ny = 4; nz = 3; lx = 1; ly = 0.3; lz = 0.2; pi = atan2(0, -1)
  print "** Cantilever of distorted hexahedra, SI units (m, N, Pa, kg). Made by cantilever.awk."
  print "*HEADING\nCantilever under its end load"
  print "*NODE, NSET=ALL"
  for (k = 0; k <= nz; k++) for (j = 0; j <= ny; j++) for (i = 0; i <= nx; i++) {
    x = i / nx; y = j / ny; z = k / nz
    inner = (i > 0 && i < nx && j > 0 && j < ny && k > 0 && k < nz)
    dx = inner ? 0.25 * sin(7 * x + 11 * y + 5 * z) : 0
    dy = inner ? 0.25 * cos(9 * x + 4 * y + 3 * z) : 0
    dz = inner ? 0.20 * sin(8 * x + 6 * y + 10 * z) : 0
    printf "%d, %.6f, %.6f, %.6f\n", node(i, j, k), (i + dx) * lx / nx, (j + dy) * ly / ny, (k + dz) * lz / nz
  }
  print "*ELEMENT, TYPE=C3D8, ELSET=beam"
  for (k = 0; k < nz; k++) for (j = 0; j < ny; j++) for (i = 0; i < nx; i++)
    printf "%d, %d, %d, %d, %d,\n  %d, %d, %d, %d\n", element(i, j, k),
      node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k),
      node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)
  print "*ELSET, ELSET=root"
  for (k = 0; k < nz; k++) for (j = 0; j < ny; j++) printf "%d,\n", element(0, j, k)
  print "** the lowest layer\n*ELSET, ELSET=lowest, GENERATE"
  printf "%d, %d, 1\n", element(0, 0, 0), element(nx - 1, ny - 1, 0)
  print "*ELSET, ELSET=marked\nroot, lowest"
  print "*NSET, NSET=FIX"
  for (k = 0; k <= nz; k++) for (j = 0; j <= ny; j++) printf "%d,\n", node(0, j, k)
  print "*NSET, NSET=END"
  for (k = 0; k <= nz; k++) for (j = 0; j <= ny; j++) printf "%d,\n", node(nx, j, k)
  print "*MATERIAL, NAME=STEEL\n*ELASTIC\n210e9, 0.3\n*SOLID SECTION, ELSET=beam, MATERIAL=STEEL"
  print "*STEP\n*STATIC\n*BOUNDARY\nFIX, 1, 3\n*CLOAD\nEND, 3, -50.\n*NODE PRINT, NSET=END\nU\n*END STEP"
}
function node(i, j, k) { return 1000 * k + 100 * j + i + 1 }
function element(i, j, k) { return 1 + i + nx * (j + ny * k) }
