// A block of cohesive soil, seen from the side (plane strain), that leans on the plane x = 0, and the rough ground that it
// stands on. Its other side is a slope over `run`, 0: a vertical cut. Lengths in m.

DefineConstant[ width = {4, Name "width"} ];         // at the foot
DefineConstant[ height = {2, Name "height"} ];
DefineConstant[ run = {0, Name "run"} ];             // how far the crest lies behind the foot
DefineConstant[ reach = {7, Name "reach"} ];         // of the ground
DefineConstant[ depth = {0.24, Name "depth"} ];      // of the ground: three spacings, what the kernel sees

Point(1) = {0, 0, 0};
Point(2) = {width, 0, 0};
Point(3) = {width - run, height, 0};
Point(4) = {0, height, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

Point(5) = {0, -depth, 0};
Point(6) = {reach, -depth, 0};
Point(7) = {reach, 0, 0};
Point(8) = {0, 0, 0};
Line(5) = {5, 6};  Line(6) = {6, 7};  Line(7) = {7, 8};  Line(8) = {8, 5};
Curve Loop(2) = {5, 6, 7, 8};
Plane Surface(2) = {2};

Transfinite Surface {1, 2};
Recombine Surface {1, 2};

Physical Surface("soil") = {1};
Physical Surface("ground") = {2};
