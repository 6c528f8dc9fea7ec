// NAFEMS LE11: a cylinder that opens through a cone into a sphere, a quarter of it; z is its axis.
If (!Exists(n)) n = 4; EndIf // elements through the wall
a = Pi / 180;
Point(1) = {1, 0, 0};
Point(2) = {Cos(22.5 * a), 0, Sin(22.5 * a)};
Point(3) = {Cos(45 * a), 0, Sin(45 * a)};
Point(4) = {Cos(45 * a), 0, 0.5 * (Sin(45 * a) + 1.79)};
Point(5) = {Cos(45 * a), 0, 1.79};
Point(6) = {1.4, 0, 0};
Point(7) = {1.4 * Cos(30 * a), 0, 0.7};
Point(8) = {1.1062, 0, 1.045};
Point(9) = {1, 0, 1.39};
Point(10) = {1, 0, 1.79};
Point(11) = {0, 0, 0};
Circle(1) = {1, 11, 2};
Circle(2) = {2, 11, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Circle(5) = {6, 11, 7};
Line(6) = {7, 8};
Line(7) = {8, 9};
Line(8) = {9, 10};
For k In {0:4} // through the wall
  Line(11 + k) = {1 + k, 6 + k};
EndFor
Transfinite Curve{11:15} = n + 1;
Transfinite Curve{1, 5} = 2 * n + 1;
Transfinite Curve{2:4, 6:8} = n + 1;
For k In {1:4}
  Curve Loop(k) = {10 + k, 4 + k, -(11 + k), -k};
  Plane Surface(k) = {k};
  Transfinite Surface{k};
  Recombine Surface{k};
EndFor
out[] = Extrude { {0, 0, 1}, {0, 0, 0}, Pi / 2 } { Surface{1:4}; Layers{3 * n}; Recombine; };
Physical Volume("body") = {out[1], out[7], out[13], out[19]};
Physical Surface("at_y0") = {1:4};
Physical Surface("at_x0") = {out[0], out[6], out[12], out[18]};
Physical Surface("ends") = {out[2], out[22]};
