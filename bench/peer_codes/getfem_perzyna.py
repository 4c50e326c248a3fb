"""Perzyna's law with the note's projections on top of GetFEM, backward Euler: mixed Newton in Python, each
linearised step assembled and solved with its contact by GetFEM's bricks.

GetFEM's own Newton was tried first, with the law in its assembly language. The displacement form does not
converge at first yield; with the stress and the multiplier as unknowns its linear solvers fail (MUMPS) or do
not end (SuperLU).

With p, q, r = (s11 + s22)/sqrt2, (s11 - s22)/sqrt2, sqrt2 s12, e the eigenvalues of the elasticity tensor
over E, and displacements scaled by E:
    r = eps(du) - (s - s0)/e - theta E (s - P_B s),   H = 1/e + theta E (1 - P_B'),   s <- s + H^-1 (r + B d)
Where that does not end, theta is raised in half decades from 1e-8 of its value.
"""
import getfem as gf
import numpy as np

from perzyna import A, project
from problems import RunFailure

TOLERANCE = 1e-9  # |H^-1 r| over the yield stress
PLAIN, STAGE, LAST = 8, 40, 60  # iterations
ROUGH = 0.3  # tolerance of a stage
BALANCE, GAP = 1e-9, 1e-15  # what GetFEM's solver is asked: forces, and gaps over the displacement
ROUNDING = 1e-15  # of the scaled strain: the least H^-1 r
STRAIN = "[(Grad_{0}(1,1)+Grad_{0}(2,2));(Grad_{0}(1,1)-Grad_{0}(2,2));(Grad_{0}(1,2)+Grad_{0}(2,1))]/sqrt(2)"


class Material:
    """One body's law and its state: stress and displacement at the start of the step."""

    def __init__(self, body, index, model):
        self.body, self.given, self.name = body, body.body, f"u{index}"
        if not self.given.viscosity:
            raise RunFailure("an elastic body beside a viscoplastic one is not known to this driver")
        nu = self.given.poisson
        self.e = np.array([1 / (1 - nu), 1 / (1 + nu), 1 / (1 + nu)])
        self.b = A / {"elasticity": np.array([self.e[0] / self.e[1], 1, 1]), "frobenius": np.ones(3),
                      "compliance": np.array([self.e[1] / self.e[0], 1, 1])}[self.given.projection]
        self.s = np.zeros((len(self.given.mesh.triangles), 3))
        self.index = index
        rule = gf.MeshIm(body.mesh, gf.Integ("IM_TRIANGLE(1)"))
        model.add_fem_data(f"now{index}", body.vector)
        model.add_fem_data(f"D{index}", body.fem(9, "FEM_PK(2,0)"))
        model.add_fem_data(f"S{index}", body.fem(3, "FEM_PK(2,0)"))
        strain, now, test = (STRAIN.format(each) for each in (self.name, f"now{index}", f"Test_{self.name}"))
        model.add_linear_term(rule, f"(Reshape(D{index},3,3)*({strain}-{now})+S{index}).({test})")

    def start(self, model, k):
        self.thetaE = k / (2 * self.given.viscosity) * self.given.young
        self.u0, self.s0 = self.body.displacement(model.variable(self.name)), self.s.copy()

    def strain(self, u):
        e11, e22, g12 = self.given.strain(u).T
        return np.column_stack([e11 + e22, e11 - e22, g12]) / np.sqrt(2)

    def linearise(self, model, theta):
        """Leaves H^-1 and H^-1 r at the present stress; |H^-1 r| over the yield stress, and its rounding."""
        theta *= self.thetaE
        over, dP = project(self.s, self.b, self.given.yield_stress)
        strain = self.strain(self.body.displacement(model.variable(self.name)) - self.u0)
        r = strain - (self.s - self.s0) / self.e - theta * over
        self.inverse = np.linalg.inv(np.diag(1 / self.e) + theta * (np.eye(3) - dP))
        self.step = np.einsum("tij,tj->ti", self.inverse, r)
        largest = np.abs(self.u0).max() + np.abs(strain).max()
        rounding = ROUNDING * np.abs(self.inverse).max() * largest * np.sqrt(len(self.s))
        return np.abs(self.step).max() / self.given.yield_stress, rounding / self.given.yield_stress

    def load(self, model):
        model.set_variable(f"now{self.index}", model.variable(self.name))
        model.set_variable(f"D{self.index}", self.inverse.transpose(0, 2, 1).ravel())
        model.set_variable(f"S{self.index}", (self.s + self.step).ravel())

    def advance(self, model):
        now, new = (self.body.displacement(model.variable(each)) for each in (f"now{self.index}", self.name))
        self.s = self.s + self.step + np.einsum("tij,tj->ti", self.inverse, self.strain(new - now))


class Law:
    def __init__(self, model, bodies, problem):
        self.k = problem.end / problem.steps
        self.materials = [Material(body, i, model) for i, body in enumerate(bodies.values())]
        self.names = list(bodies)
        self.solves = 0

    def newton(self, model, theta, tolerance, iterations):
        before = np.inf
        for i in range(iterations + 1):
            found = [each.linearise(model, theta) for each in self.materials]
            residual, rounding = (max(each[k] for each in found) for k in (0, 1))
            if i > 0 and (residual <= tolerance or residual <= rounding and residual > before / 2):
                return True
            if i == iterations or not np.isfinite(residual):
                return False
            before = residual
            for each in self.materials:
                each.load(model)
            largest = max(np.abs(model.variable(each.name)).max() for each in self.materials)
            solves, converged = model.solve("max_res", BALANCE + GAP * largest, "max_iter", 50)
            self.solves += solves
            if not converged:
                return False
            for each in self.materials:
                each.advance(model)

    def step(self, model):
        before, pressure = self.solves, model.variable("p")
        for each in self.materials:
            each.start(model, self.k)
        if not self.newton(model, 1.0, TOLERANCE, PLAIN):
            for each in self.materials:
                each.s = each.s0.copy()
                model.set_variable(each.name, each.u0[each.body.vertex].ravel())
            model.set_variable("p", pressure)
            for stage in range(16):
                self.newton(model, 10**(-8 + stage / 2), ROUGH, STAGE)
            if not self.newton(model, 1.0, TOLERANCE, LAST):
                return self.solves - before, False
        return self.solves - before, True

    def stresses(self, model):
        return {name: np.column_stack([(s[:, 0] + s[:, 1]), (s[:, 0] - s[:, 1]), s[:, 2]]) / np.sqrt(2)
                for name, s in zip(self.names, (each.s for each in self.materials))}


def add_law(model, bodies, problem):
    return Law(model, bodies, problem)
