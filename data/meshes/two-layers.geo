// A slope of sand on a layer of clay, 12 m long and 4 m wide: hexahedra below, wedges above, one
// conforming mesh. Lengths in metres. Drawn in the plane y = 0 and extruded along y.
Point(1) = {0, 0, 0};  Point(2) = {12, 0, 0};
Point(3) = {12, 0, 1.5}; Point(4) = {0, 0, 2.5};  // the interface dips
Point(5) = {12, 0, 2.5}; Point(6) = {7, 0, 3};
Point(7) = {4, 0, 5};  Point(8) = {0, 0, 5};

Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(5) = {3, 5}; Line(6) = {5, 6}; Line(7) = {6, 7}; Line(8) = {7, 8}; Line(9) = {8, 4};

Curve Loop(1) = {1, 2, 3, 4};            Plane Surface(1) = {1};  // clay
Curve Loop(2) = {-3, 5, 6, 7, 8, 9};     Plane Surface(2) = {2};  // sand

Transfinite Curve {1, 3} = 17;
Transfinite Curve {2, 4} = 5;
Transfinite Surface {1};
Recombine Surface {1};
Mesh.MeshSizeMax = 0.8;

clay[] = Extrude {0, 4, 0} { Surface{1}; Layers{5}; Recombine; };
sand[] = Extrude {0, 4, 0} { Surface{2}; Layers{5}; Recombine; };

Physical Volume("clay") = {clay[1]};
Physical Volume("sand") = {sand[1]};
Physical Surface("base") = {clay[2]};
Physical Surface("slope") = {sand[5]};
