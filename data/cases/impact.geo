// Two bars, 1 m and 2 m long, 0.25 m high, end to end along x with a gap; n quadrilaterals a metre (n a multiple of 4).
// Lengths in metres.
DefineConstant[ n = {40, Name "n"}, gap = {1e-5, Name "gap"} ];
hh = 0.25;
Point(1) = {-1 - gap, 0, 0}; Point(2) = {-gap, 0, 0}; Point(3) = {-gap, hh, 0}; Point(4) = {-1 - gap, hh, 0};
Point(5) = {0, 0, 0}; Point(6) = {2, 0, 0}; Point(7) = {2, hh, 0}; Point(8) = {0, hh, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Curve Loop(2) = {5, 6, 7, 8}; Plane Surface(2) = {2};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {5, 7} = 2*n + 1; Transfinite Curve {2, 4, 6, 8} = n/4 + 1;
Transfinite Surface {1, 2}; Recombine Surface {1, 2};
Physical Surface("striker") = {1};
Physical Surface("struck") = {2};
Physical Curve("front") = {2};
