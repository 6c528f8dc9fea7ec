// A cone of grain that stands on the plate, whose upper face is at z = 1. Lengths in mm.
SetFactory("OpenCASCADE");
DefineConstant[ radius = {72, Name "radius"} ];
DefineConstant[ height = {29, Name "height"} ];

Cone(1) = {0, 0, 1, 0, 0, height, radius, 0};
Mesh.MeshSizeMax = radius / 6;
Physical Volume("grain") = {1};
