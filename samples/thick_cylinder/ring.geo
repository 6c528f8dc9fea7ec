// A quarter of a thick ring in its plane: bore 100, outside 200.
If (!Exists(n)) n = 16; EndIf // elements through the wall
Point(1) = {0, 0, 0};
Point(2) = {100, 0, 0};
Point(3) = {200, 0, 0};
Line(1) = {2, 3};
Transfinite Curve{1} = n + 1;
out[] = Extrude { {0, 0, 1}, {0, 0, 0}, Pi / 2 } { Curve{1}; Layers{n}; Recombine; };
Physical Surface("ring") = {out[1]};
Physical Curve("at_y0") = {1};
Physical Curve("at_x0") = {out[0]};
Physical Curve("bore") = {out[3]};
