// A square plate of shells, clamped at its rim. Lengths in mm.
DefineConstant[ n = {10, Name "n"} ];          // shells a side
side = 20;

Point(1) = {0, 0, 0};
out[] = Extrude {0, side, 0} { Point{1}; Layers{n}; };
face[] = Extrude {side, 0, 0} { Curve{out[1]}; Layers{n}; Recombine; };
Physical Surface("plate") = {face[1]};
Physical Curve("rim") = {out[1], face[0], face[2], face[3]};
