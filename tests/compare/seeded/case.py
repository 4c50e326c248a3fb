"""A sound scene of two blocks with its meshes, for faults to be seeded into."""
import resource

SCENE = """\
[[body]]
name = "upper"
mesh = "upper.mesh"
material = { young = 3e11, poisson = 0.3, viscosity = 10, yield_stress = 1 }
[[body.boundary]]
label = 4
ux = 0
[[body.boundary]]
label = 3
ty = "-10*t"

[[body]]
name = "lower"
mesh = "lower.mesh"
material = { young = 3e11, poisson = 0.3, viscosity = 10, yield_stress = 1 }
[[body.boundary]]
label = 4
ux = 0
[[body.boundary]]
label = 1
uy = 0

[contact]
nonmortar = { body = "upper", label = 1 }
mortar = { body = "lower", label = 3 }

[time]
end = 1
steps = 100
"""
ELASTIC = SCENE.replace(", viscosity = 10, yield_stress = 1",
                        "").replace('"-10*t"', "-10").replace("100", "1")

# A body of its own, on third.mesh.
THIRD = """\
[[body]]
name = "third"
mesh = "third.mesh"
material = { young = 3e11, poisson = 0.3 }
boundary = [ { label = 1, ux = 0, uy = 0 } ]

"""


class Mesh:
    """A rectangle of nx x ny cells cut by both diagonals; labels 1 bottom, 2 right, 3 top, 4 left."""

    def __init__(self, x0, y0, x1, y1, nx, ny):
        self.vertices, self.triangles, self.edges = [], [], []
        at = {}
        for j in range(ny + 1):
            for i in range(nx + 1):
                at[i, j] = self.vertex(x0 + (x1 - x0) * i / nx, y0 + (y1 - y0) * j / ny)
        for j in range(ny):
            for i in range(nx):
                corners = [at[i, j], at[i + 1, j], at[i + 1, j + 1], at[i, j + 1]]
                centre = self.vertex(x0 + (x1 - x0) * (i + 0.5) / nx, y0 + (y1 - y0) * (j + 0.5) / ny)
                for k in range(4):
                    self.triangles.append([corners[k], corners[(k + 1) % 4], centre, 1])
        for i in range(nx):
            self.edges += [[at[i, 0], at[i + 1, 0], 1], [at[i + 1, ny], at[i, ny], 3]]
        for j in range(ny):
            self.edges += [[at[nx, j], at[nx, j + 1], 2], [at[0, j + 1], at[0, j], 4]]

    def vertex(self, x, y):
        self.vertices.append([x, y])
        return len(self.vertices)

    def add(self, other):
        """Another mesh beside this one, as a part of it."""
        shift = len(self.vertices)
        self.vertices += other.vertices
        self.triangles += [[a + shift, b + shift, c + shift, r] for a, b, c, r in other.triangles]
        self.edges += [[a + shift, b + shift, label] for a, b, label in other.edges]

    def move(self, function):
        self.vertices = [list(function(x, y)) for x, y in self.vertices]

    def relabel(self, function):
        """function(x, y, label) of the middle of each labelled edge."""
        for edge in self.edges:
            (xa, ya), (xb, yb) = self.vertices[edge[0] - 1], self.vertices[edge[1] - 1]
            edge[2] = function((xa + xb) / 2, (ya + yb) / 2, edge[2])

    def write(self, path):
        lines = ["MeshVersionFormatted 2", "Dimension 2", "Vertices", str(len(self.vertices))]
        lines += [f"{x!r} {y!r} 0" for x, y in self.vertices]
        lines += ["Edges", str(len(self.edges))] + [" ".join(map(str, e)) for e in self.edges]
        lines += ["Triangles", str(len(self.triangles))] + [" ".join(map(str, t)) for t in self.triangles]
        path.write_text("\n".join(lines + ["End", ""]))


class Case:
    def __init__(self, scene=SCENE):
        self.scene = scene
        self.upper = Mesh(0, 0, 1, 1, 6, 6)
        self.lower = Mesh(0, -1, 1, 0, 8, 8)
        self.third = Mesh(5, -1, 6, 0, 8, 8)
        self.raw = {}
        self.limit = None  # of the memory that a run may take [bytes]

    def replace(self, old, new, count=1):
        assert old in self.scene, old
        self.scene = self.scene.replace(old, new, count)

    def write(self, folder):
        (folder / "scene.toml").write_text(self.scene)
        self.upper.write(folder / "upper.mesh")
        self.lower.write(folder / "lower.mesh")
        self.third.write(folder / "third.mesh")
        for name, text in self.raw.items():
            (folder / name).write_text(text)

    def limited(self):
        """Options of the process that runs it."""
        return ({"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_AS, (self.limit,) * 2)}
                if self.limit else {})

    def line(self, text):
        """Where the scene says it first."""
        return f"scene.toml:{self.scene[:self.scene.index(text)].count(chr(10)) + 1}"


FAULTS = []


def fault(identifier, place, scene=SCENE):
    """Declares a seeded fault: what to name, and where (a line that holds the text, or the place itself)."""
    def declare(seed):
        FAULTS.append((identifier, place, scene, seed))
        return seed
    return declare
