// A block of rock, 100 mm x 100 mm x 40 mm, with a round hole through it, all hexahedra.
// Lengths in metres. The hole is off the middle and the rings grow outwards, so that no two
// elements of a layer are congruent. 3072 elements.
a = 0.100;  // side
h = 0.040;  // height
r = 0.015;  // radius of the hole
cx = 0.045; cy = 0.055;  // its centre
around = 12; rings = 8; layers = 8;

Point(1) = {0, 0, 0}; Point(2) = {a, 0, 0}; Point(3) = {a, a, 0}; Point(4) = {0, a, 0};
Point(5) = {cx, cy, 0};
d = r / Sqrt(2);
Point(6) = {cx - d, cy - d, 0}; Point(7) = {cx + d, cy - d, 0};
Point(8) = {cx + d, cy + d, 0}; Point(9) = {cx - d, cy + d, 0};

Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Circle(5) = {6, 5, 7}; Circle(6) = {7, 5, 8}; Circle(7) = {8, 5, 9}; Circle(8) = {9, 5, 6};
Line(9) = {6, 1}; Line(10) = {7, 2}; Line(11) = {8, 3}; Line(12) = {9, 4};

Curve Loop(1) = {1, -10, -5, 9};  Plane Surface(1) = {1};
Curve Loop(2) = {2, -11, -6, 10}; Plane Surface(2) = {2};
Curve Loop(3) = {3, -12, -7, 11}; Plane Surface(3) = {3};
Curve Loop(4) = {4, -9, -8, 12};  Plane Surface(4) = {4};

Transfinite Curve {1:8} = around + 1;
Transfinite Curve {9:12} = rings + 1 Using Progression 1.25;
Transfinite Surface {1:4};
Recombine Surface {1:4};

// Each volume: out[0] the far side, out[1] the volume, out[2...] the sides in the order of the loop.
s1[] = Extrude {0, 0, h} { Surface{1}; Layers{layers}; Recombine; };
s2[] = Extrude {0, 0, h} { Surface{2}; Layers{layers}; Recombine; };
s3[] = Extrude {0, 0, h} { Surface{3}; Layers{layers}; Recombine; };
s4[] = Extrude {0, 0, h} { Surface{4}; Layers{layers}; Recombine; };

Physical Volume("rock") = {s1[1], s2[1], s3[1], s4[1]};
Physical Surface("hole") = {s1[4], s2[4], s3[4], s4[4]};
Physical Surface("left") = {s4[2]};
Physical Surface("right") = {s2[2]};
Physical Surface("front") = {s1[2]};
Physical Surface("back") = {s3[2]};
Physical Surface("bottom") = {1, 2, 3, 4};
Physical Surface("top") = {s1[0], s2[0], s3[0], s4[0]};
