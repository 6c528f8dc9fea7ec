// A quarter of a column of grain, 72 x 72 x 192, that stands on shells of thickness 2 whose mid-surface is z = 0. The other
// quarters are behind the planes x = 0 and y = 0. Lengths in mm.
SetFactory("OpenCASCADE");
DefineConstant[ half = {36, Name "half"} ];
DefineConstant[ height = {192, Name "height"} ];

Box(1) = {0, 0, 1, half, half, height};
Mesh.MeshSizeMax = half / 3;
Physical Volume("grain") = {1};
