// The water above it: 1 m wide, 2 m high. Lengths in m.

DefineConstant[ length = {1, Name "length"} ];
DefineConstant[ height = {2, Name "height"} ];

Point(1) = {0, 0, 0};
Point(2) = {length, 0, 0};
Point(3) = {length, height, 0};
Point(4) = {0, height, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("water") = {1};
