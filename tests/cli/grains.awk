# A table of two materials from one of `cdem pack`: every third grain is clay, each seventh is driven, all move and spin
# up to `speed` (m/s) and `spin` (rad/s). awk -v speed=V -v spin=W -f grains.awk TABLE
BEGIN { FS = OFS = ","; srand(3) }
NR == 1 { solid = /z \[m\]/; print $0, "material,motion,vx [m/s],vy [m/s]" (solid ? ",vz [m/s],wx [rad/s],wy [rad/s]" : "") ",wz [rad/s]"; next }
{
  line = $0 "," (NR % 3 ? "sand" : "clay") "," (NR % 7 ? "free" : "driven")
  for (c = 1; c <= (solid ? 3 : 2); c++) line = line sprintf(",%.17g", speed * (2 * rand() - 1))
  for (c = 1; c <= (solid ? 3 : 1); c++) line = line sprintf(",%.17g", spin * (2 * rand() - 1))
  print line
}
