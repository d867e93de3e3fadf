// Disc of diameter D = 0.1 m with two loading strips of `strip` degrees each (the arc they cover), free triangles
// of size h; the loaded diameter is a line of faces. Lengths in metres.
DefineConstant[ h = {0.004, Name "h"}, strip = {20, Name "strip"} ];
r = 0.05; a = strip*Pi/360;
Point(1) = {0, 0, 0, h};
Point(2) = {r*Sin(a), -r*Cos(a), 0, h}; Point(3) = {r, 0, 0, h}; Point(4) = {r*Sin(a), r*Cos(a), 0, h};
Point(5) = {-r*Sin(a), r*Cos(a), 0, h}; Point(6) = {-r, 0, 0, h}; Point(7) = {-r*Sin(a), -r*Cos(a), 0, h};
Point(8) = {0, r, 0, h}; Point(9) = {0, -r, 0, h};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 8}; Circle(4) = {8, 1, 5};
Circle(5) = {5, 1, 6}; Circle(6) = {6, 1, 7}; Circle(7) = {7, 1, 9}; Circle(8) = {9, 1, 2};
Line(9) = {9, 1}; Line(10) = {1, 8};
Curve Loop(1) = {8, 1, 2, 3, -10, -9}; Plane Surface(1) = {1};
Curve Loop(2) = {4, 5, 6, 7, 9, 10}; Plane Surface(2) = {2};
Mesh.Algorithm = 6;
Physical Surface("rock") = {1, 2};
Physical Curve("top") = {3, 4};
Physical Curve("bottom") = {7, 8};
Physical Curve("diameter") = {9, 10};
Physical Point("center") = {1};
Physical Point("lowest") = {9};
