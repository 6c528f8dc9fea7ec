// A column of water held by a wall and a dam, seen from the side (plane strain), in its tank. Lengths in m.

DefineConstant[ width = {1, Name "width"} ];
DefineConstant[ height = {2, Name "height"} ];
DefineConstant[ reach = {6, Name "reach"} ];        // of the tank's floor
DefineConstant[ depth = {0.075, Name "depth"} ];    // of the tank's floor and wall: three spacings

Point(1) = {0, 0, 0};
Point(2) = {width, 0, 0};
Point(3) = {width, height, 0};
Point(4) = {0, height, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

// Points of its own: two bodies, not one.
Point(5) = {0, -depth, 0};
Point(6) = {reach, -depth, 0};
Point(7) = {reach, 0, 0};
Point(8) = {0, 0, 0};
Line(5) = {5, 6};  Line(6) = {6, 7};  Line(7) = {7, 8};  Line(8) = {8, 5};
Curve Loop(2) = {5, 6, 7, 8};
Plane Surface(2) = {2};

Transfinite Surface {1, 2};
Recombine Surface {1, 2};

Physical Surface("water") = {1};
Physical Surface("tank") = {2};
