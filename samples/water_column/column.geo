// The water above the strip. Lengths in m.

DefineConstant[ length = {1, Name "length"} ];
DefineConstant[ width = {0.4, Name "width"} ];
DefineConstant[ height = {2, Name "height"} ];

Point(1) = {0, 0, 0};
Point(2) = {length, 0, 0};
Point(3) = {length, width, 0};
Point(4) = {0, width, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Surface {1};
Recombine Surface {1};
out[] = Extrude {0, 0, height} { Surface{1}; Layers{20}; Recombine; };
Physical Volume("water") = {out[1]};
