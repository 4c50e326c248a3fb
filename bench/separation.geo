// The blocks of bench/peers as the published figures of other codes had them: 1 and 2 are those of the
// separation, 3 and 4 those of the patch test.
// Labels: 1 bottom, 2 right, 3 top, 4 left, 5 the loaded part of the top.
DefineConstant[ block = 1, coarser = 1 ];
Mesh.Algorithm = 6;  // frontal
width = (block == 2) ? 2 : 1;
y = (block == 1 || block == 3) ? 0.5 : 0;
edges = (block == 1) ? 230 : (block == 2) ? 320 : (block == 3) ? 200 : 283;
h = width / edges * coarser;
Point(1) = {0, y, 0, h};
Point(2) = {width, y, 0, h};
Point(3) = {width, y + 0.5, 0, h};
Point(4) = {0, y + 0.5, 0, h};
Point(5) = {0.4, y + 0.5, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(4) = {4, 1};
If (block == 1)
  Line(3) = {3, 5};
  Line(5) = {5, 4};
  Line Loop(1) = {1, 2, 3, 5, 4};
  Physical Line(5) = {5};
Else
  Line(3) = {3, 4};
  Line Loop(1) = {1, 2, 3, 4};
EndIf
Plane Surface(1) = {1};
Physical Surface(1) = {1};
For label In {1 : 4}
  Physical Line(label) = {label};
EndFor
