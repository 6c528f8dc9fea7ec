// A quarter of a square plate, side 1000, its middle at the origin; four-node elements, or triangles.
If (!Exists(n)) n = 16; EndIf // elements a side of the quarter
If (!Exists(triangles)) triangles = 0; EndIf
If (!Exists(quadratic)) quadratic = 0; EndIf
a = 500;
Point(1) = {0, 0, 0};
Point(2) = {a, 0, 0};
Line(1) = {1, 2};
Transfinite Curve{1} = n + 1;
If (triangles)
  out[] = Extrude {0, a, 0} { Curve{1}; Layers{n}; };
Else
  out[] = Extrude {0, a, 0} { Curve{1}; Layers{n}; Recombine; };
EndIf
Physical Surface("plate") = {out[1]};
Physical Curve("side_x") = {out[2]};
Physical Curve("side_y") = {out[0]};
Physical Curve("at_x0") = {out[3]};
Physical Curve("at_y0") = {1};
If (quadratic) // mid-side nodes, for another program's elements
  Mesh.ElementOrder = 2;
  Mesh.SecondOrderIncomplete = 1;
EndIf
