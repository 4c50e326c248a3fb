"""One body in space in every code of bench/peers: its stiffness made, factorised and solved once.

A cube of Kuhn's tetrahedra with quadratic displacements, held below, under a pressure that varies on top.
Each code reads the same vertices and tetrahedra; FreeFEM takes CHOLMOD, the fastest of the direct solvers
that Debian's package has, GetFEM MUMPS, CalculiX SPOOLES. What contact in space costs beside it is not
compared: FreeFEM and GetFEM have no contact of two surfaces by exact integrals, CalculiX a penalty.
"""
import json
import os
import shutil
import sys
from pathlib import Path

import meshio
import numpy as np

import results
from drivers import require_getfem
from problems import RunFailure
from process import measured

YOUNG, POISSON = 1000.0, 0.3
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
BOTTOM, TOP = 1, 3

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
data = np.load("cube.npz")
points, tetrahedra, top, bottom = (data[name] for name in ("points", "tetrahedra", "top", "bottom"))
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
    """Vertices, tetrahedra and the triangles below and on top, by numbers from 0, of mortier's shape."""

    def __init__(self, folder, mortier):
        measured([mortier, "run", "scene.toml", "--quiet", "--out", "mesh", "--set", "degree=1"], cwd=folder)
        body = results.read_vtu(folder / "mesh" / "cube_000001.vtu")
        self.points, self.tetrahedra = body.points, body.tetrahedra
        # Face i is opposite to vertex i.
        self.faces = {}
        for label, height in ((BOTTOM, 0.0), (TOP, 1.0)):
            on = self.points[self.tetrahedra][:, :, 2] == height
            tetrahedron = np.flatnonzero(on.sum(1) == 3)
            self.faces[label] = (tetrahedron, np.argmin(on[tetrahedron], 1))

    def write_medit(self, path):
        triangles = [np.delete(self.tetrahedra[t], i)
                     for faces in self.faces.values() for t, i in zip(*faces)]
        labels = [label for label, (tetrahedra, _) in self.faces.items() for _ in tetrahedra]
        meshio.write_points_cells(path, self.points, [("tetra", self.tetrahedra), ("triangle", triangles)],
                                  cell_data={"medit:ref": [np.zeros(len(self.tetrahedra), int), labels]})

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
mesh = {{ shape = "cuboid", cells = CELLS }}
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


def require(program, package):
    if shutil.which(program) is None:
        raise RunFailure(f"{program} is not installed (Debian package {package})")
    return program


def run(code, folder, cells, mortier):
    """The cost of a code and the displacement of the corner."""
    def cost_of(*command):
        return measured(command, cwd=folder, environment=ONE_THREAD)

    folder = Path(folder)
    (folder / "scene.toml").write_text(SCENE.replace("CELLS", str(cells)))
    if code == "mortier":
        cost, _ = cost_of(mortier, "run", "scene.toml", "--quiet", "--threads", "1", "--out", "out")
        summary = json.loads((folder / "out" / "summary.json").read_text())
        return cost, summary["quantities"]["corner"]["value"]
    if code == "calculix":
        program = require(os.environ.get("CCX", "ccx"), "calculix-ccx")
        write_calculix(Cube(folder, mortier), folder / "cube.inp")
        cost, _ = cost_of(program, "-i", "cube")
        return cost, float((folder / "cube.dat").read_text().split()[-1])
    if code == "freefem":
        program = require(os.environ.get("FREEFEM", "FreeFem++"), "freefem++")
        Cube(folder, mortier).write_medit(folder / "cube.mesh")
        (folder / "cube.edp").write_text(FREEFEM.format(young=YOUNG, poisson=POISSON, bottom=BOTTOM, top=TOP))
        cost, output = cost_of(program, "-nw", "-ne", "-v", "0", "cube.edp")
    else:
        require_getfem()
        cube = Cube(folder, mortier)
        np.savez(folder / "cube.npz", points=cube.points, tetrahedra=cube.tetrahedra,
                 top=cube.faces[TOP], bottom=cube.faces[BOTTOM])
        (folder / "cube.py").write_text(GETFEM.format(young=YOUNG, poisson=POISSON))
        cost, output = cost_of(sys.executable, "cube.py")
    words = output.split()
    if "corner" not in words:
        raise RunFailure(f"no result: {output[-200:]}")
    return cost, float(words[words.index("corner") + 1])
