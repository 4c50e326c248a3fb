"""Meshes that cannot be used, and meshes that are doubtful."""
from seeded.case import Mesh, fault


# Meshes that cannot be used.
@fault("mesh-file", "upper.mesh:1")
def _(case):
    case.raw["upper.mesh"] = "solid cube\n"


@fault("clockwise-triangle", "upper.mesh:")
def _(case):
    t = case.upper.triangles[3]
    t[0], t[1] = t[1], t[0]


@fault("degenerate-triangle", "upper.mesh:")
def _(case):
    a, b, c, _ = case.upper.triangles[0]
    (xa, ya), (xb, yb) = case.upper.vertices[a - 1], case.upper.vertices[b - 1]
    case.upper.vertices[c - 1] = [(xa + xb) / 2, (ya + yb) / 2]


fault("repeated-triangle", "upper.mesh:")(lambda case: case.upper.triangles.append(case.upper.triangles[5]))
fault("unused-vertex", "upper.mesh:")(lambda case: case.upper.vertex(0.5, 0.5))


@fault("overlapping-triangles", "upper.mesh:")
def _(case):
    a, b, c, r = case.upper.triangles[20]
    case.upper.triangles.append([a, b, case.upper.vertex(0.45, 0.9), r])


@fault("label-inside", "upper.mesh:")
def _(case):
    a, _, c, _ = case.upper.triangles[0]
    case.upper.edges.append([a, c, 5])


fault("label-twice", "upper.mesh:")(lambda case: case.upper.edges.append(case.upper.edges[0][:2] + [5]))


# Meshes that are doubtful.
@fault("mesh-parts", "upper.mesh: triangle")
def _(case):
    case.upper.add(Mesh(2, 0, 2.2, 0.2, 2, 2))
    case.upper.relabel(lambda x, y, label: label if x <= 1 else 7)


@fault("hinge", "upper.mesh: vertex")
def _(case):
    corner = case.upper.triangles[0][0]
    x, y = case.upper.vertices[corner - 1]
    case.upper.triangles.append([corner, case.upper.vertex(x - 0.2, y + 0.3), case.upper.vertex(x - 0.2, y),
                                 1])


@fault("duplicate-node", "upper.mesh: vertex")
def _(case):
    other = Mesh(1, 1, 1.5, 1.5, 3, 3)
    other.relabel(lambda x, y, label: 7)
    case.upper.add(other)


def cut(mesh, keep=lambda x, y: False):
    """Doubles the vertices of the line y = 1/2 for the triangles above it."""
    double = {}
    for v, (x, y) in enumerate(list(mesh.vertices), 1):
        if abs(y - 0.5) < 1e-12 and not keep(x, y) and any(
                v in t[:3] and mesh.vertices[t[2] - 1][1] > 0.5 for t in mesh.triangles):
            double[v] = mesh.vertex(x, y)
    for t in mesh.triangles:
        if mesh.vertices[t[2] - 1][1] > 0.5:
            t[:3] = [double.get(v, v) for v in t[:3]]
    for e in mesh.edges:
        if sum(mesh.vertices[v - 1][1] for v in e[:2]) > 1:
            e[:2] = [double.get(v, v) for v in e[:2]]


fault("crack", "upper.mesh: vertex")(lambda case: cut(case.upper, keep=lambda x, y: x < 0.4))


@fault("hanging-node", "upper.mesh: vertex")
def _(case):
    other = Mesh(1, 0, 2, 1, 4, 9)
    other.relabel(lambda x, y, label: 7)
    case.upper.edges = [e for e in case.upper.edges if e[2] != 2]
    case.upper.add(other)


@fault("mesh-overlaps-itself", "upper.mesh: triangle")
def _(case):
    other = Mesh(0.9, 0.55, 1.7, 0.95, 3, 3)
    other.relabel(lambda x, y, label: 7)
    case.upper.add(other)


@fault("sliver", "upper.mesh: triangle")
def _(case):
    case.upper.vertices[case.upper.triangles[60][2] - 1][1] -= 0.0825


@fault("mesh-changed", "quads.mesh")
def _(case):
    case.raw["quads.mesh"] = ("MeshVersionFormatted 2\nDimension 2\nVertices\n16\n" +
                              "".join(f"{i / 3} {1 - j / 3} 0\n" for j in (3, 2, 1, 0) for i in range(4)) +
                              "Edges\n12\n" +
                              "".join(f"{k + 1} {k + 2} 1\n{k + 13} {k + 14} 3\n"
                                      f"{4 * k + 1} {4 * k + 5} 4\n{4 * k + 4} {4 * k + 8} 2\n"
                                      for k in range(3)) + "Quadrilaterals\n9\n" +
                              "".join(f"{v} {v + 1} {v + 5} {v + 4} 1\n"
                                      for v in (1, 2, 3, 5, 6, 7, 9, 10, 11)) + "End\n")
    case.scene = case.scene.replace("upper.mesh", "quads.mesh")
