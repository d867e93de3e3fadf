// A quarter of a plate with a round hole, radius a = 1 m, out to a circle of radius b = 4 m, in the plane z = 0.
// 2 n rings of quadrilaterals, graded so that they stay about square; n a 45 degree sector.
// Kirsch's exact tractions act on the circle, so that b is no approximation. Lengths in metres.
DefineConstant[ n = {16, Name "n"} ];
a = 1; b = 4; c = Cos(Pi/4);
Point(1) = {0, 0, 0};
Point(2) = {a, 0, 0}; Point(3) = {a*c, a*c, 0}; Point(4) = {0, a, 0};
Point(5) = {b, 0, 0}; Point(6) = {b*c, b*c, 0}; Point(7) = {0, b, 0};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4};
Circle(3) = {5, 1, 6}; Circle(4) = {6, 1, 7};
Line(5) = {2, 5}; Line(6) = {3, 6}; Line(7) = {4, 7};
Curve Loop(1) = {5, 3, -6, -1}; Plane Surface(1) = {1};
Curve Loop(2) = {6, 4, -7, -2}; Plane Surface(2) = {2};
Transfinite Curve {1:4} = n + 1;
Transfinite Curve {5:7} = 2*n + 1 Using Progression (b/a)^(1/(2*n - 1));
Transfinite Surface {1, 2};
Recombine Surface {1, 2};
Physical Surface("plate") = {1, 2};
Physical Curve("hole") = {1, 2};
Physical Curve("outer") = {3, 4};
Physical Curve("x axis") = {5};
Physical Curve("y axis") = {7};
Physical Point("crown") = {4};
