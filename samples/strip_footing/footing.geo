// Half of a strip of soil, 10 x 5, under a footing of half width 1 (symmetry at x = 0). Quadrilaterals, finer towards the
// footing's edge. Lengths in m.
If (!Exists(n)) n = 8; EndIf // elements under half the footing
w = 1; l = 10; h = 5;
Point(1) = {0, 0, 0};
Point(2) = {w, 0, 0};
Point(3) = {l, 0, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Transfinite Curve{1} = n + 1 Using Progression 1 / 1.1^(8 / n);
Transfinite Curve{2} = 2 * n + 1 Using Progression 1.16^(8 / n);
bed[] = Extrude {0, -h, 0} { Curve{1, 2}; Layers{ {n, n, n}, {0.15, 0.45, 1} }; Recombine; };
Physical Surface("soil") = {bed[1], bed[5]};
Physical Curve("footing") = {1};
Physical Curve("middle") = {bed[3]};
Physical Curve("side") = {bed[6]};
Physical Curve("base") = {bed[0], bed[4]};
If (!Exists(quadratic)) quadratic = 0; EndIf
If (quadratic) // eight nodes
  Mesh.ElementOrder = 2;
  Mesh.SecondOrderIncomplete = 1;
EndIf
