// A quarter of a square silo of shells of thickness 1: a floor, and walls at x = half and y = half (mid-surfaces). The other
// quarters are behind the planes x = 0 and y = 0. Lengths in mm.
DefineConstant[ half = {48.5, Name "half"} ];
DefineConstant[ height = {260, Name "height"} ];
DefineConstant[ n = {8, Name "n"} ];              // shells over half a side
DefineConstant[ m = {26, Name "m"} ];             // and over the height

Point(1) = {0, 0, 0};
out[] = Extrude {half, 0, 0} { Point{1}; Layers{n}; };
face[] = Extrude {0, half, 0} { Curve{out[1]}; Layers{n}; Recombine; };
a[] = Extrude {0, 0, height} { Curve{face[0]}; Layers{m}; Recombine; };
b[] = Extrude {0, 0, height} { Curve{face[2]}; Layers{m}; Recombine; };
Physical Surface("floor") = {face[1]};
Physical Surface("walls") = {a[1], b[1]};
Physical Curve("rim") = {2, 4};         // where floor and walls meet
Physical Curve("at_y0") = {1, 11};      // floor and wall on the planes of symmetry
Physical Curve("at_x0") = {3, 7};
