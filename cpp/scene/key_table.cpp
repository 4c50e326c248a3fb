#include "scene/keys.h"

// One row a key, name | unit | default | expected | help; several names share a row, indented lines go on.
// Above the rows stand the tables that they are of, [path path], and the row that documents those. What the
// reader takes from `expected`: words in quotes, "> 0", ">= 0", "integer >= 1" or "between 0 and 1" at its
// beginning, and "with KEY = words", of which one must hold (keys.cpp). Rows without help are of tables that
// another row describes.

namespace mortier {

const char* const keyTable = R"(
[]
title | | empty | a string | shown in results
plane | | `"stress"` | `"stress"`, `"strain"`, `"axisymmetric"` | of all bodies: thin plates (s33 = 0), long
  bodies with no strain across the plane ([below](#plane-strain)), or bodies that turn about the axis x = 0
  ([below](#bodies-of-revolution))
body, tool, contact, quantity, stage, time, solver, output, check
start | | none: bodies as drawn, at rest | a result of a run with `output.state = true` | the run begins with
  the last state of that one, at its time ([below](#runs-that-go-on))
dimension | | 2 | integer >= 2, at most 3 | 3: bodies of tetrahedra, without `plane`
  ([below](#bodies-in-space))
degree | | 1 | integer >= 1, at most 2 | of the displacements: linear triangles, or quadratic ones (six nodes,
  stresses at three points); middles of sides lie on the curve where Gmsh knows it
accuracy
units | | SI | a length, a force, a stress, and a time if it is not s: `"mm, N, MPa"` | of all numbers; then
  numbers may have a unit of their own ([below](#units))
[body] `[[body]]` | | | one or more |
name | | | letters, digits, `_`, `-`; each once | names files and messages
mesh | m | | a file of a mesh or a geometry ([kinds](#meshes)), or a table | path relative
  to the scene
volume | | `"automatic"` | `"automatic"`, `"pointwise"`, `"averaged"` | volumetric strain
  of the material: pointwise, averaged over patches of elements (against locking), or chosen by the program
  ([below](#bodies-that-keep-their-volume))
material, force, boundary, region, initial_stress, point
temperature | K | 0 | datum, or `{ file = "...", factor = datum }` | temperature change from the
  stress-free state; of a file a value for each vertex of the mesh in its order, times `factor` (1); needs
  `expansion` ([below](#temperature))
[body.mesh]
file | | | as `mesh` | the file, in a table with further keys
region | | all | a region, by number or name, or a list of them | the part of the file that is the body:
  several bodies may be drawn in one
size | m | the geometry's own | > 0 | longest edge, where Gmsh meshes a geometry
parameters | | none | table of numbers, `{ R = 8 }` | constants of a `.geo` that its `DefineConstant[...]`
  names
shape | | | `"rectangle"`, `"quadrilateral"`, `"annulus"`, `"halfdisc"`, `"quarterdisc"`,
  `"cuboid"`, `"cylinder"`, `"ball"` | in place of a file, with keys of its own ([below](#meshes), in space
  [there](#bodies-in-space))
cells
cut | | | "rising", "falling", "both"
lower, upper | m | | with shape = "rectangle", "cuboid"
focus | m | | with shape = "rectangle"
grading | | | with shape = "rectangle"
corners | m | | with shape = "quadrilateral"
centre | m | | with shape = "annulus", "cylinder", "ball"
inner | m | 1 | > 0; with shape = "annulus"
outer | m | 2 | > 0; with shape = "annulus"
span | | "full" | "quarter", "half", "full"; with shape = "annulus"
lowest | m | | with shape = "halfdisc", "quarterdisc"
radius | m | 1 | > 0; with shape = "halfdisc", "quarterdisc", "cylinder", "ball"
height | m | 1 | > 0; with shape = "cylinder"
keep | | | with shape = "cylinder", "ball"
core | m | 0.1 | > 0; with shape = "halfdisc", "quarterdisc"
extrude | m | | > 0 | with `dimension = 3`: a plane shape or a plane file becomes a body of this length
  along z ([below](#bodies-in-space))
revolve | rad | | a number or an expression such as pi/2, at most 2 pi | the same, turned about the axis
  x = 0 from the x axis towards the z axis
layers | | | integer >= 1 | of tetrahedra along the length or the angle
[body.force]
x, y, z | N/m^3 | 0 | datum | body force; `z` with `dimension = 3`
[body.temperature]
file, factor
[body.material body.region.material] `material` of a body | | | table | elastic without `law`, `viscosity` and
  `yield_stress`
young | Pa | | > 0 | Young's modulus E
poisson | | | between -1 and 0.5 | Poisson's ratio
law | | `"perzyna"` with `viscosity` and `yield_stress`, else `"elastic"` | `"elastic"`, `"perzyna"`,
  `"norton"`, `"maxwell"`, `"standard-solid"`, `"viscoplastic"`, `"expression"`, or a law that a program has
  registered | what the body does beside elasticity; keys of another law are an error
viscosity | Pa s | none: elastic | > 0, with `yield_stress`; with law = "perzyna", "viscoplastic", of which
  the latter takes 0 too | lambda of Perzyna's law; in plane stress not that of three dimensions
  ([below](#flow-in-plane-stress)) unless `law = "viscoplastic"`
yield_stress | Pa | none: elastic | > 0, with `viscosity`; with law = "perzyna", "viscoplastic" | von Mises
  stress at which flow begins
projection | | `"frobenius"` | `"elasticity"`, `"frobenius"`, `"compliance"`; with law = "perzyna" | norm in
  which stresses are projected on the elastic domain; without meaning in an elastic body and in plane strain,
  where all three are one
reference_stress | Pa | | > 0; with law = "norton", "viscoplastic" | uniaxial stress at the reference rate
  ([below](#creep)); of `"viscoplastic"` an overstress ([below](#flow-by-the-overstress))
reference_rate | 1/s | | > 0; with law = "norton", "viscoplastic" | creep rate, or flow rate, at the
  reference stress
exponent | | | >= 1; with law = "norton", "viscoplastic" | exponent n of the rate law: the rate grows with the
  n-th power of the stress, or of the overstress
relaxation_time | s | | > 0; with law = "maxwell", "standard-solid" | relaxation time of shear at constant
  strain ([below](#viscoelasticity))
relaxed_fraction | | | between 0 and 1; with law = "standard-solid" | long-term over instantaneous shear
  modulus
kinematic_hardening | Pa | 0 | >= 0; with law = "viscoplastic" | Prager's modulus H: back stress = H x plastic
  strain
isotropic_hardening | Pa | 0 | >= 0; with law = "viscoplastic"; in all regions of a body or in none |
  isotropic hardening modulus: yield stress over accumulated plastic strain
rate11, rate22, rate12 | 1/s | | expressions; with law = "expression" | the viscoplastic strain rate
  ([below](#user-defined-laws))
rate33 | 1/s | | expression, but for `plane = "stress"`; with law = "expression" | the same across the plane,
  or around the axis
rate13, rate23 | 1/s | | expressions; with law = "expression" | the same with `dimension = 3`
parameters | | none | table of numbers and expressions; with law = "expression" | names that the rates may
  hold; with a registered law numbers only
isotropic | | false | true, false; with law = "expression" | states that the user-defined law, or the
  registered one, is isotropic; `mortier law` then checks it
elasticity | | `"isotropic"` | `"isotropic"`, `"orthotropic"`, `"general"` | the others have keys of their own
  in place of `young` and `poisson` ([below](#elasticity-with-axes))
young1, young2, shear12 | Pa | | > 0; with elasticity = "orthotropic" | moduli along the two axes of the plane
  and of shear between them
shear13, shear23 | Pa | | > 0; with elasticity = "orthotropic" | the same of the third axis, with
  `dimension = 3`
young3 | Pa | | > 0; with elasticity = "orthotropic" | the same of the axis across the plane, or around that
  of revolution: without effect in plane stress, needed elsewhere
poisson12 | | | a number; with elasticity = "orthotropic" | contraction along axis 2 over extension along axis
  1, under a stress along axis 1
poisson13, poisson23 | | | a number; with elasticity = "orthotropic" | needed where `young3` is
stiffness | Pa | | rows of numbers; with elasticity = "general" | (s11, s22, s12) of (e11, e22, 2 e12), three
  by three; but for plane stress four by four, s33 and e33 after them; with `dimension = 3` six by six, s13,
  s23 and 2 e13, 2 e23 after those
axes | | `[[1, 0, 0], [0, 1, 0]]` | two vectors; with elasticity = "orthotropic", "general" | axis 1, and a
  vector in the plane of axes 1 and 2, with `dimension = 3`
angle | rad | 0 | a number or an expression in x, y; with elasticity = "orthotropic", "general" | from the x
  axis to axis 1, at every point at which stresses are taken; with `dimension = 3` the axes are turned by it
  about z
expansion | 1/K | 0 | a number; beside axes also three, one for each | thermal strain per kelvin of
  `temperature`
[body.initial_stress body.region.initial_stress]
s11, s22, s12 | Pa | 0 | datum | stress at t = 0
s33 | Pa | nu (s11 + s22); axisymmetric 0 | datum | the same across the plane, or around the axis; not with
  `plane = "stress"`; with `dimension = 3` 0 where it is not given
s13, s23 | Pa | 0 | datum | the same with `dimension = 3`
[body.region] `[[body.region]]` | | none | any number | what is different in the triangles of one region
label | | | a region of the mesh, by number or name, each once | of the region
material | | that of the body | table as above | elastic and viscoplastic regions may be mixed, and
  projections
initial_stress | Pa | that of the body | table as above | component by component
[body.boundary] `[[body.boundary]]` | | none | any number | conditions on one label; a component not named is
  free
label | | | a boundary label of the mesh, by number or name | of the edges
ux, uy, uz | m | free | datum, or `"held"` | prescribed displacement; held: that in which the run begins
  ([below](#runs-that-go-on)); `uz` with `dimension = 3`
un, ut | m | free | datum, or `"held"` | prescribed displacement along the outward normal and along the
  tangent (the body to its left), on sides in any direction: `un = 0` is a roller
tx, ty, tz | Pa | 0 | datum | traction (force per area); not together with the displacement of the same
  component; `tz` with `dimension = 3`
pressure | Pa | 0 | datum | traction -p n on the sides as meshed, straight or curved; not together with `un`
[body.point] `[[body.point]]` | | none | any number | what holds or loads one vertex
  ([below](#supports-and-forces-at-points))
at | m | | `[x, y]`, with `dimension = 3` `[x, y, z]` | the vertex: to a thousandth of the shortest edge there
ux, uy, uz | m | free | datum, or `"held"` | prescribed displacement; `uz` with `dimension = 3`
fx, fy, fz | N/m | 0 | datum | force; of rings and in space [N]; not beside `accuracy`
[tool] `[[tool]]` | | none | any number | a rigid body, without material ([below](#rigid-tools))
name | | | letters, digits, `_`, `-`; each once | names files and messages
shape | | | `"line"`, `"disc"`, `"rectangle"`, `"polygon"`, `"spline"`, `"point"` | of its outline; a
  point has none, ties take its motion ([below](#couplings-springs-and-bolts)); with `dimension = 3` a point
  alone
points | m | | `[[x, y], ...]`; with shape = "line", "polygon", "spline" | two ends, corners, or points that
  the spline goes through; the tool lies to the left of the polyline
labels | | 1, 2, ... | an integer a side; with shape = "polygon" | of the sides, from the first corner on
centre | m | | `[x, y]`; with shape = "disc" | of the circle
radius | m | | > 0; with shape = "disc" | of the circle
lower, upper | m | | `[x, y]`; with shape = "rectangle" | its corners; labels 1 bottom, 2 right, 3 top, 4 left
mesh | m | | as `mesh` of a body | in place of a shape: a file, of which the outline is used; with
  `dimension = 3` a file or a shape of bodies in space, of which the surface is used
at | m | the centre; of a `mesh` the origin | `[x, y]`, in space `[x, y, z]` | the point about which it turns,
  and whose displacement is prescribed
ux, uy, uz | m | 0 | datum in t, or `"held"` | prescribed displacement; `uz` with `dimension = 3`
rotation | rad | 0 | datum in t, or `"held"` | prescribed rotation about `at`, counterclockwise, linear
rotation_x, rotation_y, rotation_z | rad | 0 | datum in t, or `"held"` | the same with `dimension = 3`, about
  the axes
fx, fy, fz | N/m | | datum in t | in place of `ux`, `uy`, `uz`: force on the tool, which is free in this
  direction; of rings and in space [N]
moment | N | | datum in t | in place of `rotation`: moment about `at`; the tool turns freely
moment_x, moment_y, moment_z | N | | datum in t | the same with `dimension = 3`, about the axes, in [N m]
[contact] `[contact]` or `[[contact]]` | | none | any number | contact of two bodies, without friction
  unless it is given
kind | | `"unilateral"` | `"unilateral"`, `"tied"` | the sides may part, or move as one
  ([below](#ties))
nonmortar | | | `{ body = "name", label = 1 }` | the side that carries the contact pressure and its conditions
mortar | | | `{ body = "name", label = 3 }` | the other side
sides | | | `[{ body = "a", label = 1 }, { body = "b", label = 3 }]` | the two sides in any order, in place of
  `nonmortar` and `mortar`: the program chooses (below)
variant | | `"mortar"`, with `degree = 2` `"weighted"` | `"interpolation"`, `"mortar"`, `"weighted"` | how
  non-penetration is imposed: at the nodes, by the L2 projection of the gap, or by means of the gap weighted
  with the hat functions of the nonmortar vertices, whose pressure is nowhere negative
  ([theory](theory.md#contact-one-set-of-rows)); each with `degree` 1 or 2
stabilised | | true where `variant` is left out, without `accuracy.bound` | true, false |
  conditions yield where the mortar side is the coarser one, so that pressures do not alternate from node to
  node ([below](#contact-lines)); not with `"interpolation"`
swap | | false | true, false | exchanges the sides, given or chosen: a short way to try the other one
initial | | `"as-meshed"` | `"as-meshed"`, `"close"`, `"reject"` | the distance of the bodies as drawn is kept
  (a penetration of up to a hundredth of the shorter line is a negative distance); or set to zero; or a scene
  whose bodies do not touch is rejected
gap | m | as drawn | datum | distance at the nonmortar nodes (`check` warns where it varies between them), in
  place of that as drawn: positive apart, negative for an interference; a gap that changes in time does
  work on the bodies ([below](#distances-that-change))
friction | | 0 | >= 0 | Coulomb's coefficient, the largest ratio of shear stress to pressure: below it
  the bodies stick ([below](#friction))
shear_limit | Pa | 0 | >= 0, without `friction` | Tresca's law: the shear stress at which the surfaces slip,
  pressed or not
sliding | | `"refuse"` | `"refuse"`, `"allow"`, `"finite"` | slips are taken as small. Where a node that is
  pressed slides past the end of the line that it touches, by more than an edge and a tenth of that line, the
  run ends (exit code 1, with the state so far in `DIR.failed`), or goes on; with `"finite"` contact follows
  the bodies, however far they slide ([below](#finite-sliding))
coupling | | `"kinematic"` | `"kinematic"`, `"distributing"` | of a tie to a tool of shape `"point"`: each
  node of the side follows it, or their weighted mean motion does ([below](#couplings-springs-and-bolts))
along | | all | a list of `"x"`, `"y"`, `"z"` | of a tie: the axes along which sides move as one
stiffness | N/m^3 | rigid | > 0 | of a tie: traction over the distance that it makes, of a layer of glue or of
  springs
offset | | none | the name of a tool of shape point | of a tie: its motion is that of the first side (of
  `sides`, or `nonmortar`) past the other one
[contact.sides contact.nonmortar contact.mortar]
body, label
[quantity] `[[quantity]]` | | none | any number | a number of every step, in `history.csv`, the log and
  `summary.json` ([below](#quantities))
name | | | letters, digits, `_`, `-`; each once | the column
reaction | N/m | | `{ body = "name", label = 1 }`, `{ body = "name", point = [x, y] }`, of a tool
  `{ body = "name" }` | what the supports of the label, or of the point, exert on the body, or what moves
  a tool
contact_force | N/m | | `{ body = "name", label = 1 }`, of a tool also `{ body = "name" }` | what contact
  exerts on the body along the label
displacement | m | | `{ body = "name", point = [x, y] }`, `{ body = "name", label = 1 }`, of a tool also
  `{ body = "name" }` | at a point (where it was at t = 0), the mean over a label, or of `at`
stored_energy | J/m | | `{ body = "name" }` | recoverable energy of the body: elastic energy, and that
  of hardening and of both springs of a standard solid; of a user-defined law the elastic energy alone
dissipated_energy | J/m | | `{ body = "name" }` | energy turned into heat since the run began: time integral
  of (s - X) : G, X the back stress of `kinematic_hardening` or of the spring parallel to the dashpot of a
  standard solid, X = 0 for a user-defined law
work | J/m | | `{ body = "name" }` | work of all forces on the body since t = 0, contact forces included
external_work | J/m | | `{ body = "name" }` | work of loads and supports on the body since t = 0
thermal_work | J/m | | `{ body = "name" }` | work of the thermal strain on the body since t = 0
largest_pressure | Pa | | `{ body = "name", label = 1 }` | the largest contact pressure on the side, and where
contact_length | m | | `{ body = "name", label = 1 }` | length of the part of the side that is in contact,
  twice the half-width of a round body; off by half an element at each end
contact_area | m^2 | | `{ body = "name", label = 1 }` | with `dimension = 3`: area of the part of the side
  that is in contact; off by half an element along its border
largest_mises | Pa | | `{ body = "name" }` | the largest von Mises stress in the body, and where
friction_work | J/m | | `{ body = "name", label = 1 }` | energy dissipated by friction along the side since
  the run began
mean_pressure | Pa | | `{ body = "name", label = 1 }`, with `from = [x, y]` and `to = [x, y]`, with `margin` |
  the mean of the contact pressure over the side, or over the part of it between two points
  ([below](#quantities))
component | | | `"x"`, `"y"`, `"moment"` (of forces), `"rotation"` (of a tool); with `dimension = 3` `"x"`,
  `"y"`, `"z"`, of forces `"moment_x"`, `"moment_y"`, `"moment_z"`, of a tool `"rotation_x"`,
  `"rotation_y"`, `"rotation_z"` | of reactions, contact forces and
  displacements; moments [N], in space [N m], and rotations [rad] are counterclockwise
about | m | the origin, of a tool `at` | `[x, y]`, in space `[x, y, z]` | the point of a moment
[quantity.stored_energy quantity.dissipated_energy quantity.work quantity.external_work quantity.thermal_work
  quantity.largest_mises]
body
[quantity.contact_force quantity.largest_pressure quantity.contact_length quantity.contact_area
  quantity.friction_work]
body, label
[quantity.reaction quantity.displacement]
body, label
point | m
[quantity.mean_pressure]
body, label
from, to | m
margin | m | 0 | >= 0
[stage] `[[stage]]` | | none | any number | a part of the loading, a run that goes on from the one before
  ([below](#stages))
name | | | letters, digits, `_`, `-`; each once | of the result: `OUT-NAME`, that of the last is `OUT`
end | s | | > 0 | its `time.end`
steps | | those before | integer >= 1 | its `time.steps`
set | | none | a list of `"key=value"` | what it [changes](#changing-keys-from-the-command-line) of the stage
  before
[time] `[time]` | | | table |
end | s | | > 0 | final time T; a run begins at 0
steps | | | integer >= 1 | equal steps; together with `tolerance` not needed: the first step tried is
  `end/steps`
scheme | | `"backward-euler"` | `"backward-euler"`, `"crank-nicolson"`, `"sdirk2"` | orders 1, 2, 2;
  crank-nicolson rings where steps are longer than the relaxation time (a warning says so), sdirk2 (two stages
  a step) does not
tolerance | | none: equal steps | between 0 and 1 | steps chosen by their error (below); with `sdirk2` or
  `backward-euler`
max_steps | | 100000 | integer >= 1 | together with `tolerance`: steps tried, rejected ones included, before
  the run is given up
breaks | s | none | array of times inside the run | together with `tolerance`: times at which a step must end,
  besides the points of tables and the kinks and jumps that are found
[datum]
time, value
[solver] `[solver]` | | | table | rarely needed
method | | `"newton"` | `"newton"`, `"penalty-duality"` | how a step is solved: the second is the note's own
  algorithm, kept for comparison (docs/theory.md says where it is slow)
tolerance | | 1e-10 | between 0 and 1 | material residual of a converged step, over the yield stress (or the
  largest stress of the body, where that is larger)
max_iterations | | 4000; penalty-duality 5000 | integer >= 1 | linear solves in one step before it is given up
linear | | `"multifrontal"` | `"multifrontal"`, `"suitesparse"`, `"single"` | our own factorisation
  (SuiteSparse where it fails), SuiteSparse only, or our own in single precision, corrected, where bodies in
  space have a symmetric tangent; large linear bodies in space always have it
reduce | | true | true, false | leave out what changes nothing ([theory.md](theory.md), "What is left out");
  false factorises in every iteration and solves every step
list_solutions | | false | true, false | with friction, look for other solutions of every step
  ([below](#friction))
[accuracy] `[accuracy]` | | none | table | meshes and steps are refined until the error is small enough; a
  bound of the error that is proved ([below](#accuracy))
energy | | | between 0 and 1 | refine meshes and steps until the relative error in energy is less (may be left
  out together with `bound`); not with `variant = "interpolation"` (at degree 2 with `"weighted"` only),
  `scheme = "crank-nicolson"` and `method = "penalty-duality"`
quantity | | | name of a quantity | in place of `energy`: what refinement aims at ([below](#accuracy));
  elastic bodies, `degree = 1`
tolerance | | | between 0 and 1 | together with `quantity`: the relative error of its value that is asked for
max_unknowns | | 1e6 | > 0 | end with what is reached before a round has more
max_seconds | s | none | > 0 | end with what is reached before it takes longer (wall time); a round that does
  not end in time is stopped
bound | | false | true, false | a bound of the error of the stress at the end, proved for elastic bodies
  ([bounds.md](bounds.md))
[output] `[output]` | | | table |
every | | 0 | integer >= 0 | fields and contact are kept for the steps 0, k, 2k, ... and the last one; 0: the
  last one only
state | | false | true, false | the result has the last state, with which another run may `start`
[check] `[check]` | | | table |
allow | | none | list of ids | warnings of `mortier check` that are meant as they are ([check.md](check.md))
)";

}  // namespace mortier
