# Two tables "TAG FX FY FZ" of the same nodes: fails unless they differ by less than `bound` of the largest number.
# awk -v name=TEXT -v bound=B -f differ.awk OURS THEIRS
NF != 4 { next }
FNR == NR { for (c = 2; c <= 4; c++) ours[$1, c] = $c; nodes++; next }
{
  seen++
  for (c = 2; c <= 4; c++) {
    key = $1 SUBSEP c
    if (!(key in ours)) { print name ": row " $1 " is not ours"; failed = 1; exit }
    d = ours[key] - $c; v = ours[key]
    if (d < 0) d = -d
    if (v < 0) v = -v
    if (!(d <= worst)) worst = d
    if (v > largest) largest = v
  }
}
END {
  printf "%s: %d rows, largest number %.6e, largest difference %.2e of it (allowed %s)\n", name, seen, largest,
    (largest > 0 ? worst / largest : 1), bound
  exit !(!failed && seen == nodes && nodes > 0 && largest > 0 && worst <= bound * largest)
}
