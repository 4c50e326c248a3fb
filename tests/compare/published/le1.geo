// A quarter of the membrane of NAFEMS LE1: between two ellipses.
DefineConstant[ h = 0.06 ];
Point(1) = {2, 0, 0, h / 2};
Point(2) = {3.25, 0, 0, 2 * h};
Point(3) = {0, 2.75, 0, 2 * h};
Point(4) = {0, 1, 0, h};
Point(5) = {0, 0, 0, h};
Line(1) = {1, 2};
Ellipse(2) = {2, 5, 2, 3};
Line(3) = {3, 4};
Ellipse(4) = {4, 5, 1, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Curve("below") = {1};
Physical Curve("outside") = {2};
Physical Curve("left") = {3};
Physical Curve("inside") = {4};
Physical Surface(1) = {1};
