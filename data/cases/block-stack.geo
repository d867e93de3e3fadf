// A tower of four bricks, 0.1 x 0.15 x 0.1 m, on a floor. Bricks touch but share no node; n cells along each of their
// edges. Lengths in metres.
DefineConstant[ n = {1, Name "n"} ];
Geometry.AutoCoherence = 0;
Macro Brick
  p = newp; Point(p) = {x, y, z}; Point(p + 1) = {x + dx, y, z}; Point(p + 2) = {x + dx, y + dy, z}; Point(p + 3) = {x, y + dy, z};
  c = newl; Line(c) = {p, p + 1}; Line(c + 1) = {p + 1, p + 2}; Line(c + 2) = {p + 2, p + 3}; Line(c + 3) = {p + 3, p};
  k = newll; Curve Loop(k) = {c, c + 1, c + 2, c + 3};
  s = news; Plane Surface(s) = {k};
  Transfinite Curve {c, c + 2} = mx + 1; Transfinite Curve {c + 1, c + 3} = my + 1;
  Transfinite Surface {s}; Recombine Surface {s};
  e[] = Extrude {0, 0, dz} { Surface{s}; Layers{mz}; Recombine; };
Return
bricks[] = {};
For i In {0:3}
  x = 0; y = 0; z = 0.1*i; dx = 0.1; dy = 0.15; dz = 0.1; mx = n; my = n; mz = n;
  Call Brick;
  bricks[] += {e[1]};
EndFor
x = -0.4; y = -0.3; z = -0.1; dx = 1.6; dy = 0.75; dz = 0.1; mx = 1; my = 1; mz = 1;
Call Brick;
Physical Volume("floor") = {e[1]};
Physical Surface("bottom") = {s};
Physical Volume("top") = {bricks[3]};
Physical Volume("lower") = {bricks[0], bricks[1], bricks[2]};
