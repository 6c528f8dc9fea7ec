// A quarter of a cylinder of sand before its tube is drawn, and of the rough floor on which it spreads. The other quarters
// are behind the planes x = 0 and y = 0. Lengths in m.

SetFactory("OpenCASCADE");
DefineConstant[ radius = {0.1, Name "radius"} ];
DefineConstant[ height = {0.1, Name "height"} ];
DefineConstant[ reach = {0.28, Name "reach"} ];      // of the floor
DefineConstant[ depth = {0.03, Name "depth"} ];      // of the floor: three spacings, what the kernel sees

Cylinder(1) = {0, 0, 0, 0, 0, height, radius, Pi / 2};
Box(2) = {0, 0, -depth, reach, reach, depth};
Mesh.MeshSizeMax = radius / 5;

Physical Volume("sand") = {1};
Physical Volume("floor") = {2};
