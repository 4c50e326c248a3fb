"""Sound scenes that tests change. Each wants the meshes upper.mesh and lower.mesh beside it, rectangles whose
labels are 1 bottom, 2 right, 3 top, 4 left."""

TWO_BLOCKS = """\
title = "two blocks"
check.allow = ["few-steps-across-yield"]
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

# To be added to it: what the ground carries, and what comes through the contact.
HELD_AND_PRESSED = """
[[quantity]]
name = "held"
reaction = { body = "lower", label = 1 }
component = "y"
[[quantity]]
name = "pressed"
contact_force = { body = "lower", label = 3 }
component = "y"
"""

# The next two hold every key of a scene between them.
CONTACT_KEYS = """\
title = "expressions, interpolation, sides swapped"
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
kind = "unilateral"
nonmortar = { body = "lower", label = 3 }
mortar = { body = "upper", label = 1 }
variant = "interpolation"
stabilised = false
swap = true
gap = "1e-4*x^2"
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
state = true
"""

BODY_KEYS = """\
title = "plane strain, regions, initial stress, rollers, tables, steps by their error"
units = "m, N, Pa"
plane = "strain"
[[body]]
name = "upper"
mesh = "upper.mesh"
material = { young = "2 kPa", poisson = 0.3 }
initial_stress = { s11 = 0.1, s22 = "-0.2*(1+x)", s12 = 0, s33 = -0.1 }
[[body.region]]
label = 1
material = { young = 1e3, poisson = 0.2, viscosity = 5, yield_stress = 2, projection = "frobenius" }
initial_stress = { s11 = "0.1*y", s12 = 0.01 }
[[body.boundary]]
label = 4
un = 0
[[body.boundary]]
label = 2
pressure = "0.1*t"
[[body.boundary]]
label = 3
ty = { time = [0, 0.4, 1], value = [-1, -4, -2] }
[[body]]
name = "lower"
mesh = "lower.mesh"
volume = "averaged"
[body.material]
young = 1e4
poisson = 0.3
law = "viscoplastic"
yield_stress = 2
reference_stress = 9
reference_rate = 1e-3
exponent = 4
kinematic_hardening = 100
isotropic_hardening = "0.1 kPa"
[[body.boundary]]
label = 1
un = 0
ut = "1e-4*t"
[contact]
sides = [ { body = "upper", label = 1 }, { body = "lower", label = 3 } ]
initial = "close"
[[quantity]]
name = "held"
reaction = { body = "lower", label = 1 }
component = "moment"
about = [0.5, -1]
[[quantity]]
name = "pressed"
contact_force = { body = "upper", label = 1 }
component = "y"
[[quantity]]
name = "moves"
displacement = { body = "upper", point = ["0.5 m", 0.5] }
component = "x"
[[quantity]]
name = "stored"
stored_energy = { body = "upper" }
[[quantity]]
name = "dissipated"
dissipated_energy = { body = "upper" }
[[quantity]]
name = "work"
work = { body = "lower" }
[[quantity]]
name = "from-outside"
external_work = { body = "lower" }
[[quantity]]
name = "hardest"
largest_pressure = { body = "lower", label = 3 }
[[quantity]]
name = "pressed-in-part"
mean_pressure = { body = "lower", label = 3, from = [0.2, 0], to = ["0.6 m", 0], margin = 0.1 }
[[quantity]]
name = "touching"
contact_length = { body = "upper", label = 1 }
[[quantity]]
name = "strained"
largest_mises = { body = "upper" }
[time]
end = 1
scheme = "sdirk2"
tolerance = 0.1
max_steps = 200
breaks = [0.3, 0.7]
[solver]
method = "newton"
reduce = false
[check]
allow = ["few-steps-across-yield", "stiffness-ratio"]
"""

# A tool that forces and a moment move, held by friction, and one that stands.
TOOL_KEYS = """\
[[tool]]
name = "stamp"
shape = "polygon"
points = [[0.1, 1], [0.9, 1], [0.9, 1.5], [0.1, 1.5]]
labels = [1, 2, 2, 2]
at = [0.5, 1]
fx = "0.1*t"
fy = "-t"
moment = "0.01*t"
[[tool]]
name = "wall"
shape = "line"
points = [[1, 1.2], [1, -0.2]]
rotation = 0
[[tool]]
name = "pin"
shape = "point"
at = [0, 0.5]
[[tool]]
name = "wedge"
shape = "point"
at = [3, 0]
fx = 0.1
[[body]]
name = "shank"
mesh = { shape = "rectangle", lower = [2, 0], upper = [3, 1], cells = [1, 2] }
material = { young = 100, poisson = 0.3 }
boundary = [ { label = 4, ux = 0, uy = 0 } ]
point = [ { at = [3, 1], fy = 0.1 } ]
[[body]]
name = "head"
mesh = { shape = "rectangle", lower = [3, 0], upper = [4, 1], cells = [1, 1] }
material = { young = 100, poisson = 0.3 }
boundary = [ { label = 2, ux = 0, uy = 0 } ]
[[body]]
name = "block"
mesh = { shape = "rectangle", lower = [0, 0], upper = [1, 1], cells = [4, 4] }
material = { young = 100, poisson = 0.3 }
boundary = [ { label = 1, ux = 0, uy = 0 } ]
[[contact]]
sides = [ { body = "block", label = 3 }, { body = "stamp", label = 1 } ]
friction = 0.5
[[contact]]
sides = [ { body = "block", label = 2 }, { body = "wall", label = 1 } ]
[[contact]]
kind = "tied"
sides = [ { body = "block", label = 4 }, { body = "pin" } ]
coupling = "distributing"
along = ["x"]
stiffness = 10
[[contact]]
kind = "tied"
sides = [ { body = "shank", label = 2 }, { body = "head", label = 4 } ]
offset = "wedge"
[time]
end = 1
steps = 2
"""
# Friction by both laws: pressed, pushed along, pulled back.
FRICTION_KEYS = """\
[[body]]
name = "upper"
mesh = "upper.mesh"
material = { young = 100, poisson = 0.3 }
boundary = [ { label = 4, uy = "-0.02*min(t, 1)", ux = {time = [0, 1, 2, 4], value = [0, 0, 0.03, -0.03]} } ]
[[body]]
name = "lower"
mesh = "lower.mesh"
material = { young = 200, poisson = 0.3 }
boundary = [ { label = 1, ux = 0, uy = 0 } ]
[[body]]
name = "plate"
mesh = { shape = "rectangle", lower = [0, 1], upper = [1, 2], cells = [3, 3] }
material = { young = 100, poisson = 0.2 }
boundary = [ { label = 3, ux = 0, uy = "-0.03*min(t, 1)" } ]
[[contact]]
nonmortar = { body = "upper", label = 1 }
mortar = { body = "lower", label = 3 }
friction = 0.3
[[contact]]
nonmortar = { body = "plate", label = 1 }
mortar = { body = "upper", label = 3 }
variant = "weighted"
shear_limit = 0.5
sliding = "allow"
[[quantity]]
name = "rubbed"
friction_work = { body = "upper", label = 1 }
[time]
end = 4
steps = 8
[solver]
list_solutions = true
"""

# Elasticity with axes, temperature, distance in time.
ELASTIC_KEYS = """\
plane = "strain"
units = "m, N, Pa"
[[body]]
name = "upper"
mesh = { shape = "rectangle", lower = [0, 0], upper = [1, 1], cells = [2, 2], cut = "both" }
temperature = "10*t*(1 + x)"
boundary = [ { label = 3, ux = 0, uy = 0 } ]
[body.material]
elasticity = "orthotropic"
young1 = "10 Pa"
young2 = 5
young3 = 4
poisson12 = 0.2
poisson13 = 0.1
poisson23 = 0.3
shear12 = 3
angle = "0.3 + atan2(y, x)/4"
expansion = [1e-4, 2e-4, 3e-4]
[[body]]
name = "lower"
mesh = { shape = "rectangle", lower = [0, -1], upper = [1, 0], cells = [3, 2], cut = "both" }
temperature = { file = "lower.heat", factor = "t" }
boundary = [ { label = 1, ux = 0, uy = 0 } ]
[body.material]
elasticity = "general"
stiffness = [["9 Pa", 2, 0.5, 3], [2, 7, 0.1, 2], [0.5, 0.1, 3, 0], [3, 2, 0, 8]]
expansion = 1e-4
[contact]
sides = [ { body = "upper", label = 1 }, { body = "lower", label = 3 } ]
gap = "-1e-3*t*(1 + x)"
[[quantity]]
name = "heated"
thermal_work = { body = "upper" }
[time]
end = 1
steps = 2
"""


LAW_KEYS = """\
plane = "strain"
[[body]]
name = "upper"
mesh = { shape = "rectangle", lower = [0, 0], upper = [1, 1], cells = [2, 2], cut = "both" }
boundary = [ { label = 3, ux = 0, uy = "-1e-3*t" } ]
[body.material]
young = 10
poisson = 0.3
law = "expression"
rate11 = "a*(s11 - (s11 + s22 + s33)/3)"
rate22 = "a*(s22 - (s11 + s22 + s33)/3)"
rate12 = "a*s12"
rate33 = "a*(s33 - (s11 + s22 + s33)/3)"
parameters = { a = 0.1 }
isotropic = true
[[body]]
name = "lower"
mesh = { shape = "rectangle", lower = [0, -1], upper = [1, 0], cells = [3, 2], cut = "both" }
boundary = [ { label = 1, ux = 0, uy = 0 } ]
material = { young = 20, poisson = 0.3, law = "standard-solid", relaxation_time = 2, relaxed_fraction = 0.4 }
[contact]
sides = [ { body = "upper", label = 1 }, { body = "lower", label = 3 } ]
[time]
end = 1
steps = 2
"""


def lower_heat(count):
    """Nodal temperatures of the lower body: one number a line."""
    return "".join(f"{5 + 0.5*i}\n" for i in range(count))
