"""Labels that are missing, broken off or without use."""
from seeded.case import fault


fault("missing-label", "scene.toml:10")(lambda case: case.replace("label = 3\n", "label = 33\n"))
fault("missing-label", "scene.toml:25")(
    lambda case: case.replace('body = "lower", label = 3', 'body = "lower", label = 9'))
fault("missing-point", "scene.toml:24")(
    lambda case: case.replace("[contact]", "[[body.point]]\nat = [0.5, -0.1]\nux = 0\n[contact]"))


@fault("missing-region", "label = 7")
def _(case):
    case.replace("[contact]",
                 "[[body.region]]\nlabel = 7\nmaterial = { young = 3e11, poisson = 0.3 }\n[contact]")


fault("label-interrupted", "upper.mesh: edge from vertex")(
    lambda case: case.upper.relabel(lambda x, y, label: 8 if y == 1 and 0.4 < x < 0.6 else label))


@fault("label-interrupted", "lower.mesh: edge from vertex")
def _(case):
    case.lower.edges = [e for e in case.lower.edges if not (e[2] == 1 and e[0] in (3, 4))]


fault("unused-label", "upper.mesh: edge from vertex")(
    lambda case: case.upper.relabel(lambda x, y, label: 8 if y == 1 and x > 0.5 else label))


@fault("locked-triangle", "lower.mesh: triangle")
def _(case):
    case.replace("uy = 0", "uy = 0\nux = 0")
    case.replace("label = 4\nux = 0", "label = 4\nux = 0\nuy = 0", 2)
    corner = case.lower.vertices.index([0, -1]) + 1
    a, b = [t for t in case.lower.triangles if corner in t[:3]]
    centre = a[2]
    case.lower.vertices[centre - 1] = [0.09, -0.91]
    right, up = case.lower.vertices.index([0.125, -1]) + 1, case.lower.vertices.index([0, -0.875]) + 1
    case.lower.triangles.remove(a)
    case.lower.triangles.remove(b)
    case.lower.triangles += [[corner, right, up, 1], [right, centre, up, 1]]


@fault("regions-unused", "mesh = \"upper.mesh\"")
def _(case):
    for t in case.upper.triangles[:40]:
        t[3] = 2
