// Half of the section of the lower hemisphere of hemispheres.toml, fine around its highest point.
DefineConstant[ R = 6.1237, h = 0.02 ];
b = 0.15;  // angle of the fine part
Point(1) = {0, -R, 0, R / 6};
Point(2) = {0, 0, 0, h};
Point(3) = {R * Sin(b), R * Cos(b) - R, 0, h};
Point(4) = {R * Sin(0.8), R * Cos(0.8) - R, 0, R / 10};
Point(5) = {R, -R, 0, R / 6};
Point(6) = {0, -0.9, 0, 3 * h};
Line(1) = {1, 5};
Circle(2) = {5, 1, 4};
Circle(3) = {4, 1, 3};
Circle(4) = {3, 1, 2};
Line(5) = {2, 6};
Line(6) = {6, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Plane Surface(1) = {1};
Physical Curve(1) = {3, 4};
Physical Curve(2) = {1};
Physical Curve(3) = {5, 6, 2};
Physical Surface(1) = {1};
