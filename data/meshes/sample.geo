// Makes sample.step: `gmsh -0 sample.geo -o sample.step` (lengths in millimetres, STEP's custom).
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 100, 100, 40};
Cylinder(2) = {50, 50, -1, 0, 0, 42, 20};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
