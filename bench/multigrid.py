#!/usr/bin/python3
"""Direct solvers against multigrid on one body, elastic and flowing: our factorisation, CHOLMOD, and
conjugate gradients with GAMG and hypre of PETSc (Debian packages python3-petsc4py, python3-scipy), in one run
and on one thread.

    bench/multigrid.py [--cells 96 192 272] [--contrast 1 1e-2 1e-4 1e-8] [--rounds 3]

A unit square in plane strain, crisscross cells (about 4 n^2 unknowns), held below and loaded above. Its
middle half flows: there the tangent has the deviatoric part of elasticity times the contrast.
Processor times are the least of the rounds, over that of our factorisation and solve; `new` is all of it,
`again` what a new tangent on the same mesh takes. Iterations reduce the residual by 1e-10, at most 1000;
rigid motions are near kernel.
"""
import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[name] = "1"

import numpy as np  # noqa: E402
import scipy.sparse as sparse  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent
MOST = 1000
TOLERANCE = 1e-10


def square(n):
    """Points and triangles: n x n cells, each cut by both diagonals."""
    x = np.arange(n + 1) / n
    corners = np.stack(np.meshgrid(x, x), -1).reshape(-1, 2)
    middles = np.stack(np.meshgrid(x[:-1], x[:-1]), -1).reshape(-1, 2) + 0.5 / n
    i, j = np.meshgrid(np.arange(n), np.arange(n))
    a = (j * (n + 1) + i).ravel()
    b, c, d, m = a + 1, a + n + 2, a + n + 1, len(corners) + np.arange(n * n)
    triangles = np.concatenate([np.stack(each, 1) for each in ((a, b, m), (b, c, m), (c, d, m), (d, a, m))])
    return np.concatenate([corners, middles]), triangles


