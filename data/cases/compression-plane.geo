// Specimen 50 mm x 100 mm, triangles in a union-jack pattern of n columns: at 3 n/2 rows the diagonals rise by
// 4 in 3, 53.13 degrees, so that straight faces run from side to side in both directions within 0.3 degrees
// of the plane of least strength, 45 + phi/2 = 53.35 degrees at tan phi = 0.3. n is even. Lengths in metres.
DefineConstant[ n = {8, Name "n"} ];
w = 0.05; l = 0.1;
Point(1) = {0, 0, 0}; Point(2) = {w, 0, 0}; Point(3) = {w, l, 0}; Point(4) = {0, l, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1;
Transfinite Curve {2, 4} = 3*n/2 + 1;
Transfinite Surface {1} Alternate;
Physical Surface("rock") = {1};
Physical Curve("bottom") = {1};
Physical Curve("right") = {2};
Physical Curve("top") = {3};
Physical Curve("left") = {4};
Physical Point("corner") = {1};
