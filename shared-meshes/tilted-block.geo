// A block over the square [0, 1] x [0, 1] with one oblique side, the plane z = x/4: its bottom where
// `end` is above it, else its top. Elements of size h.
DefineConstant[ end = 1, h = 0.3 ];
xs[] = {0, 1, 1, 0};
ys[] = {0, 0, 1, 1};
For i In {0:3}
  Point(1 + i) = {xs[i], ys[i], xs[i]/4, h};
  Point(5 + i) = {xs[i], ys[i], end, h};
EndFor
For i In {0:3}
  j = (i + 1) % 4;
  Line(1 + i) = {1 + i, 1 + j};
  Line(5 + i) = {5 + i, 5 + j};
  Line(9 + i) = {1 + i, 5 + i};
EndFor
Curve Loop(1) = {1, 2, 3, 4};
Curve Loop(2) = {5, 6, 7, 8};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
For i In {0:3}
  j = (i + 1) % 4;
  Curve Loop(3 + i) = {1 + i, 9 + j, -(5 + i), -(9 + i)};
  Plane Surface(3 + i) = {3 + i};
EndFor
Surface Loop(1) = {1, 2, 3, 4, 5, 6};
Volume(1) = {1};
Physical Volume("block", 1) = {1};
Physical Surface("oblique", 1) = {1};
Physical Surface("level", 2) = {2};
Physical Surface("front", 3) = {3};
Physical Surface("right", 4) = {4};
Physical Surface("back", 5) = {5};
Physical Surface("left", 6) = {6};
