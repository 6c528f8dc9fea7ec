// A plate seen from the side (plane strain): its free length from x = 0 on, and what is held by the clamp. Lengths in m.

DefineConstant[ length = {0.2, Name "length"} ];
DefineConstant[ height = {0.02, Name "height"} ];
DefineConstant[ clamp = {0.02, Name "clamp"} ];    // length that is held, a multiple of the spacing

Point(1) = {-clamp, -height / 2, 0};
Point(2) = {length, -height / 2, 0};
Point(3) = {length, height / 2, 0};
Point(4) = {-clamp, height / 2, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("plate") = {1};
