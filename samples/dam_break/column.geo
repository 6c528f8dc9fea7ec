// A column of water held by a wall and a dam, seen from the side (plane strain). Lengths in m.
DefineConstant[ width = {1, Name "width"} ];
DefineConstant[ height = {2, Name "height"} ];
Point(1) = {0, 0, 0};
Point(2) = {width, 0, 0};
Point(3) = {width, height, 0};
Point(4) = {0, height, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("water") = {1};
