// A quarter of a cylindrical roof: radius 25, length 50, 40 degrees to each side; x across, y along, z up.
If (!Exists(n)) n = 16; EndIf         // elements a side of the quarter
If (!Exists(whole)) whole = 0; EndIf  // 1: all of the roof
If (!Exists(quadratic)) quadratic = 0; EndIf
R = 25;
a = 40 * Pi / 180;
Point(1) = {-R * Sin(whole * a), -25 * whole, R * Cos(whole * a)};
Point(2) = {R * Sin(a), -25 * whole, R * Cos(a)};
Point(3) = {0, -25 * whole, 0};
Circle(1) = {1, 3, 2};
Transfinite Curve{1} = n * (1 + whole) + 1;
out[] = Extrude {0, 25 * (1 + whole), 0} { Curve{1}; Layers{n * (1 + whole)}; Recombine; };
Physical Surface("roof") = {out[1]};
If (whole)
  Physical Curve("diaphragm") = {1, out[0]};
Else
  Physical Curve("crown") = {out[3]};
  Physical Curve("middle") = {1};
  Physical Curve("diaphragm") = {out[0]};
EndIf
If (quadratic) // mid-side nodes, for another program's elements
  Mesh.ElementOrder = 2;
  Mesh.SecondOrderIncomplete = 1;
EndIf
