// The grain as it is poured: a block above the hopper, its flanks half a spacing from the planes of symmetry.
SetFactory("OpenCASCADE");
DefineConstant[ spacing = {100, Name "spacing"}, height = {1000, Name "height"} ];
Box(1) = {0, 0, 1300, 2300, 1100, height};
Mesh.MeshSizeMax = 500;
Physical Volume("grain") = {1};
