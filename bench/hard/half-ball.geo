// A quarter of half a ball of radius R, with the point (0, 0, 0) on it: above that for side = 1, below it for
// side = -1. Size f there, growing with h times the distance.
SetFactory("OpenCASCADE");
DefineConstant[ R = 1, side = 1, h = 0.2, f = 0.01 ];
Sphere(1) = {0, 0, side*R, R};
Box(2) = {0, 0, Min(0, side*R), R, R, R};
BooleanIntersection{ Volume{1}; Delete; }{ Volume{2}; Delete; }
e = 1e-4 * R;
left() = Surface In BoundingBox{-e, -e, -2*R, e, 2*R, 2*R};
front() = Surface In BoundingBox{-e, -e, -2*R, 2*R, e, 2*R};
flat() = Surface In BoundingBox{-e, -e, side*R - e, 2*R, 2*R, side*R + e};
arc() = Surface In BoundingBox{-e, -e, -2*R, 2*R, 2*R, 2*R};
arc() -= {left(), front(), flat()};
Physical Volume("ball", 1) = {1};
Physical Surface("arc", 1) = arc();
Physical Surface("flat", 2) = flat();
Physical Surface("left", 4) = left();
Physical Surface("front", 5) = front();
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("%g + %g*Sqrt(x^2 + y^2 + z^2)", f, h);
Background Field = 1;
