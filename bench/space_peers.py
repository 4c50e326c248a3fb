"""One body in space in every code of bench/peers: its stiffness made, factorised and solved once.

A cube of Kuhn's tetrahedra with quadratic displacements, held below, under a pressure that varies on top.
Each code reads the same vertices and tetrahedra; FreeFEM takes CHOLMOD, the fastest of the direct solvers
that Debian's package has, GetFEM MUMPS, CalculiX SPOOLES. What contact in space costs beside it is not
compared: FreeFEM and GetFEM have no contact of two surfaces by exact integrals, CalculiX a penalty.
"""
import itertools
import json
import os
import shutil
import sys
from pathlib import Path

import numpy as np

from drivers import require_getfem
from problems import RunFailure
from process import measured

YOUNG, POISSON = 1000.0, 0.3
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
BOTTOM, TOP = 1, 2

FREEFEM = """mesh3 Th = readmesh3("cube.mesh");
fespace Vh(Th, [P23d, P23d, P23d]);
real lambda = {young}*{poisson}/((1 + {poisson})*(1 - 2*{poisson})), mu = {young}/(2*(1 + {poisson}));
macro epsilon(u, v, w) [dx(u), dy(v), dz(w), (dy(u) + dx(v))/sqrt(2.), (dz(u) + dx(w))/sqrt(2.),
                        (dz(v) + dy(w))/sqrt(2.)] // EOM
varf a([u, v, w], [r, s, t]) =
  int3d(Th, qfV=qfV2)(lambda*(dx(u) + dy(v) + dz(w))*(dx(r) + dy(s) + dz(t))
                      + 2*mu*(epsilon(u, v, w)'*epsilon(r, s, t)))
  + int2d(Th, {top})(-(1 + x)*t) + on({bottom}, u=0, v=0, w=0);
matrix A = a(Vh, Vh, solver="CHOLMOD", sym=1, positive=1, tgv=1e30);
real[int] b = a(0, Vh, tgv=1e30);
Vh [u, v, w];
u[] = A^-1*b;
cout.precision(12);
cout << "corner " << w(1, 1, 1) << endl;
"""

GETFEM = """import sys
import getfem as gf
import numpy as np
names = "points", "tetrahedra", "top", "bottom"
points, tetrahedra, top, bottom = (np.load(name + ".npy") for name in names)
mesh = gf.Mesh("empty", 3)
mesh.add_convex(gf.GeoTrans("GT_PK(3,1)"), np.ascontiguousarray(points[tetrahedra].transpose(2, 1, 0)))
mesh.set_region(1, bottom)
mesh.set_region(2, top)
space = gf.MeshFem(mesh, 3)
space.set_fem(gf.Fem("FEM_PK(3,2)"))
integration = gf.MeshIm(mesh, gf.Integ("IM_TETRAHEDRON(5)"))
model = gf.Model("real")
model.add_fem_variable("u", space)
young, poisson = {young}, {poisson}
model.add_initialized_data("lambda", young*poisson/((1 + poisson)*(1 - 2*poisson)))
model.add_initialized_data("mu", young/(2*(1 + poisson)))
model.add_isotropic_linearized_elasticity_brick(integration, "u", "lambda", "mu")
model.add_linear_term(integration, "(1 + X(1))*Test_u(3)", 2)
model.add_Dirichlet_condition_with_simplification("u", 1)
model.solve("lsolver", "mumps", "max_res", 1e-9)
nodes = space.basic_dof_nodes()
corner = np.flatnonzero(np.abs(nodes - 1).max(0) < 1e-12)[2]
print("corner", repr(float(model.variable("u")[corner])))
"""


class Cube:
    """Vertices, tetrahedra and the triangles below and on top, by numbers from 0."""

    def __init__(self, cells):
        n = cells + 1
        z, y, x = np.meshgrid(*3 * [np.arange(n)], indexing="ij")
        self.points = np.column_stack([each.ravel() for each in (x, y, z)]) / cells
        low = (np.arange(cells)[:, None, None] * n + np.arange(cells)[:, None]) * n + np.arange(cells)
        tetrahedra = []
        for order in itertools.permutations((1, n, n * n)):
            path = np.cumsum((0, *order))
            positive = order in ((1, n, n * n), (n, n * n, 1), (n * n, 1, n))
            tetrahedra.append(low.ravel()[:, None] + path[[0, 1, 2, 3] if positive else [0, 2, 1, 3]])
        self.tetrahedra = np.concatenate(tetrahedra)
        # Face i is opposite to vertex i.
        self.faces = {}
        for label, height in ((BOTTOM, 0.0), (TOP, 1.0)):
            on = self.points[self.tetrahedra][:, :, 2] == height
            tetrahedron = np.flatnonzero(on.sum(1) == 3)
            self.faces[label] = (tetrahedron, np.argmin(on[tetrahedron], 1))

    def triangles(self, label):
        return np.array([np.delete(self.tetrahedra[t], i) for t, i in zip(*self.faces[label])])

    def write_medit(self, path):
        lines = ["MeshVersionFormatted 2", "Dimension 3", f"Vertices {len(self.points)}"]
        lines += [f"{x!r} {y!r} {z!r} 0" for x, y, z in self.points.tolist()]
        lines += [f"Tetrahedra {len(self.tetrahedra)}"]
        lines += [f"{a} {b} {c} {d} 0" for a, b, c, d in (self.tetrahedra + 1).tolist()]
        triangles = [(*each, label) for label in (BOTTOM, TOP)
                     for each in (self.triangles(label) + 1).tolist()]
        lines += [f"Triangles {len(triangles)}"] + [f"{a} {b} {c} {label}" for a, b, c, label in triangles]
        path.write_text("\n".join([*lines, "End"]) + "\n")

    def with_middles(self):
        """Points and tetrahedra of ten nodes, the middles in the order of CalculiX."""
        pairs = np.array([(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)])
        edges = np.sort(self.tetrahedra[:, pairs], 2)
        unique, number = np.unique(edges.reshape(-1, 2), axis=0, return_inverse=True)
        middles = number.reshape(-1, 6) + len(self.points)
        return (np.vstack([self.points, self.points[unique].mean(1)]),
                np.hstack([self.tetrahedra, middles]))


