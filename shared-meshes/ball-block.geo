// A quarter of a block of sides 2 L and height L below the point (0, 0, 0); size f there, growing with h
// times the distance.
SetFactory("OpenCASCADE");
DefineConstant[ h = 0.2, f = 0.01, L = 2 ];
Box(1) = {0, 0, -L, L, L, L};
e = 1e-4;
Physical Volume("block", 1) = {1};
Physical Surface("bottom", 1) = Surface In BoundingBox{-e, -e, -L - e, L + e, L + e, -L + e};
Physical Surface("top", 3) = Surface In BoundingBox{-e, -e, -e, L + e, L + e, e};
Physical Surface("left", 4) = Surface In BoundingBox{-e, -e, -L - e, e, L + e, e};
Physical Surface("front", 5) = Surface In BoundingBox{-e, -e, -L - e, L + e, e, e};
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("%g + %g*Sqrt(x^2 + y^2 + z^2)", f, h);
Background Field = 1;
