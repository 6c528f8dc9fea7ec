// A quarter of a flat plate of shells, or of an open box: walls > 0 is their height. Lengths in mm.
DefineConstant[ half = {260, Name "half"} ];      // from the axis to the edge, or to the wall
DefineConstant[ walls = {0, Name "walls"} ];
DefineConstant[ n = {8, Name "n"} ];              // shells a side

Point(1) = {0, 0, 0};
out[] = Extrude {half, 0, 0} { Point{1}; Layers{n}; };
face[] = Extrude {0, half, 0} { Curve{out[1]}; Layers{n}; Recombine; };
Physical Surface("plate") = {face[1]};
If (walls > 0)
  a[] = Extrude {0, 0, walls} { Curve{face[0]}; Layers{n}; Recombine; };
  b[] = Extrude {0, 0, walls} { Curve{face[2]}; Layers{n}; Recombine; };
  Physical Surface("walls") = {a[1], b[1]};
EndIf
