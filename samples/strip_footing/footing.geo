// Half of a strip of soil, 5 x 5, under a footing of half width 1 (symmetry at x = 0). Quadrilaterals of eight nodes, of four with
// linear = 1, that grow by a quarter from one to the next away from the footing's edge: there it is decided. Lengths in m.
If (!Exists(n)) n = 6; EndIf // elements under half the footing
If (!Exists(linear)) linear = 0; EndIf
grow = 1.25^(6 / n);
out = Round(7 * n / 3);
Point(1) = {0, -5, 0};
Point(2) = {1, -5, 0};
Point(3) = {5, -5, 0};
Point(4) = {0, 0, 0};
Point(5) = {1, 0, 0};
Point(6) = {5, 0, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {4, 5};
Line(4) = {5, 6};
Line(5) = {1, 4};
Line(6) = {2, 5};
Line(7) = {3, 6};
Transfinite Curve{1, 3} = n + 1 Using Progression 1 / grow;
Transfinite Curve{2, 4} = out + 1 Using Progression grow;
Transfinite Curve{5, 6, 7} = Round(8 * n / 3) + 1 Using Progression 1 / grow;
Curve Loop(1) = {1, 6, -3, -5};
Curve Loop(2) = {2, 7, -4, -6};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Transfinite Surface{1, 2};
Recombine Surface{1, 2};
Physical Surface("soil") = {1, 2};
Physical Curve("footing") = {3};
Physical Curve("middle") = {5};
Physical Curve("side") = {7};
Physical Curve("base") = {1, 2};
If (!linear)
  Mesh.ElementOrder = 2;
  Mesh.SecondOrderIncomplete = 1;
EndIf
