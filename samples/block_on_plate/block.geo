// A cube of 8 mm, `gap` above the plate's mid-surface. Lengths in mm.
SetFactory("OpenCASCADE");
DefineConstant[ gap = {2.5, Name "gap"} ];
Box(1) = {-4, -4, gap, 8, 8, 8};
Mesh.MeshSizeMax = 4;
Physical Volume("block") = {1};