def write_calculix(cube, path):
    points, tetrahedra = cube.with_middles()
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{i}, {x:.12g}, {y:.12g}, {z:.12g}" for i, (x, y, z) in enumerate(points.tolist(), 1)]
    lines += ["*ELEMENT, TYPE=C3D10, ELSET=BODY"]
    lines += [f"{i}, " + ", ".join(map(str, each)) for i, each in enumerate((tetrahedra + 1).tolist(), 1)]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", f"{YOUNG}, {POISSON}",
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M"]
    lines += ["*BOUNDARY"] + [f"{i}, 1, 3" for i in np.flatnonzero(points[:, 2] == 0) + 1]
    corner = np.flatnonzero((points == 1).all(1))[0] + 1
    lines += ["*NSET, NSET=CORNER", str(corner), "*STEP", "*STATIC, SOLVER=SPOOLES", "*CLOAD"]
    force = np.zeros(len(points))
    for t, i in zip(*cube.faces[TOP]):  # int p phi: a quadratic function times a linear one, on middles
        corners = [k for k in range(4) if k != i]
        ends = points[tetrahedra[t, corners]]
        area = np.linalg.norm(np.cross(ends[1] - ends[0], ends[2] - ends[0])) / 2
        for (a, b), middle in zip(((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)), range(4, 10)):
            if i in (a, b):
                continue
            load = 1 + points[tetrahedra[t, [k for k in corners if k in (a, b)]], 0]
            other = 1 + points[tetrahedra[t, [k for k in corners if k not in (a, b)]], 0]
            force[tetrahedra[t, middle]] += area / 15 * (2 * load.sum() + other[0])
        values = 1 + ends[:, 0]
        force[tetrahedra[t, corners]] += area / 60 * (2 * values - np.roll(values, 1) - np.roll(values, 2))
    lines += [f"{i + 1}, 3, {-force[i]:.12g}" for i in np.flatnonzero(force)]
    lines += ["*NODE PRINT, NSET=CORNER", "U", "*END STEP"]
    path.write_text("\n".join(lines) + "\n")


SCENE = f"""dimension = 3
degree = 2
[[body]]
name = "cube"
mesh = "cube.mesh"
material = {{ young = {YOUNG}, poisson = {POISSON} }}
boundary = [ {{ label = {BOTTOM}, ux = 0, uy = 0, uz = 0 }}, {{ label = {TOP}, tz = "-(1 + x)" }} ]
[[quantity]]
name = "corner"
displacement = {{ body = "cube", point = [1, 1, 1] }}
component = "z"
[time]
end = 1
steps = 1
"""


def corner_of(output):
    words = output.split()
    if "corner" not in words:
        raise RunFailure(f"no result: {output[-200:]}")
    return float(words[words.index("corner") + 1])


def run_mortier(program, folder):
    (folder / "scene.toml").write_text(SCENE)
    cost, output = measured([program, "run", "scene.toml", "--quiet", "--threads", "1", "--out", "out"],
                            cwd=folder, environment=ONE_THREAD)
    summary = json.loads((folder / "out" / "summary.json").read_text())
    return cost, summary["quantities"]["corner"]["value"]


def run_freefem(program, folder):
    if shutil.which(program) is None:
        raise RunFailure(f"{program} is not installed (Debian package freefem++)")
    (folder / "cube.edp").write_text(FREEFEM.format(young=YOUNG, poisson=POISSON, bottom=BOTTOM, top=TOP))
    cost, output = measured([program, "-nw", "-ne", "-v", "0", "cube.edp"], cwd=folder,
                            environment=ONE_THREAD)
    return cost, corner_of(output)


def run_getfem(folder, cube):
    require_getfem()
    np.save(folder / "points.npy", cube.points)
    np.save(folder / "tetrahedra.npy", cube.tetrahedra)
    for name, label in (("top", TOP), ("bottom", BOTTOM)):
        np.save(folder / f"{name}.npy", np.array(cube.faces[label]))
    (folder / "cube.py").write_text(GETFEM.format(young=YOUNG, poisson=POISSON))
    cost, output = measured([sys.executable, "cube.py"], cwd=folder, environment=ONE_THREAD)
    return cost, corner_of(output)


def run_calculix(program, folder, cube):
    if shutil.which(program) is None:
        raise RunFailure("CalculiX is not installed (Debian package calculix-ccx)")
    write_calculix(cube, folder / "cube.inp")
    cost, _ = measured([program, "-i", "cube"], cwd=folder, environment=ONE_THREAD)
    words = (folder / "cube.dat").read_text().split()
    return cost, float(words[-1])


def run(code, folder, cells, mortier):
    """The cost of a code and the displacement of the corner."""
    folder = Path(folder)
    cube = Cube(cells)
    cube.write_medit(folder / "cube.mesh")
    if code == "mortier":
        return run_mortier(mortier, folder)
    if code == "freefem":
        return run_freefem(os.environ.get("FREEFEM", "FreeFem++"), folder)
    if code == "getfem":
        return run_getfem(folder, cube)
    return run_calculix(os.environ.get("CCX", "ccx"), folder, cube)
