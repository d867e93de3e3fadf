// Specimen 50 mm x 100 mm, free triangles of size h. Lengths in metres.
DefineConstant[ h = {0.004, Name "h"} ];
w = 0.05; l = 0.1;
Point(1) = {0, 0, 0, h}; Point(2) = {w, 0, 0, h}; Point(3) = {w, l, 0, h}; Point(4) = {0, l, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Mesh.Algorithm = 6;
Physical Surface("rock") = {1};
Physical Curve("bottom") = {1};
Physical Curve("right") = {2};
Physical Curve("top") = {3};
Physical Curve("left") = {4};
Physical Point("corner") = {1};
