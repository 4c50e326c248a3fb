"""A scene in GetFEM (python3-getfem), through its own bricks: P1, contact by the nodal brick (variant
interpolation) or the integral brick with a fine quadrature (variant mortar: the nearest that it has),
Alart-Curnier's augmented Lagrangian, its own Newton's method.

Solved with E = 1 and loads over the largest one: GetFEM stops at an absolute residual.
"""
import getfem as gf
import numpy as np

import peer
from problems import RunFailure

CONTACT, FIRST_LABEL = 1, 100  # regions
RESIDUAL = 1e-9  # of the scaled problem
ITERATIONS = 100


class GetfemBody:
    def __init__(self, body):
        self.body = body
        points, triangles = body.mesh.points, body.mesh.triangles
        self.mesh = gf.Mesh("empty", 2)
        self.mesh.add_convex(gf.GeoTrans("GT_PK(2,1)"),
                             np.ascontiguousarray(points[triangles].transpose(2, 1, 0)))
        self.scalar = self.fem(1, "FEM_PK(2,1)")
        self.vector = self.fem(2, "FEM_PK(2,1)")
        nodes = self.scalar.basic_dof_nodes()
        ours, theirs = np.lexsort(points.T), np.lexsort(nodes)
        if len(ours) != len(theirs) or np.abs(points[ours] - nodes[:, theirs].T).max() > 0:
            raise RunFailure("vertices do not come back")
        self.vertex = np.empty(len(ours), int)  # of a scalar dof
        self.vertex[theirs] = ours
        corner = {}
        for t, (a, b, c) in enumerate(triangles.tolist()):
            for face, edge in enumerate(((b, c), (a, c), (a, b))):
                corner[min(edge), max(edge)] = (t, face)
        for label in np.unique(body.mesh.labels):
            faces = [corner[min(e), max(e)] for e in body.mesh.edges_of(label).tolist()]
            self.mesh.set_region(FIRST_LABEL + int(label), np.array(faces).T)

    def fem(self, components, name):
        fem = gf.MeshFem(self.mesh, components)
        fem.set_fem(gf.Fem(name))
        return fem

    def nodal(self, values):
        """Vertex values as GetFEM orders them."""
        return np.asarray(values)[self.vertex]

    def displacement(self, values):
        u = np.empty_like(self.body.mesh.points)
        u[self.vertex] = values.reshape(-1, 2)
        return u


def solve(problem):
    if problem.flows:
        raise RunFailure("Perzyna's law is not known to this driver")
    bodies = {name: GetfemBody(body) for name, body in problem.bodies.items()}
    young = max(body.young for body in problem.bodies.values())
    load = problem.largest_load()
    model = gf.Model("real")
    set_load = []
    for i, (name, body) in enumerate(bodies.items()):
        given = body.body
        rule = gf.MeshIm(body.mesh, gf.Integ("IM_TRIANGLE(2)"))
        u = f"u{i}"
        model.add_fem_variable(u, body.vector)
        scaled = given.young / young
        model.add_initialized_data(f"lambda{i}", [scaled * given.poisson / (1 - given.poisson**2)])
        model.add_initialized_data(f"mu{i}", [scaled / (2 * (1 + given.poisson))])
        model.add_isotropic_linearized_elasticity_brick(rule, u, f"lambda{i}", f"mu{i}")
        for k, (label, component, value) in enumerate(given.displacements):
            m, g = f"m{i}_{k}", f"g{i}_{k}"
            model.add_filtered_fem_variable(m, body.scalar, FIRST_LABEL + label)
            model.add_fem_data(g, body.scalar)
            model.add_linear_term(rule,
                                  f"({u}({component + 1}) - {g})*Test_{m} + {m}*Test_{u}({component + 1})",
                                  FIRST_LABEL + label)
            set_load.append((g, body, value, young / load))
        for k, (label, component, value) in enumerate(given.tractions):
            f = f"f{i}_{k}"
            model.add_fem_data(f, body.scalar)
            model.add_linear_term(rule, f"-{f}*Test_{u}({component + 1})", FIRST_LABEL + label)
            set_load.append((f, body, value, 1 / load))
    add_contact(model, bodies, problem)

    iterations = 0
    for step in range(1, problem.steps + 1):
        time = problem.end * step / problem.steps
        for name, body, value, factor in set_load:
            points = body.body.mesh.points
            model.set_variable(name, body.nodal(value(points[:, 0], points[:, 1], time) * factor))
        done, converged = model.solve("max_res", RESIDUAL, "max_iter", ITERATIONS)
        iterations += done
        if not converged:
            raise RunFailure(f"step {step}: no convergence in {done} iterations")
    displacements = {name: body.displacement(model.variable(f"u{i}"))
                     for i, (name, body) in enumerate(bodies.items())}
    displacements = {name: u * load / young for name, u in displacements.items()}
    stresses = {name: body.elastic_stress(body.strain(displacements[name]))
                for name, body in problem.bodies.items()}
    return displacements, stresses, {"iterations": iterations}


def add_contact(model, bodies, problem):
    names = list(bodies)
    slave, master = names.index(problem.nonmortar), names.index(problem.mortar)
    first, second = bodies[problem.nonmortar], bodies[problem.mortar]
    regions = FIRST_LABEL + problem.nonmortar_label, FIRST_LABEL + problem.mortar_label
    model.add_initialized_data("r", [1.0])
    if problem.variant == "interpolation":
        rules = [gf.MeshIm(each.mesh, gf.Integ("IM_TRIANGLE(4)")) for each in (first, second)]
        model.add_nodal_contact_between_nonmatching_meshes_brick(*rules, f"u{slave}", f"u{master}", "p", "r",
                                                                 *regions)
    else:
        rule = gf.MeshIm(first.mesh, gf.Integ("IM_STRUCTURED_COMPOSITE(IM_TRIANGLE(4),8)"))
        model.add_filtered_fem_variable("p", first.scalar, regions[0])
        model.add_integral_contact_between_nonmatching_meshes_brick(rule, f"u{slave}", f"u{master}", "p", "r",
                                                                    *regions)
    # A body that contact alone holds: begin with every node pressed.
    model.set_variable("p", np.full(len(model.variable("p")), -1e-3))


if __name__ == "__main__":
    peer.main("GetFEM", solve)
