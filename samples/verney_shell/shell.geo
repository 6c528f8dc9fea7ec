// A quarter of a round shell, seen along its axis (plane strain). Lengths in mm.

DefineConstant[ inner = {80, Name "inner"} ];
DefineConstant[ outer = {100, Name "outer"} ];
DefineConstant[ facets = {120, Name "facets"} ];   // of each arc

Point(1) = {0, 0, 0};
Point(2) = {inner, 0, 0};
Point(3) = {outer, 0, 0};
Point(4) = {0, outer, 0};
Point(5) = {0, inner, 0};
Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 2};
Transfinite Curve {1, 3} = 5;
Transfinite Curve {2, 4} = facets + 1;
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("shell") = {1};
