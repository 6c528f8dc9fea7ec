// A quarter of a silo whose floor may sink between walls that reach below it, 64 x 64 mm between its faces. Lengths in mm.
DefineConstant[ half = {32.5, Name "half"} ];     // to the mid-surfaces of the walls
DefineConstant[ height = {278, Name "height"} ];
DefineConstant[ n = {4, Name "n"} ];              // shells over half a side
DefineConstant[ m = {18, Name "m"} ];             // and over the height

Point(1) = {0, 0, 0};
out[] = Extrude {half, 0, 0} { Point{1}; Layers{n}; };
face[] = Extrude {0, half, 0} { Curve{out[1]}; Layers{n}; Recombine; };
Point(101) = {0, half, -10};
edge[] = Extrude {half, 0, 0} { Point{101}; Layers{n}; };
a[] = Extrude {0, 0, height + 10} { Curve{edge[1]}; Layers{m}; Recombine; };
Point(201) = {half, 0, -10};
side[] = Extrude {0, half, 0} { Point{201}; Layers{n}; };
b[] = Extrude {0, 0, height + 10} { Curve{side[1]}; Layers{m}; Recombine; };
Physical Surface("floor") = {face[1]};
Physical Surface("walls") = {a[1], b[1]};
