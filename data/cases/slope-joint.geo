// Rock slope, 10 m high, face at 60 degrees, with a joint that daylights 1 m above the toe and dips out of the slope
// at 35 degrees; free triangles of size h. Lengths in metres.
DefineConstant[ h = {1, Name "h"} ];
t = Tan(60*Pi/180); j = Tan(35*Pi/180); H = 10;
dx = 1/t; dy = 1;               // where the joint meets the face, from the toe
ex = dx + (H - dy)/j;           // and the crest
Point(1) = {-8, -6, 0, 2*h}; Point(2) = {26, -6, 0, 2*h}; Point(3) = {26, H, 0, 2*h};
Point(4) = {ex, H, 0, h}; Point(5) = {H/t, H, 0, h}; Point(6) = {dx, dy, 0, h/2}; Point(7) = {0, 0, 0, h}; Point(8) = {-8, 0, 0, 2*h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 7};
Line(7) = {7, 8}; Line(8) = {8, 1}; Line(9) = {6, 4};
Curve Loop(1) = {1, 2, 3, -9, 6, 7, 8}; Plane Surface(1) = {1};
Curve Loop(2) = {9, 4, 5}; Plane Surface(2) = {2};
Mesh.Algorithm = 6;
Physical Surface("ground") = {1};
Physical Surface("wedge") = {2};
Physical Curve("joint") = {9};
Physical Curve("base") = {1};
Physical Curve("sides") = {2, 8};
Physical Curve("surface") = {3, 4, 5, 6, 7};
Physical Point("crest") = {5};
