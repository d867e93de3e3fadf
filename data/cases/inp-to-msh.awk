# Turns a CalculiX deck of bricks (C3D8) or plane quadrilaterals (CPE4, CPS4) into a gmsh file, format 2.2: the element
# set as the group "beam", node sets FIX and END as groups of points.
# usage: LC_ALL=C awk -f inp-to-msh.awk deck.inp > mesh.msh
/^\*\*/ {next}
/^\*/ {
  mode = ""
  if ($0 ~ /^\*NODE,/) mode = "node"
  if ($0 ~ /^\*ELEMENT/) {mode = "element"; shape = $0 ~ /C3D8/ ? 5 : 3; dimension = shape == 5 ? 3 : 2}
  if ($0 ~ /^\*NSET, NSET=FIX/) mode = "FIX"
  if ($0 ~ /^\*NSET, NSET=END/) mode = "END"
  next
}
mode == "" {next}
{gsub(/[ \r]/, ""); count = split($0, field, ",")}
mode == "node" {node[++nodes] = field[1] " " field[2] " " field[3] " " field[4]; next}
mode == "element" {
  # A line that ends with a comma goes on.
  for (i = 1; i <= count; i++) if (field[i] != "") item[++items] = field[i]
  if (items < (shape == 5 ? 9 : 5)) next
  line = item[1] " " shape " 2 1 1"
  for (i = 2; i <= items; i++) line = line " " item[i]
  element[++elements] = line
  if (item[1] + 0 > highest) highest = item[1] + 0
  items = 0
  next
}
{for (i = 1; i <= count; i++) if (field[i] != "") point[++points] = (mode == "FIX" ? 2 : 3) " " field[i]}
END {
  print "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3"
  print dimension " 1 \"beam\"\n0 2 \"fixed\"\n0 3 \"end\"\n$EndPhysicalNames\n$Nodes\n" nodes
  for (i = 1; i <= nodes; i++) print node[i]
  print "$EndNodes\n$Elements\n" elements + points
  for (i = 1; i <= elements; i++) print element[i]
  for (i = 1; i <= points; i++) {split(point[i], field, " "); print highest + i, 15, 2, field[1], field[1], field[2]}
  print "$EndElements"
}
