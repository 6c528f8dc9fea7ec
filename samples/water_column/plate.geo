// A clamped plate seen from the side (plane strain). Lengths in m.

DefineConstant[ length = {1, Name "length"} ];
DefineConstant[ thickness = {0.05, Name "thickness"} ];
DefineConstant[ along = {80, Name "along"} ];      // elements
DefineConstant[ across = {8, Name "across"} ];

Point(1) = {0, -thickness, 0};
Point(2) = {length, -thickness, 0};
Point(3) = {length, 0, 0};
Point(4) = {0, 0, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 3} = along + 1;
Transfinite Curve {2, 4} = across + 1;
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("plate") = {1};
Physical Curve("clamped") = {2, 4};
