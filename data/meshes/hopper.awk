# A hopper of 40 flat sides: a cone from radius 0.25 m at z = 0.3 m down to 0.04 m at z = 0.05 m, and a spout down to z = 0.
BEGIN {
  sides = 40; pi = atan2(0, -1)
  radius[0] = 0.04; z[0] = 0; radius[1] = 0.04; z[1] = 0.05; radius[2] = 0.25; z[2] = 0.3
  print "solid hopper"
  for (ring = 0; ring < 2; ring++)
    for (k = 0; k < sides; k++) {
      triangle(ring, k, ring, k + 1, ring + 1, k + 1)
      triangle(ring, k, ring + 1, k + 1, ring + 1, k)
    }
  print "endsolid hopper"
}
function corner(ring, k) {
  printf "      vertex %.9g %.9g %.9g\n", radius[ring] * cos(2 * pi * (k % sides) / sides), radius[ring] * sin(2 * pi * (k % sides) / sides), z[ring]
}
function triangle(r1, k1, r2, k2, r3, k3) {
  print "  facet normal 0 0 0\n    outer loop"
  corner(r1, k1); corner(r2, k2); corner(r3, k3)
  print "    endloop\n  endfacet"
}
