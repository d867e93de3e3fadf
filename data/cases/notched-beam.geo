// Beam 0.45 m x 0.1 m on supports 0.4 m apart with a notch of half its depth in the middle: quadrilaterals, n along
// the ligament, graded away from it. Notch and ligament are lines, to be cut. Lengths in metres.
DefineConstant[ n = {20, Name "n"} ];
l = 0.225; s = 0.2; d = 0.1; a = 0.05; q = 0.01; // half length, half span, depth, notch, width of the inner columns
h = (d - a)/n;
Point(1) = {0, 0, 0}; Point(2) = {0, a, 0}; Point(3) = {0, d, 0};
xs() = {q, s, l};
For side In {0:1}
  g = 2*side - 1; o = 100*(side + 1);
  For i In {0:2}
    x = xs[i];
    Point(o + 3*i + 1) = {g*x, 0, 0}; Point(o + 3*i + 2) = {g*x, a, 0}; Point(o + 3*i + 3) = {g*x, d, 0};
  EndFor
EndFor
Line(1) = {1, 2}; Line(2) = {2, 3};
nq = Ceil(q/h); nl = Ceil((l - s)/(4*h));
ns = Ceil((s - q)/(2.6*h));
For side In {0:1}
  o = 100*(side + 1);
  For row In {0:2} // along x: bottom, tip of the notch, top
    Line(o + 10*row + 1) = {1 + row, o + 1 + row};
    Line(o + 10*row + 2) = {o + 1 + row, o + 4 + row};
    Line(o + 10*row + 3) = {o + 4 + row, o + 7 + row};
    Transfinite Curve {o + 10*row + 1} = nq + 1;
    Transfinite Curve {o + 10*row + 2} = ns + 1 Using Progression 4^(1/(ns - 1));
    Transfinite Curve {o + 10*row + 3} = nl + 1;
  EndFor
  For i In {0:2} // along y
    Line(o + 40 + i) = {o + 3*i + 1, o + 3*i + 2};
    Line(o + 50 + i) = {o + 3*i + 2, o + 3*i + 3};
    Transfinite Curve {o + 40 + i, o + 50 + i} = n + 1;
  EndFor
  For row In {0:1}
    below = o + 10*row; above = below + 10;
    Curve Loop(below + 1) = {below + 1, o + 40 + 10*row, -(above + 1), -(1 + row)};
    Curve Loop(below + 2) = {below + 2, o + 41 + 10*row, -(above + 2), -(o + 40 + 10*row)};
    Curve Loop(below + 3) = {below + 3, o + 42 + 10*row, -(above + 3), -(o + 41 + 10*row)};
    For i In {1:3}
      Plane Surface(below + i) = {below + i};
      If (side == 0)
        ReverseMesh Surface{below + i};
      EndIf
      Transfinite Surface {below + i};
      Recombine Surface {below + i};
    EndFor
  EndFor
EndFor
Transfinite Curve {1, 2} = n + 1;
Physical Surface("beam") = {101, 102, 103, 111, 112, 113, 201, 202, 203, 211, 212, 213};
Physical Curve("notch") = {1};
Physical Curve("ligament") = {2};
Physical Point("load") = {3};
Physical Point("left support") = {104};
Physical Point("right support") = {204};
Physical Point("mouth") = {1};
