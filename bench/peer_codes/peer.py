"""What the drivers of other codes share: the problem as read from a scene, P1 fields, the result file.

A driver is a program `NAME_code.py PROBLEM.json RESULT.npz`; the problem is the scene's document (scene.py).
"""
import json
import sys

import numpy as np

import scene
from expressions import Expression
from problems import RunFailure


class Mesh(scene.Mesh):
    def edges_of(self, label):
        return self.edges[self.labels == label]

    def nodes_of(self, label):
        return np.unique(self.edges_of(label))

    def line(self, label):
        """Nodes of a boundary line in its order; an open one from the end that is first in x, then y."""
        beside = {}
        for a, b in self.edges_of(label).tolist():
            beside.setdefault(a, []).append(b)
            beside.setdefault(b, []).append(a)
        ends = [node for node, next_ones in beside.items() if len(next_ones) == 1] or list(beside)
        line = [min(ends, key=lambda node: tuple(self.points[node]))]
        seen = set(line)
        while onward := [node for node in beside[line[-1]] if node not in seen]:
            line.append(onward[0])
            seen.add(onward[0])
        return np.array(line)

    def areas(self):
        a, b, c = (self.points[self.triangles[:, i]] for i in range(3))
        return ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2


class Body:
    def __init__(self, description):
        self.name = description["name"]
        self.mesh = Mesh(description["mesh"])
        material = description["material"]
        self.young, self.poisson = float(material["young"]), float(material["poisson"])
        self.viscosity = material.get("viscosity")
        self.yield_stress = material.get("yield_stress")
        self.projection = material.get("projection", "frobenius")
        self.displacements, self.tractions = [], []  # (label, component, Expression)
        for condition in description.get("boundary", []):
            for key, where in (("ux", self.displacements), ("uy", self.displacements), ("tx", self.tractions),
                               ("ty", self.tractions)):
                if key in condition:
                    where.append((condition["label"], "xy".index(key[1]), Expression(condition[key])))
            if unknown := set(condition) - {"label", "ux", "uy", "tx", "ty"}:
                raise RunFailure(f"condition {min(unknown)} is not known to this driver")
        if "force" in description:
            raise RunFailure("a body force is not known to this driver")
        if "point" in description:
            raise RunFailure("a support at a point is not known to this driver")

    def strain(self, u):
        """(e11, e22, 2 e12) by triangle."""
        gradients, triangles = self.gradients(), self.mesh.triangles
        g = np.einsum("tki,tkj->tij", u[triangles], gradients)
        return np.column_stack([g[:, 0, 0], g[:, 1, 1], g[:, 0, 1] + g[:, 1, 0]])

    def gradients(self):
        """Of the hat functions, triangles x 3 x 2."""
        a, b, c = (self.mesh.points[self.mesh.triangles[:, i]] for i in range(3))
        det = 2 * self.mesh.areas()[:, None]
        turned = [np.column_stack([e[:, 1], -e[:, 0]]) for e in (c - b, a - c, b - a)]
        return np.stack([-each / det for each in turned], 1)

    def elastic_stress(self, strain):
        c = self.young / (1 - self.poisson**2)
        e11, e22, g12 = strain.T
        return np.column_stack([c * (e11 + self.poisson * e22), c * (e22 + self.poisson * e11),
                                c * (1 - self.poisson) / 2 * g12])

    def nodal_forces(self, stress):
        """sum |T| B' s, vertices x 2."""
        s11, s22, s12 = stress.T
        tensor = np.stack([np.column_stack([s11, s12]), np.column_stack([s12, s22])], 1)
        parts = np.einsum("t,tki,tij->tkj", self.mesh.areas(), self.gradients(), tensor)
        forces = np.zeros_like(self.mesh.points)
        np.add.at(forces, self.mesh.triangles, parts)
        return forces


class Problem:
    def __init__(self, path):
        with open(path) as file:
            document = json.load(file)
        self.bodies = {each["name"]: Body(each) for each in document["body"]}
        if document.get("plane", "stress") != "stress":
            raise RunFailure("plane strain, expected plane stress (all that this driver knows)")
        if len(self.bodies) != 2 or len(document["contact"]) != 1:
            raise RunFailure("expected two bodies and one interface (all that this driver knows)")
        contact = document["contact"][0]
        self.nonmortar, self.nonmortar_label = contact["nonmortar"]["body"], contact["nonmortar"]["label"]
        self.mortar, self.mortar_label = contact["mortar"]["body"], contact["mortar"]["label"]
        self.variant = contact.get("variant", "mortar")
        self.end, self.steps = float(document["time"]["end"]), int(document["time"]["steps"])
        self.flows = any(body.viscosity for body in self.bodies.values())

    def largest_load(self):
        return max((np.abs(value(*body.mesh.points[body.mesh.nodes_of(label)].T, self.end)).max()
                    for body in self.bodies.values() for label, _, value in body.tractions),
                   default=1.0) or 1.0

    def contact_of(self, displacements, stresses):
        """Vertex, position, gap and nodal force of the nonmortar nodes; forces from equilibrium there."""
        body, other = self.bodies[self.nonmortar], self.bodies[self.mortar]
        nodes, line = body.mesh.line(self.nonmortar_label), other.mesh.line(self.mortar_label)
        position, across = body.mesh.points[nodes], other.mesh.points[line]
        along = across[-1] - across[0]
        along /= np.hypot(*along)
        normal = np.array([along[1], -along[0]])
        inside = body.mesh.points.mean(0) - position.mean(0)
        if normal @ inside > 0:
            normal = -normal  # outward of the nonmortar body
        s, t = position @ along, across @ along
        far = np.column_stack([np.interp(s, t, (displacements[self.mortar][line] + across)[:, c])
                               for c in (0, 1)])
        gap = (far - position - displacements[self.nonmortar][nodes]) @ normal
        force = -body.nodal_forces(stresses[self.nonmortar])[nodes] @ normal
        return nodes, position, gap, force


def main(code, solve):
    """Runs a driver: solve(problem) gives displacements and stresses by body, and facts for the summary."""
    try:
        problem = Problem(sys.argv[1])
        displacements, stresses, facts = solve(problem)
    except RunFailure as error:
        sys.exit(f"{code}: {error}")
    data = {}
    for name, body in problem.bodies.items():
        data |= {f"{name}.displacement": displacements[name], f"{name}.stress": stresses[name],
                 f"{name}.points": body.mesh.points, f"{name}.triangles": body.mesh.triangles}
    keys = ("vertex", "position", "gap", "force")
    data |= {f"contact.{k}": v for k, v in zip(keys, problem.contact_of(displacements, stresses))}
    facts |= {"code": code, "bodies": list(problem.bodies), "steps": problem.steps}
    np.savez(sys.argv[2], facts=json.dumps(facts), **data)
