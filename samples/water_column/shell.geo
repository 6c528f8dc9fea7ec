// A strip of the clamped plate: its mid-surface, half its thickness below the water. Lengths in m.

DefineConstant[ length = {1, Name "length"} ];
DefineConstant[ width = {0.4, Name "width"} ];
DefineConstant[ thickness = {0.05, Name "thickness"} ];
DefineConstant[ along = {80, Name "along"} ];      // elements

Point(1) = {0, 0, -thickness / 2};
Point(2) = {length, 0, -thickness / 2};
Point(3) = {length, width, -thickness / 2};
Point(4) = {0, width, -thickness / 2};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 3} = along + 1;
Transfinite Curve {2, 4} = 2;
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("plate") = {1};
Physical Curve("clamped") = {2, 4};
Physical Curve("sides") = {1, 3};
