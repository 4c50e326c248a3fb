"""A scene in CalculiX (ccx): elastic bodies as a slab one wedge (C3D6) thick that is free to thin, which is
plane stress; frictionless face-to-face penalty contact, the slave side nonmortar. Its own solver,
one increment a step.

What it cannot express: Perzyna's law with the note's projections (its viscoplastic laws are others), and
contact without a penalty between linear wedges (its mortar needs quadratic ones). Its tables carry 7 digits.
Environment: CCX, the program.
"""
import os
from pathlib import Path

import numpy as np

import peer
from problems import RunFailure
from process import measured

YOUNG, LOAD = 2e5, 100.0  # of the scaled problem
PENALTY = 50  # slope of pressure over penetration, times E over one metre
REAL = ".12e"  # it reads 20 characters
FACE = {(0, 1): "S3", (1, 2): "S4", (0, 2): "S5"}  # of a wedge, by the corners of its triangle


def solve(problem):
    if problem.flows:
        raise RunFailure("Perzyna's law with the note's projection cannot be expressed")
    if problem.variant == "interpolation":
        raise RunFailure("contact by interpolation cannot be expressed (face-to-face penalty only)")
    young = max(body.young for body in problem.bodies.values())
    load = problem.largest_load()
    thickness = float(np.mean([np.sqrt(body.mesh.areas().mean()) for body in problem.bodies.values()]))
    first, count = {}, 0
    for name, body in problem.bodies.items():
        first[name] = count
        count += len(body.mesh.points)
    write_input(problem, first, count, thickness, young, load)
    cost, output = measured([os.environ.get("CCX", "ccx"), "problem"])
    if "*ERROR" in output:
        raise RunFailure(output[output.index("*ERROR"):].splitlines()[0])
    u, s = read_tables(Path("problem.dat"), count,
                       sum(len(b.mesh.triangles) for b in problem.bodies.values()))
    displacements, stresses, done = {}, {}, 0
    for name, body in problem.bodies.items():
        rows = slice(first[name], first[name] + len(body.mesh.points))
        displacements[name] = (u[:count][rows] + u[count:][rows]) / 2 * load / LOAD * YOUNG / young
        stresses[name] = s[done:done + len(body.mesh.triangles)] * load / LOAD
        done += len(body.mesh.triangles)
    iterations = output.count("iteration ")
    return displacements, stresses, {"iterations": iterations, "wall_time": cost.wall_time,
                                     "processor_time": cost.processor_time, "memory": cost.memory}


def write_input(problem, first, count, thickness, young, load):
    lines = ["*NODE, NSET=ALL"]
    for layer in (0, 1):
        for name, body in problem.bodies.items():
            base = layer * count + first[name] + 1
            lines += [f"{base + i}, {x:{REAL}}, {y:{REAL}}, {layer * thickness:{REAL}}"
                      for i, (x, y) in enumerate(body.mesh.points.tolist())]
    element, surfaces = 1, {}
    for k, (name, body) in enumerate(problem.bodies.items()):
        lines.append(f"*ELEMENT, TYPE=C3D6, ELSET=BODY{k}")
        corners = body.mesh.triangles + first[name] + 1
        lines += [f"{element + i}, {a}, {b}, {c}, {a + count}, {b + count}, {c + count}"
                  for i, (a, b, c) in enumerate(corners.tolist())]
        label = problem.nonmortar_label if name == problem.nonmortar else problem.mortar_label
        surfaces[name] = faces(body.mesh, label, element)
        element += len(corners)
        lines += [f"*MATERIAL, NAME=M{k}", "*ELASTIC",
                  f"{body.young / young * YOUNG:{REAL}}, {body.poisson:{REAL}}",
                  f"*SOLID SECTION, ELSET=BODY{k}, MATERIAL=M{k}"]
    for name, word in ((problem.nonmortar, "SLAVE"), (problem.mortar, "MASTER")):
        lines += [f"*SURFACE, NAME={word}, TYPE=ELEMENT", *surfaces[name]]
    lines += ["*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
              f"{PENALTY * YOUNG:{REAL}}",
              f"*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE, ADJUST={1e-6 * thickness:.3e}",
              "SLAVE, MASTER"]
    lines.append("*BOUNDARY")
    lines += [f"{i + 1}, 3, 3" for i in range(count)]
    for step in range(1, problem.steps + 1):
        time = problem.end * step / problem.steps
        lines += ["*STEP, INC=1000", "*STATIC", "1., 1."]
        lines += ["*BOUNDARY", *supports(problem, first, count, time, young / YOUNG * LOAD / load),
                  "*CLOAD, OP=NEW"]
        lines += loads(problem, first, count, time, thickness, LOAD / load)
        if step == problem.steps:
            lines += ["*NODE PRINT, NSET=ALL", "U"]
            for k in range(len(problem.bodies)):
                lines += [f"*EL PRINT, ELSET=BODY{k}", "S"]
        lines.append("*END STEP")
    Path("problem.inp").write_text("\n".join(lines) + "\n")


def faces(mesh, label, element):
    wanted = {tuple(sorted(edge)) for edge in mesh.edges_of(label).tolist()}
    found = []
    for t, corners in enumerate(mesh.triangles.tolist()):
        for (i, j), face in FACE.items():
            if tuple(sorted((corners[i], corners[j]))) in wanted:
                found.append(f"{element + t}, {face}")
    return found


def supports(problem, first, count, time, factor):
    given = {}
    for name, body in problem.bodies.items():
        for label, component, value in body.displacements:
            nodes = body.mesh.nodes_of(label)
            for node, u in zip(nodes.tolist(), value(*body.mesh.points[nodes].T, time).tolist()):
                given[first[name] + node + 1, component + 1] = u * factor
    return [f"{node + layer * count}, {dof}, {dof}, {u:{REAL}}" for (node, dof), u in given.items()
            for layer in (0, 1)]


def loads(problem, first, count, time, thickness, factor):
    total = {}
    for name, body in problem.bodies.items():
        for label, component, value in body.tractions:
            for i, j in body.mesh.edges_of(label).tolist():
                ends = body.mesh.points[[i, j]]
                h = np.hypot(*(ends[1] - ends[0]))
                a, b = value(*ends.T, time)
                for node, f in ((i, h * (2 * a + b) / 6), (j, h * (a + 2 * b) / 6)):
                    key = first[name] + node + 1, component + 1
                    total[key] = total.get(key, 0.0) + f * thickness / 2 * factor
    return [f"{node + layer * count}, {dof}, {f:{REAL}}" for (node, dof), f in total.items()
            for layer in (0, 1)]


def read_tables(path, count, triangles):
    """Displacements of both layers, nodes x 2, and mean stresses, triangles x 3, of the last increment."""
    u, s = np.zeros((2 * count, 2)), np.zeros((triangles, 3))
    points = np.zeros(triangles)
    kind = ""
    try:
        lines = path.read_text().splitlines()
    except OSError as error:
        raise RunFailure("no result") from error
    for line in lines:
        if "displacements" in line:
            kind = "u"
        elif "stresses" in line:
            kind = "s"
        elif (words := line.split()) and kind == "u":
            u[int(words[0]) - 1] = float(words[1]), float(words[2])
        elif words and kind == "s":
            t = int(words[0]) - 1
            s[t] += float(words[2]), float(words[3]), float(words[5])
            points[t] += 1
    if not points.all():
        raise RunFailure("no stresses in the result: the last increment did not converge")
    return u, s / points[:, None]


if __name__ == "__main__":
    peer.main("CalculiX", solve)
