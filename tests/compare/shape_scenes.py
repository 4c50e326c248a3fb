"""Sound scenes like those of scenes.py whose bodies are parts of a geometry, shapes, or in space."""

# Two squares side by side in one geometry, PARTS_GEO as parts.geo; the other keys that a scene can have.
GEOMETRY_KEYS = """\
[[body]]
name = "left"
mesh = { file = "parts.geo", region = "left half", size = 0.25, parameters = { width = 1.5 } }
material = { young = 100, poisson = 0 }
boundary = [ { label = "left", ux = 0 }, { label = "base", uy = 0 } ]
[[body]]
name = "right"
mesh = { file = "parts.geo", region = ["right half"], size = 0.2, parameters = { width = 1.5 } }
material = { young = 100, poisson = 0 }
boundary = [ { label = "right", tx = -6 }, { label = "base", uy = 0 } ]
[contact]
nonmortar = { body = "left", label = "between" }
mortar = { body = "right", label = "between" }
[time]
end = 1
steps = 1
"""

PARTS_GEO = """\
DefineConstant[ width = {1, Name "Parameters/width"}, depth = 1 ];
Point(1) = {0, 0, 0}; Point(2) = {width, 0, 0}; Point(3) = {2*width, 0, 0};
Point(4) = {0, depth, 0}; Point(5) = {width, depth, 0}; Point(6) = {2*width, depth, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 6}; Line(4) = {6, 5}; Line(5) = {5, 4};
Line(6) = {4, 1}; Line(7) = {2, 5};
Curve Loop(1) = {1, 7, 5, 6}; Plane Surface(1) = {1};
Curve Loop(2) = {-7, 2, 3, 4}; Plane Surface(2) = {2};
Physical Curve("base", 1) = {1, 2}; Physical Curve("right", 2) = {3}; Physical Curve("top", 3) = {4, 5};
Physical Curve("left", 4) = {6}; Physical Curve("between", 9) = {7};
Physical Surface("left half", 1) = {1}; Physical Surface("right half", 2) = {2};
"""

# Meshes by their shape, refined until an accuracy is reached.
SHAPE_KEYS = """\
[[body]]
name = "plate"
mesh = { shape = "rectangle", lower = [0, 0], upper = [2, 1], cells = [4, 2], cut = "both", \
         focus = [0, 1], grading = 2 }
material = { young = 100, poisson = 0.3 }
boundary = [ { label = 1, ux = 0, uy = 0 }, { label = 3, ty = -1 } ]
[[body]]
name = "membrane"
mesh = { shape = "quadrilateral", corners = [[5, 0], [53, 44], [53, 60], [5, 44]], cells = 2 }
material = { young = 100, poisson = 0.3 }
boundary = [ { label = 4, ux = 0, uy = 0 }, { label = 2, ty = 0.1 } ]
[[body]]
name = "ring"
mesh = { shape = "annulus", centre = [-5, 0], inner = 1, outer = 2, span = "quarter", cells = [2, 1] }
material = { young = 100, poisson = 0.3 }
boundary = [ { label = 1, pressure = 1 }, { label = 3, uy = 0 }, { label = 4, ux = 0 } ]
[[body]]
name = "disc"
mesh = { shape = "halfdisc", lowest = [-5, -9], radius = 3, core = 0.9, cells = 1 }
material = { young = 100, poisson = 0.3 }
boundary = [ { label = 1, uy = 0, ux = 0 }, { label = 2, ty = -1 } ]
[[body]]
name = "quarter"
mesh = { shape = "quarterdisc", lowest = [-5, -19], radius = 3, core = 0.9, cells = 1 }
material = { young = 100, poisson = 0.3 }
boundary = [ { label = 1, uy = 0, ux = 0 }, { label = 2, ty = -1 } ]
[time]
end = 1
steps = 1
[accuracy]
energy = 0.1
max_unknowns = 40000
bound = true
max_seconds = 100
"""

ONE_BODY = """\
degree = 2
[[body]]
name = "block"
mesh = "upper.mesh"
material = { young = 2.1e11, poisson = 0.3 }
boundary = [ { label = 1, ux = 0, uy = 0 }, { label = 3, ty = "-1e6*t" } ]
[[body.point]]
at = [0, 1]
ux = 0
[time]
end = 1
steps = 2
"""

