// A quarter of a hopper wagon, of shells; x = 0 and y = 0 are planes of symmetry. Lengths in mm.
// The body's walls are upright, the hopper leads to a door: its end slope and the ledge along the side rise by `slope`.
DefineConstant[
  size = {120, Name "size"},          // of a shell: 15.2 makes about 40 000
  slope = {0.58, Name "slope"}        // 30 degrees: between the two pairs of friction
];
long = 2400; wide = 1200; top = 2600;
mouth = 600; half = 450; ledge = 900; // the door's ends, and where the ledge begins
foot = slope * (long - mouth);        // top of the hopper
shelf = foot + slope * (wide - ledge);

Point(1) = {0, half, 0};        Point(2) = {mouth, half, 0};     Point(3) = {mouth, 0, 0};
Point(4) = {0, ledge, foot};    Point(5) = {long, ledge, foot};  Point(6) = {long, 0, foot};
Point(7) = {0, wide, shelf};    Point(8) = {long, wide, shelf};
Point(9) = {0, wide, top};      Point(10) = {long, wide, top};   Point(11) = {long, 0, top};
Line(1) = {1, 2};   Line(2) = {2, 3};   Line(3) = {4, 5};   Line(4) = {5, 6};   Line(5) = {7, 8};
Line(6) = {9, 10};  Line(7) = {10, 11}; Line(8) = {1, 4};   Line(9) = {2, 5};   Line(10) = {3, 6};
Line(11) = {4, 7};  Line(12) = {5, 8};  Line(13) = {7, 9};  Line(14) = {8, 10}; Line(15) = {6, 11};
Curve Loop(1) = {1, 9, -3, -8};         Plane Surface(1) = {1};   // side of the hopper
Curve Loop(2) = {2, 10, -4, -9};        Plane Surface(2) = {2};   // its end slope
Curve Loop(3) = {3, 12, -5, -11};       Plane Surface(3) = {3};   // ledge
Curve Loop(4) = {5, 14, -6, -13};       Plane Surface(4) = {4};   // side wall
Curve Loop(5) = {4, 15, -7, -14, -12};  Plane Surface(5) = {5};   // end wall

// The door has nodes of its own: it goes its way.
Point(21) = {0, 0, 0};  Point(22) = {mouth, 0, 0};  Point(23) = {mouth, half, 0};  Point(24) = {0, half, 0};
Line(21) = {21, 22};  Line(22) = {22, 23};  Line(23) = {23, 24};  Line(24) = {24, 21};
Curve Loop(6) = {21, 22, 23, 24};       Plane Surface(6) = {6};

Mesh.MeshSizeMin = size;  Mesh.MeshSizeMax = size;
Recombine Surface {1:6};
Physical Surface("body") = {1, 2, 3, 4, 5};
Physical Surface("door") = {6};
Physical Curve("frame") = {1, 2, 3, 4, 5, 6, 7};  // beams run along the door, the foot of the walls, the ledge and the rim
Physical Curve("middle_x") = {8, 11, 13};  // on x = 0
Physical Curve("middle_y") = {10, 15};     // on y = 0
