// A block that flies onto the middle of the plate. Lengths in mm.
SetFactory("OpenCASCADE");
Box(1) = {5, 5, 3, 10, 10, 10};
Mesh.MeshSizeMax = 5;
Physical Volume("block") = {1};
