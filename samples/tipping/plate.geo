// A square plate of steel shells; its left edge is the hinge, its right edge is lifted. Lengths in mm.
DefineConstant[ n = {17, Name "n"} ];          // shells a side
side = 150;

Point(1) = {-side / 2, -side / 2, 0};
out[] = Extrude {0, side, 0} { Point{1}; Layers{n}; };
face[] = Extrude {side, 0, 0} { Curve{out[1]}; Layers{n}; Recombine; };
Physical Surface("plate") = {face[1]};
Physical Curve("hinge") = {out[1]};
Physical Curve("edge") = {face[0]};
