// A plate of 2 m x 1 m in the plane z = 0: quadrilaterals on the left half, triangles on the right,
// joined along the line x = 1. Lengths in metres.
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {2, 0, 0};
Point(4) = {2, 1, 0}; Point(5) = {1, 1, 0}; Point(6) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5};
Line(5) = {5, 6}; Line(6) = {6, 1}; Line(7) = {2, 5};

Curve Loop(1) = {1, 7, 5, 6};  Plane Surface(1) = {1};
Curve Loop(2) = {2, 3, 4, -7}; Plane Surface(2) = {2};

Transfinite Curve {1, 5} = 9 Using Progression 1.1;  // 8 unequal steps: no two columns alike
Transfinite Curve {6, 7} = 9;
Transfinite Surface {1};
Recombine Surface {1};
Mesh.MeshSizeMax = 0.125;

Physical Surface("left half") = {1};
Physical Surface("right half") = {2};
Physical Curve("clamped") = {6};
Physical Curve("loaded") = {3};
