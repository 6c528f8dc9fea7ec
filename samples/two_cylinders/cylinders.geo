// Two cylinders lying end to end along x, each seen as the rectangle that a cut along its axis shows (plane strain).
// Their faces touch (gap 0): the nearest particles of the two, each half a spacing inside its face, are then exactly one
// spacing apart and the contact starts with the run. Lengths in cm.
// Slender variants: numbers.length=6 in the scene or by --set; on gmsh's own command line -setnumber length 6.

DefineConstant[ length = {3, Name "length"} ];     // of each cylinder
DefineConstant[ radius = {0.5, Name "radius"} ];
DefineConstant[ gap = {0, Name "gap"} ];           // between the faces
size = radius / 2;
face = gap / 2;

Point(1) = {-face - length, -radius, 0};
Point(2) = {-face, -radius, 0};
Point(3) = {-face, radius, 0};
Point(4) = {-face - length, radius, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

// Points of its own on the face: two bodies, not one.
Point(5) = {face, -radius, 0};
Point(6) = {face + length, -radius, 0};
Point(7) = {face + length, radius, 0};
Point(8) = {face, radius, 0};
Line(5) = {5, 6};  Line(6) = {6, 7};  Line(7) = {7, 8};  Line(8) = {8, 5};
Curve Loop(2) = {5, 6, 7, 8};
Plane Surface(2) = {2};

Transfinite Curve {1, 3, 5, 7} = Ceil(length / size) + 1;
Transfinite Curve {2, 4, 6, 8} = Ceil(2 * radius / size) + 1;
Transfinite Surface {1, 2};
Recombine Surface {1, 2};

Physical Surface("left") = {1};
Physical Surface("right") = {2};
