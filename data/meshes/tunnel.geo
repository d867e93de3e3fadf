// The ground around a circular tunnel, 20 m x 20 m in the plane z = 0, tunnel of radius 2 m:
// second-order quadrilaterals in a ring of 1.5 m, second-order triangles outside. Lengths in metres.
Mesh.ElementOrder = 2;
Mesh.SecondOrderIncomplete = 1;  // 8 nodes a quadrilateral, not 9
r = 2; R = 3.5; b = 10;

Point(1) = {0, 0, 0};
Point(2) = {r, 0, 0}; Point(3) = {0, r, 0}; Point(4) = {-r, 0, 0}; Point(5) = {0, -r, 0};
Point(6) = {R, 0, 0}; Point(7) = {0, R, 0}; Point(8) = {-R, 0, 0}; Point(9) = {0, -R, 0};
Point(10) = {-b, -b, 0, 2.5}; Point(11) = {b, -b, 0, 2.5};
Point(12) = {b, b, 0, 2.5};   Point(13) = {-b, b, 0, 2.5};

Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2};
Circle(5) = {6, 1, 7}; Circle(6) = {7, 1, 8}; Circle(7) = {8, 1, 9}; Circle(8) = {9, 1, 6};
Line(9) = {2, 6}; Line(10) = {3, 7}; Line(11) = {4, 8}; Line(12) = {5, 9};
Line(13) = {10, 11}; Line(14) = {11, 12}; Line(15) = {12, 13}; Line(16) = {13, 10};

Curve Loop(1) = {9, 5, -10, -1};  Plane Surface(1) = {1};
Curve Loop(2) = {10, 6, -11, -2}; Plane Surface(2) = {2};
Curve Loop(3) = {11, 7, -12, -3}; Plane Surface(3) = {3};
Curve Loop(4) = {12, 8, -9, -4};  Plane Surface(4) = {4};
Curve Loop(5) = {13, 14, 15, 16}; Curve Loop(6) = {5, 6, 7, 8};
Plane Surface(5) = {5, 6};

Transfinite Curve {1:8} = 7;
Transfinite Curve {9:12} = 4 Using Progression 1.2;
Transfinite Surface {1:4};
Recombine Surface {1:4};

Physical Surface("ring") = {1, 2, 3, 4};
Physical Surface("ground") = {5};
Physical Curve("wall") = {1, 2, 3, 4};
Physical Curve("outside") = {13, 14, 15, 16};
