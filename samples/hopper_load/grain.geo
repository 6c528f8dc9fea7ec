// A quarter of the grain in the silo: it touches the faces of its shells, whose thickness is 1. The other quarters are
// behind the planes x = 0 and y = 0. Lengths in mm.
SetFactory("OpenCASCADE");
DefineConstant[ half = {48, Name "half"} ];
DefineConstant[ height = {240, Name "height"} ];

Box(1) = {0, 0, 0.5, half, half, height};
Mesh.MeshSizeMax = half / 3;
Physical Volume("grain") = {1};
