// A square plate of steel shells, its mid-surface at z = 0. Lengths in mm.
DefineConstant[ n = {8, Name "n"} ];           // shells a side
DefineConstant[ side = {16, Name "side"} ];

Point(1) = {-side / 2, -side / 2, 0};
out[] = Extrude {0, side, 0} { Point{1}; Layers{n}; };
face[] = Extrude {side, 0, 0} { Curve{out[1]}; Layers{n}; Recombine; };
Physical Surface("plate") = {face[1]};
Physical Curve("rim") = {out[1], face[0], face[2], face[3]};