SPACE_KEYS = """\
dimension = 3
[[body]]
name = "upper"
mesh = { shape = "cylinder", centre = [0, 0, 0], radius = 0.9, height = 1, cells = [2, 1], keep = ["x", "y"] }
material = { young = 100, poisson = 0.3, viscosity = 1, yield_stress = 1 }
boundary = [ { label = "left", ux = 0 }, { label = "front", uy = 0 }, { label = 3, tz = "-2*t*(1 + z*x)" } ]
force = { z = "-0.1*y" }
initial_stress = { s13 = "0.1*y", s23 = 0.1 }
[[body]]
name = "lower"
mesh = { shape = "cuboid", lower = [0, 0, -1], upper = [1, 1, 0], cells = 2 }
material = { young = 100, poisson = 0.3, law = "maxwell", relaxation_time = 0.5 }
boundary = [ { label = "bottom", uz = 0 }, { label = 4, un = 0 }, { label = 6, pressure = "0.1*t" } ]
[[body.point]]
at = [0, 0, -1]
uy = 0
[[body]]
name = "beside"
mesh = { shape = "rectangle", lower = [3, 0], upper = [4, 1], cells = 1, extrude = 1, layers = 1 }
boundary = [ { label = "start", ux = 0, uy = 0, uz = 0 }, { label = "end", tz = "-t" } ]
[body.material]
elasticity = "orthotropic"
young1 = 100
young2 = 50
young3 = 80
poisson12 = 0.2
poisson13 = 0.1
poisson23 = 0.2
shear12 = 30
shear13 = 20
shear23 = 25
axes = [[0, 1, 0], [0, 0, 1]]
[[body]]
name = "turned"
mesh = { shape = "rectangle", lower = [6, 0], upper = [7, 1], cells = 1, revolve = 0.5, layers = 1 }
boundary = [ { label = 1, ux = 0, uy = 0, uz = 0 }, { label = 3, ty = "-t" } ]
[body.material]
young = 100
poisson = 0.3
law = "expression"
rate11 = "a*(s11 - s22)"
rate22 = "a*(s22 - s33)"
rate12 = "a*s12"
rate33 = "a*(s33 - s11)"
rate13 = "a*s13"
rate23 = "2*a*s23"
parameters = { a = 0.1 }
[[body]]
name = "anvil"
mesh = { shape = "cuboid", lower = [9, 0, 0], upper = [10, 1, 1], cells = 2 }
material = { young = 100, poisson = 0.3 }
boundary = [ { label = "bottom", ux = 0, uy = 0, uz = 0 } ]
[[tool]]
name = "plate"
mesh = { shape = "cuboid", lower = [8, -1, 1], upper = [11, 2, 2], cells = 1 }
at = [9.5, 0.5, 1]
fz = -1
moment_x = "0.01*t"
moment_y = 0
moment_z = "0.01*t"
[[tool]]
name = "wall"
mesh = { shape = "cuboid", lower = [4, -1, -1], upper = [5, 2, 2], cells = 1 }
ux = "-0.001*t"
rotation_x = 0
rotation_y = 0
rotation_z = 0
[[contact]]
sides = [{ body = "upper", label = "bottom" }, { body = "lower", label = "top" }]
[[contact]]
sides = [{ body = "anvil", label = "top" }, { body = "plate", label = "bottom" }]
friction = 0.5
[[contact]]
sides = [{ body = "beside", label = 2 }, { body = "wall", label = "left" }]
[[quantity]]
name = "floor"
reaction = { body = "lower", label = "bottom" }
component = "z"
[[quantity]]
name = "tips"
reaction = { body = "lower", label = "bottom" }
component = "moment_x"
about = [0, 0.5, 0]
[[quantity]]
name = "touching"
contact_area = { body = "upper", label = "bottom" }
[[quantity]]
name = "mean"
mean_pressure = { body = "upper", label = "bottom" }
[[quantity]]
name = "corner"
displacement = { body = "upper", point = [0.9, 0, 1] }
component = "x"
[time]
end = 1
steps = 2
"""
