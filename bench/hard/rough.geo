// Half of the half plane of rough.toml: equal cells beside the contact, as high as long, then growing ones.
DefineConstant[ cells = 40, inner = 0.36, far = 100, growth = 1.15 ];
n = Ceil(Log(1 + (far/inner - 1)*cells*(1 - 1/growth))/Log(growth));
x[] = {0, inner, far};
For j In {0:2}
  For i In {0:2}
    Point(1 + i + 3*j) = {x[i], -x[2 - j], 0};
  EndFor
EndFor
For k In {0:2}
  Line(10 + k) = {1 + 3*k, 2 + 3*k};
  Line(20 + k) = {2 + 3*k, 3 + 3*k};
  Line(30 + k) = {1 + k, 4 + k};
  Line(40 + k) = {4 + k, 7 + k};
EndFor
Transfinite Curve{10:12, 40:42} = cells + 1;
Transfinite Curve{20:22} = n + 1 Using Progression growth;
Transfinite Curve{30:32} = n + 1 Using Progression 1/growth;
For j In {0:1}
  For i In {0:1}
    Curve Loop(1 + i + 2*j) = {10 + 10*i + j, 31 + i + 10*j, -(11 + 10*i + j), -(30 + i + 10*j)};
    Plane Surface(1 + i + 2*j) = {1 + i + 2*j};
  EndFor
EndFor
Transfinite Surface{1:4};
Physical Curve(1) = {10, 20};
Physical Curve(2) = {32, 42};
Physical Curve(3) = {12, 22};
Physical Curve(4) = {30, 40};
Physical Surface(1) = {1:4};
