// A quarter of the lower half of a ball of radius R on the point (0, 0, 0); size f there, growing with h
// times the distance.
SetFactory("OpenCASCADE");
R = 1;
DefineConstant[ h = 0.2, f = 0.01 ];
Sphere(1) = {0, 0, R, R};
Box(2) = {0, 0, 0, R, R, R};
BooleanIntersection{ Volume{1}; Delete; }{ Volume{2}; Delete; }
e = 1e-4;
left() = Surface In BoundingBox{-e, -e, -e, e, 2*R, 2*R};
front() = Surface In BoundingBox{-e, -e, -e, 2*R, e, 2*R};
top() = Surface In BoundingBox{-e, -e, R - e, 2*R, 2*R, R + e};
arc() = Surface In BoundingBox{-e, -e, -e, 2*R, 2*R, R + e};
arc() -= {left(), front(), top()};
Physical Volume("ball", 1) = {1};
Physical Surface("arc", 1) = arc();
Physical Surface("top", 3) = top();
Physical Surface("left", 4) = left();
Physical Surface("front", 5) = front();
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("%g + %g*Sqrt(x^2 + y^2 + z^2)", f, h);
Background Field = 1;
