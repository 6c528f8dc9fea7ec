// A bar of 100 x 10 x 10 along x, of hexahedra.
If (!Exists(n)) n = 6; EndIf // elements over the height; five times as many along it
Point(1) = {0, 0, 0};
Point(2) = {0, 10, 0};
Line(1) = {1, 2};
Transfinite Curve{1} = n + 1;
side[] = Extrude {0, 0, 10} { Curve{1}; Layers{n}; Recombine; };
out[] = Extrude {100, 0, 0} { Surface{side[1]}; Layers{5 * n}; Recombine; };
Physical Volume("bar") = {out[1]};
Physical Surface("root") = {side[1]};
Physical Surface("tip") = {out[0]};
Physical Curve("edge") = {1};       // for a bar that is pulled: nothing turns
Physical Point("corner") = {1};
If (!Exists(quadratic)) quadratic = 0; EndIf
If (quadratic) // mid-side nodes, for another program's elements
  Mesh.ElementOrder = 2;
  Mesh.SecondOrderIncomplete = 1;
EndIf
