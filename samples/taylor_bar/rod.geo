// A quarter of a round rod along z, its foot at z = 0. Lengths in mm.

DefineConstant[ radius = {3.2, Name "radius"} ];
DefineConstant[ length = {32.4, Name "length"} ];
DefineConstant[ facets = {32, Name "facets"} ];    // of the quarter's arc: they miss 0.04 % of the volume

Point(1) = {0, 0, 0};
Point(2) = {radius, 0, 0};
Point(3) = {0, radius, 0};
Line(1) = {1, 2};
Circle(2) = {2, 1, 3};
Line(3) = {3, 1};
Transfinite Curve {1, 3} = 9;
Transfinite Curve {2} = facets + 1;
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};
rod[] = Extrude {0, 0, length} { Surface{1}; Layers{1}; };
Physical Volume("rod") = {rod[1]};
