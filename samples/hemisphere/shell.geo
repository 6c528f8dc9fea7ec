// A quarter of a hemisphere with a hole of 18 degrees: radius 10, z up.
If (!Exists(n)) n = 16; EndIf // elements a side
R = 10;
b = 72 * Pi / 180;
Point(1) = {0, 0, 0};
Point(2) = {R, 0, 0};
Point(3) = {R * Cos(b), 0, R * Sin(b)};
Circle(1) = {2, 1, 3};
Transfinite Curve{1} = n + 1;
out[] = Extrude { {0, 0, 1}, {0, 0, 0}, Pi / 2 } { Curve{1}; Layers{n}; Recombine; };
Physical Surface("shell") = {out[1]};
Physical Curve("at_y0") = {1};
Physical Curve("at_x0") = {out[0]};
Physical Point("A") = {2};
Physical Point("B") = {4};
