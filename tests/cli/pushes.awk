# "ID MASS FX FY FZ" of every grain of a table by the linear law alone: push = max(0, k overlap + c approach), c =
# z sqrt(m k), and the weight. awk -v k=K,K,K -v z=Z -v rho=SAND,CLAY -v thickness=T -v g=GX,GY,GZ -f pushes.awk TABLE
# k: of sand-sand, sand-clay, clay-clay.
BEGIN { FS = ","; split(k, stiff, ","); split(rho, density, ","); split(g, weight, ","); pi = atan2(0, -1) }
NR == 1 { for (c = 1; c <= NF; c++) { name = $c; sub(/ .*/, "", name); at[name] = c }; dim = "z" in at ? 3 : 2; next }
{
  n++
  split("x y z", way, " ")
  for (c = 1; c <= dim; c++) { x[n, c] = $at[way[c]]; v[n, c] = $at["v" way[c]] }
  r[n] = $at["radius"]
  kind[n] = $at["material"] == "clay"
  m[n] = density[kind[n] + 1] * (dim == 2 ? pi * r[n] ^ 2 * thickness : 4 / 3 * pi * r[n] ^ 3)
  driven[n] = $at["motion"] == "driven"
}
END {
  for (i = 1; i <= n; i++) for (j = i + 1; j <= n; j++) {
    l = 0
    for (c = 1; c <= dim; c++) l += (x[j, c] - x[i, c]) ^ 2
    if (l >= (r[i] + r[j]) ^ 2) continue
    l = sqrt(l)
    stiffness = stiff[kind[i] + kind[j] + 1]
    approach = 0
    for (c = 1; c <= dim; c++) approach -= (v[j, c] - v[i, c]) * (x[j, c] - x[i, c]) / l
    push = stiffness * (r[i] + r[j] - l) + z * sqrt(m[i] * m[j] / (m[i] + m[j]) * stiffness) * approach
    if (push < 0) push = 0
    for (c = 1; c <= dim; c++) { f[i, c] -= push * (x[j, c] - x[i, c]) / l; f[j, c] += push * (x[j, c] - x[i, c]) / l }
  }
  for (i = 1; i <= n; i++) {
    printf "%d", i
    for (c = 1; c <= 3; c++) printf " %.17g", f[i, c] + (driven[i] ? 0 : m[i] * weight[c])
    printf " %.17g\n", m[i]
  }
}
