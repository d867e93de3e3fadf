# The forces -K u of a network, "TAG FX FY FZ" a line: awk -f pull.awk MATRIX.mtx DISPLACEMENTS
# Reads Matrix Market by its own rules: general or symmetric, 1-based; nodes by the comments of the file.
FNR == NR && /^%%MatrixMarket/ { symmetric = $5 == "symmetric"; next }
FNR == NR && /^% row/ { match($0, /row [0-9]+/); dofs = substr($0, RSTART + 4, RLENGTH - 4); next }
FNR == NR && /^% nodes/ { listing = 1; next }
FNR == NR && /^%/ { if (listing) for (i = 2; i <= NF; i++) tag[nodes++] = $i; next }
FNR == NR && !sized { sized = 1; entries = $3; next }
FNR == NR { row[++seen] = $1; column[seen] = $2; value[seen] = $3; next }
{ for (c = 1; c <= 3; c++) u[$1, c] = $(c + 4) }
function of(r) { return u[tag[int((r - 1) / dofs)], (r - 1) % dofs + 1] }
END {
  if (seen != entries || seen == 0) { print "the matrix has " seen " of " entries " entries" >"/dev/stderr"; exit 1 }
  for (e = 1; e <= seen; e++) {
    f[row[e]] -= value[e] * of(column[e])
    if (symmetric && row[e] != column[e]) f[column[e]] -= value[e] * of(row[e])
  }
  for (p = 0; p < nodes; p++) {
    printf "%s", tag[p]
    for (c = 1; c <= 3; c++) printf " %.17g", c <= dofs ? f[p * dofs + c] : 0
    print ""
  }
}
