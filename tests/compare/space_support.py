"""A cube in space, elastic constants of it, and what its results hold."""

import meshio
import numpy as np

from support import InFolder, set_option, values, warned

HELD = ('point = [ { at = [0, 0, 0], ux = 0, uy = 0, uz = 0 }, { at = [1, 0, 0], uy = 0, uz = 0 }, '
        '{ at = [0, 1, 0], uz = 0 } ]')
CLAMPED, ROLLERS = ("boundary = [ " + ", ".join(f"{{ label = {k}, {held} }}" for k in range(1, 7)) + " ]"
                    for held in ("ux = 0, uy = 0, uz = 0", "un = 0"))
E, NU = 100, 0.3
ISOTROPIC = f"young = {E}, poisson = {NU}"
MODULI = {"young1": 110, "young2": 30, "young3": 60, "poisson12": 0.3, "poisson13": 0.2, "poisson23": 0.25,
          "shear12": 20, "shear13": 35, "shear23": 15}
ORTHOTROPIC = 'elasticity = "orthotropic", ' + ", ".join(f"{k} = {v}" for k, v in MODULI.items())
AXES = [[1, 2, 2], [2, 1, -2]]


def cube(material, *lines, degree=1):
    return "\n".join(["dimension = 3", f"degree = {degree}", "[[body]]", 'name = "cube"',
                      'mesh = { shape = "cuboid", cells = [2, 3, 2] }', f"material = {{ {material} }}",
                      *lines, "[time]", "end = 1", "steps = 1", ""])


def compliance():
    """(e11, e22, e33, 2 e12, 2 e13, 2 e23) of (s11, s22, s33, s12, s13, s23) in the axes."""
    m = MODULI
    S = np.diag([1/m["young1"], 1/m["young2"], 1/m["young3"], 1/m["shear12"], 1/m["shear13"], 1/m["shear23"]])
    S[0, 1] = S[1, 0] = -m["poisson12"]/m["young1"]
    S[0, 2] = S[2, 0] = -m["poisson13"]/m["young1"]
    S[1, 2] = S[2, 1] = -m["poisson23"]/m["young2"]
    return S


def rotation(axes=AXES):
    """Columns: the axes of the material."""
    first = np.array(axes[0])/np.linalg.norm(axes[0])
    third = np.cross(first, axes[1])
    third /= np.linalg.norm(third)
    return np.column_stack([first, np.cross(third, first), third])


def strain_of(stress, R):
    """The strain tensor of a stress tensor."""
    s = R.T @ stress @ R
    e = compliance() @ [s[0, 0], s[1, 1], s[2, 2], s[0, 1], s[0, 2], s[1, 2]]
    return R @ np.array([[e[0], e[3]/2, e[4]/2], [e[3]/2, e[1], e[5]/2], [e[4]/2, e[5]/2, e[2]]]) @ R.T


class InSpace(InFolder):
    def run_scene(self, text=None, *settings, code=0):
        if text is not None:
            self.write(text)
        done = self.mortier("run", "scene.toml", "--quiet", "--out", "out",
                            *set_option(settings), code=code)
        self.warnings = warned(done.stderr)
        self.summary = self.summary_of()
        return values(self.summary)

    def fields(self, body="cube"):
        """Places, displacements, centres of the cells, and stresses: s11, s22, s33, s12, s23, s13."""
        mesh = meshio.read(sorted((self.folder / "out").glob(f"{body}_*.vtu"))[-1])
        stress = mesh.cell_data["stress"][0]
        centres = mesh.points[mesh.cells[0].data[:, :4]].mean(axis=1)
        return mesh.points, mesh.point_data["displacement"], centres, stress

    def expect_homogeneous(self, strain, stress, within=1e-12):
        """u = strain x but for a rotation, which the three supports say."""
        x, u, _, s = self.fields()
        G = np.array(strain, dtype=float)
        W = np.zeros((3, 3))
        W[1, 0], W[2, 0], W[2, 1] = -G[1, 0], -G[2, 0], -G[2, 1]  # u_y, u_z along x and u_z along y are 0
        W -= W.T
        expected = x @ (G + W).T
        np.testing.assert_allclose(u, expected, atol=within*max(np.abs(expected).max(), 1e-4))
        row = [stress[i][j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))]
        np.testing.assert_allclose(s, np.tile(row, (len(s), 1)), atol=within*max(1, np.abs(row).max()))
