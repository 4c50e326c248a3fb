"""Sound scenes that tests change. Each wants the meshes upper.mesh and lower.mesh beside it, rectangles whose
labels are 1 bottom, 2 right, 3 top, 4 left."""

TWO_BLOCKS = """\
title = "two blocks"

[[body]]
name = "upper"
mesh = "upper.mesh"
material = { young = 3e11, poisson = 0.3, viscosity = 10, yield_stress = 1, projection = "elasticity" }
[[body.boundary]]
label = 4
ux = 0
[[body.boundary]]
label = 3
ty = "-10*t"

[[body]]
name = "lower"
mesh = "lower.mesh"
material = { young = 3e11, poisson = 0.3 }
boundary = [ { label = 4, ux = 0 }, { label = 1, uy = 0 } ]

[contact]
nonmortar = { body = "upper", label = 1 }
mortar = { body = "lower", label = 3 }

[time]
end = 1
steps = 4
"""

EVERY_KEY = """\
title = "every key"
[[body]]
name = "upper"
mesh = "upper.mesh"
material = { young = 2e3, poisson = -0.2, viscosity = 50.5, yield_stress = 3 }
force = { x = "sin(pi*x)*t", y = -1 }
[[body.boundary]]
label = 3
ux = "t < 0.5 ? 0 : 1e-4*(t-0.5)"
uy = "-0.01*t"
[[body]]
name = "lower"
mesh = "lower.mesh"
material = { young = 1e4, poisson = 0.49, viscosity = 2, yield_stress = 1, projection = "compliance" }
[[body.boundary]]
label = 1
ux = 0
uy = 0
[[body.boundary]]
label = 2
tx = "exp(-y^2)*min(t, 0.3)"
[[contact]]
nonmortar = { body = "lower", label = 3 }
mortar = { body = "upper", label = 1 }
variant = "interpolation"
swap = true
[time]
end = 2.5
steps = 5
scheme = "sdirk2"
[solver]
tolerance = 1e-9
max_iterations = 200
linear = "suitesparse"
[output]
every = 2
"""

ONE_BODY = """\
[[body]]
name = "block"
mesh = "upper.mesh"
material = { young = 2.1e11, poisson = 0.3 }
boundary = [ { label = 1, ux = 0, uy = 0 }, { label = 3, ty = "-1e6*t" } ]
[time]
end = 1
steps = 2
"""
