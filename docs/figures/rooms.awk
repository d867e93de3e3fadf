# The way of data through the rooms as a picture, from the table of includes and the words of the rooms' page:
#     awk -f docs/figures/rooms.awk cmake/rooms.txt docs/rooms/index.md >docs/figures/rooms.svg
# An arrow leads from a room to one that may include it; arrows that follow from others are left out, and base is under
# all. Columns: longest way from a room that includes nothing but base. Long arrows hold a place in every column they pass.
function place_text(x, y, size, style, text) {
  gsub(/&/, "\\&amp;", text); gsub(/</, "\\&lt;", text)
  printf "<text x=\"%d\" y=\"%d\" font-size=\"%d\"%s>%s</text>\n", x, y, size, style, text
}
function reaches(from, to,   i, n, part) {
  n = split(uses[to], part, " ")
  for (i = 1; i <= n; i++) if (part[i] == from || reaches(from, part[i])) return 1
  return 0
}
function add_edge(from, to) { edge_from[++edges] = from; edge_to[edges] = to }
function add_node(name, column) {
  node[++nodes] = name; column_of[name] = column
  row_of[name] = filled[column]++; member[column, row_of[name]] = name
  if (column > last_column) last_column = column
}
# Mean row of the neighbours on one side, in thousandths of a row.
function wanted(name, side,   e, sum, count) {
  for (e = 1; e <= edges; e++) {
    if (side < 0 && edge_to[e] == name) { sum += y_of[edge_from[e]]; count++ }
    if (side > 0 && edge_from[e] == name) { sum += y_of[edge_to[e]]; count++ }
  }
  return count ? int(sum / count) : y_of[name]
}
# Sorts a column by what its nodes want, then spreads them: places for long arrows are narrow.
function settle(column, side,   i, j, name, low, want, total) {
  for (i = 0; i < filled[column]; i++) want[member[column, i]] = wanted(member[column, i], side)
  for (i = 1; i < filled[column]; i++)
    for (j = i; j > 0 && want[member[column, j]] < want[member[column, j - 1]]; j--) {
      name = member[column, j]; member[column, j] = member[column, j - 1]; member[column, j - 1] = name
    }
  low = -100000
  for (i = 0; i < filled[column]; i++) {
    name = member[column, i]
    y_of[name] = want[name] > low + half(name) ? want[name] : low + half(name)
    low = y_of[name] + half(name)
    total += y_of[name] - want[name]
  }
  for (i = 0; i < filled[column]; i++) y_of[member[column, i]] -= int(total / filled[column])
}
function half(name) { return name in uses ? 500 : 160 }
function x_at(column) { return 20 + 128 * column }
function y_at(name) { return int((y_of[name] - top) * 80 / 1000) + 20 }

FILENAME ~ /rooms.txt$/ {
  if ($0 ~ /^#/ || NF == 0) next
  room = $1; sub(/:$/, "", room)
  order[++rooms] = room; uses[room] = ""
  for (i = 2; i <= NF; i++) if ($i != "base") uses[room] = uses[room] " " $i
  next
}
/^\| `[a-z]+\/?` \|/ {
  split($0, cell, / *\| */); name = cell[2]; gsub(/[`\/]/, "", name)
  whole[name] = cell[3]; sub(/[,;:].*/, "", cell[3]); words[name] = cell[3]
}
END {
  for (r = 1; r <= rooms; r++) {
    room = order[r]
    if (room == "base") continue
    level = 0; n = split(uses[room], part, " ")
    for (i = 1; i <= n; i++) if (column_of[part[i]] >= level) level = column_of[part[i]] + 1
    add_node(room, level)
    for (i = 1; i <= n; i++) {
      direct = 1
      for (j = 1; j <= n; j++) if (j != i && reaches(part[i], part[j])) direct = 0
      if (!direct) continue
      before = part[i]
      for (c = column_of[part[i]] + 1; c < level; c++) {
        add_node(part[i] ">" room ">" c, c); add_edge(before, node[nodes]); before = node[nodes]
      }
      add_edge(before, room)
    }
  }
  for (i = 1; i <= nodes; i++) y_of[node[i]] = 1000 * row_of[node[i]]
  for (sweep = 0; sweep < 12; sweep++) {
    for (c = 1; c <= last_column; c++) settle(c, -1)
    for (c = last_column - 1; c >= 0; c--) settle(c, 1)
  }
  top = 1e6; bottom = -1e6
  for (i = 1; i <= nodes; i++) {
    if (y_of[node[i]] - half(node[i]) < top) top = y_of[node[i]] - half(node[i])
    if (y_of[node[i]] + half(node[i]) > bottom) bottom = y_of[node[i]] + half(node[i])
  }
  width = x_at(last_column) + 124; height = int((bottom - top) * 80 / 1000) + 90
  printf "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" width=\"%d\" height=\"%d\" font-family=\"sans-serif\" text-anchor=\"middle\">\n", width, height, width, height
  print "<title>Rooms: an arrow leads from a room to one that may include it</title>"
  print "<defs><marker id=\"tip\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"8\" markerHeight=\"8\" orient=\"auto\"><path d=\"M0 0L8 4L0 8z\" fill=\"#456\"/></marker></defs>"
  printf "<rect width=\"%d\" height=\"%d\" fill=\"#fff\"/>\n<g fill=\"none\" stroke=\"#456\" stroke-width=\"1.4\">\n", width, height
  for (e = 1; e <= edges; e++) {
    from = edge_from[e]; to = edge_to[e]
    x1 = x_at(column_of[from]) + 104; x2 = x_at(column_of[to])
    if (!(from in uses)) printf "<path d=\"M%d %dL%d %d\"/>\n", x1 - 104, y_at(from), x1, y_at(from)
    printf "<path d=\"M%d %dC%d %d %d %d %d %d\"%s/>\n", x1, y_at(from), x1 + 14, y_at(from), x2 - 14, y_at(to), x2, y_at(to), to in uses ? " marker-end=\"url(#tip)\"" : ""
  }
  print "</g>"
  for (i = 1; i <= nodes; i++) {
    name = node[i]
    if (!(name in uses)) continue
    x = x_at(column_of[name]); y = y_at(name)
    printf "<rect x=\"%d\" y=\"%d\" width=\"104\" height=\"62\" rx=\"7\" fill=\"#eef3f8\" stroke=\"#456\"/>\n", x, y - 31
    place_text(x + 52, y - 13, 15, " font-weight=\"bold\"", name)
    n = split(words[name], part, " "); line = ""; at = y + 4
    for (j = 1; j <= n; j++) {
      if (line != "" && length(line " " part[j]) > 17) { place_text(x + 52, at, 11, "", line); at += 12; line = part[j] }
      else line = line == "" ? part[j] : line " " part[j]
    }
    place_text(x + 52, at, 11, "", line)
  }
  printf "<rect x=\"20\" y=\"%d\" width=\"%d\" height=\"34\" rx=\"7\" fill=\"#f6f1e4\" stroke=\"#654\"/>\n", height - 46, width - 40
  place_text(int(width / 2), height - 24, 13, "", "base, under all: " whole["base"])
  print "</svg>"
}