def tangent(points, triangles, contrast, young=1.0, poisson=0.3):
    """The stiffness, every node with two equations."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    area2 = np.cross(b - a, c - a)
    turned = [np.stack([-e[:, 1], e[:, 0]], 1) / area2[:, None] for e in (c - b, a - c, b - a)]
    B = np.zeros((len(triangles), 3, 6))
    for k, g in enumerate(turned):
        B[:, 0, 2 * k] = B[:, 2, 2 * k + 1] = g[:, 0]
        B[:, 1, 2 * k + 1] = B[:, 2, 2 * k] = g[:, 1]
    shear, bulk = young / (2 * (1 + poisson)), young / (3 * (1 - 2 * poisson))
    volume = np.array([[1, 1, 0], [1, 1, 0], [0, 0, 0]])
    deviator = 2 * np.diag([1, 1, 0.5]) - 2 / 3 * volume
    middle = np.abs((a + b + c)[:, 0] / 3 - 0.5) < 0.25
    D = bulk * volume + np.where(middle, contrast, 1)[:, None, None] * shear * deviator
    local = area2[:, None, None] / 2 * np.einsum("tki,tkl,tlj->tij", B, D, B)
    dofs = (2 * triangles[:, :, None] + [0, 1]).reshape(-1, 6)
    rows, columns = np.repeat(dofs, 6, 1).ravel(), np.tile(dofs, 6).ravel()
    return sparse.csr_matrix((local.ravel(), (rows, columns)), (2 * len(points),) * 2)


def problem(n, contrast):
    """Matrix and right-hand side of the free equations, and the places of their nodes."""
    points, triangles = square(n)
    free = np.flatnonzero(points[:, 1] > 0)
    dofs = (2 * free[:, None] + [0, 1]).ravel()
    load = np.zeros((len(points), 2))
    load[points[:, 1] == 1] = [0.3 / n, -1 / n]
    return tangent(points, triangles, contrast)[dofs][:, dofs].tocsr(), load[free].ravel(), points[free]


def ours(matrix, rhs, rounds, program):
    lower = sparse.tril(matrix).tocsc()
    lower.sort_indices()
    with tempfile.NamedTemporaryFile(suffix=".bin") as file:
        np.array([matrix.shape[0], lower.nnz], np.int32).tofile(file)
        for part in (lower.indptr.astype(np.int32), lower.indices.astype(np.int32), lower.data, rhs):
            part.tofile(file)
        file.flush()
        done = subprocess.run([program, file.name, str(rounds)], capture_output=True, text=True, check=True)
    analysis, factor, solve, residual = map(float, done.stdout.split())
    return analysis + factor + solve, factor + solve, 0, residual


def petsc(PETSc, name, matrix, rhs, places, rounds):
    """Seconds of a new problem, of a new tangent, iterations, residual; None where it does not converge."""
    A = PETSc.Mat().createAIJ(size=matrix.shape, csr=(matrix.indptr, matrix.indices, matrix.data), bsize=2)
    A.setOption(PETSc.Mat.Option.SPD, True)
    b = PETSc.Vec().createWithArray(rhs)
    places = PETSc.Vec().createWithArray(places.ravel(), bsize=2)
    A.setNearNullSpace(PETSc.NullSpace().createRigidBody(places))
    new, again = [], []
    for _ in range(rounds):
        solver = PETSc.KSP().create()
        solver.setOperators(A)
        solver.setTolerances(rtol=TOLERANCE, max_it=MOST)
        direct = name == "CHOLMOD"
        solver.setType("preonly" if direct else "cg")
        solver.setNormType(PETSc.KSP.NormType.NONE if direct else PETSc.KSP.NormType.UNPRECONDITIONED)
        preconditioner = solver.getPC()
        preconditioner.setType("cholesky" if direct else name.lower())
        if direct:
            preconditioner.setFactorSolverType("cholmod")
        for times in (new, again):
            begin = time.process_time()
            A.setValuesCSR(matrix.indptr, matrix.indices, matrix.data)  # a new tangent
            A.assemble()
            x = b.duplicate()
            solver.setUp()
            solver.solve(b, x)
            times.append(time.process_time() - begin)
        iterations, converged = solver.getIterationNumber(), solver.getConvergedReason() > 0
        solver.destroy()
        if not converged and not direct:
            break
    residual = np.linalg.norm(matrix @ x.getArray() - rhs) / np.linalg.norm(rhs)
    return min(new), min(again), 0 if direct else iterations, residual if converged or direct else None


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=int, nargs="+", default=[96, 192, 272])
    parser.add_argument("--contrast", type=float, nargs="+", default=[1, 1e-2, 1e-4, 1e-8])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--program", type=Path, default=ROOT / "build" / "bench" / "direct")
    given = parser.parse_args()
    try:
        import petsc4py
        petsc4py.init([])
        from petsc4py import PETSc
    except ImportError:
        sys.exit("multigrid: PETSc is not installed (Debian package python3-petsc4py)")
    print(f"{'unknowns':>9} {'contrast':>9} {'':<8} {'new':>7} {'again':>7} {'iterations':>10} "
          f"{'residual':>9}")
    for n in given.cells:
        for contrast in given.contrast:
            matrix, rhs, places = problem(n, contrast)
            unit_new, unit, _, residual = ours(matrix, rhs, given.rounds, given.program)
            head = f"{len(rhs):>9} {contrast:>9.0e}"
            print(f"{head} {'ours':<8} {unit_new / unit:7.2f} {1:7.2f} {'':>10} {residual:9.1e}   "
                  f"({unit:.3f} s)", flush=True)
            for name in ("CHOLMOD", "GAMG", "hypre"):
                try:
                    new, again, iterations, residual = petsc(PETSc, name, matrix, rhs, places, given.rounds)
                except PETSc.Error as error:
                    print(f"{head} {name:<8} error {error.ierr}", flush=True)
                    continue
                end = f"{residual:9.1e}" if residual is not None else f"not in {iterations} iterations"
                print(f"{head} {name:<8} {new / unit:7.2f} {again / unit:7.2f} {iterations or '':>10} {end}",
                      flush=True)


if __name__ == "__main__":
    main()
