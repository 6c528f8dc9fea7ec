// A quarter of a cylindrical roof: radius 25, length 50, 40 degrees to each side; x across, y along, z up.
If (!Exists(n)) n = 16; EndIf // elements a side
R = 25;
a = 40 * Pi / 180;
Point(1) = {0, 0, R};
Point(2) = {R * Sin(a), 0, R * Cos(a)};
Point(3) = {0, 0, 0};
Circle(1) = {1, 3, 2};
Transfinite Curve{1} = n + 1;
out[] = Extrude {0, 25, 0} { Curve{1}; Layers{n}; Recombine; };
Physical Surface("roof") = {out[1]};
Physical Curve("crown") = {out[3]};
Physical Curve("middle") = {1};
Physical Curve("diaphragm") = {out[0]};
