DefineConstant[ n = 2 ];
Point(1) = {0, 0, 0};
Extrude {10, 0, 0} { Point{1}; Layers{n}; Recombine; }
Extrude {0, 10, 0} { Line{1}; Layers{2}; Recombine; }
Physical Surface("bar") = {5};
Physical Curve("left") = {3};
Physical Curve("right") = {4};
