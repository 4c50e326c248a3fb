#!/usr/bin/python3
"""Estimated over true error of the stress (energy norm), where the exact stress is known: pure bending, and
the note's compression with interpolation. The table of docs/measurements.md.

    bench/estimate.py
"""
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "compare"))
import codes  # noqa: E402
import results  # noqa: E402


def mortier(*arguments):
    subprocess.run([str(codes.MORTIER), *map(str, arguments)], check=True, capture_output=True)


def energy(stress, young, nu):
    """s : E^-1 s of each row (s11, s22, s12; s33)."""
    s33 = stress[:, 3] if stress.shape[1] > 3 else np.zeros(len(stress))
    s11, s22, s12 = stress[:, :3].T
    return (s11**2 + s22**2 + s33**2 - 2 * nu * (s11 * s22 + s22 * s33 + s11 * s33)
            + 2 * (1 + nu) * s12**2) / young


def effectivity(folder, exact, young, nu):
    """True relative error, by the midpoints of edges, and the estimate over it."""
    run = results.read(folder)
    error = whole = 0
    for body in run.bodies.values():
        corners = body.points[body.triangles][:, :, :2]
        (x1, y1), (x2, y2) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
        weight = np.abs(x1 * y2 - x2 * y1) / 6
        for i in range(3):
            stress = exact(((corners[:, i] + corners[:, (i + 1) % 3]) / 2).T)[:, :body.stress.shape[1]]
            error += (weight * energy(body.stress - stress, young, nu)).sum()
            whole += (weight * energy(stress, young, nu)).sum()
    true = np.sqrt(error / whole)
    return true, run.summary["accuracy"]["energy_error"] / true


def bending(folder, plane, nu, cut, cells, length):
    mortier("mesh", "rectangle", "--cells", "{},{}".format(*cells), "--cut", cut, "--lower=0,-0.5", "--upper",
            f"{length},0.5", folder / "b.mesh")
    lateral = (nu * (1 + nu) if plane == "strain" else nu) / 2
    (folder / "b.toml").write_text(
        f'plane = "{plane}"\n[[body]]\nname = "b"\nmesh = "b.mesh"\n'
        f'material = {{ young = 1, poisson = {nu} }}\n'
        f'boundary = [ {{ label = 4, ux = 0, uy = "-{lateral}*y^2*t" }}, {{ label = 2, tx = "y*t" }} ]\n'
        "[time]\nend = 1\nsteps = 1\n")
    mortier("run", folder / "b.toml", "--out", folder / "b", "--quiet")
    across = nu if plane == "strain" else 0
    return effectivity(folder / "b", lambda x: np.column_stack([x[1], 0 * x[1], 0 * x[1], across * x[1]]), 1,
                       nu)


def compression(folder, upper, lower, swap, elastic):
    for name, cells, box in (("upper", upper, ("0,0", "1,1")), ("lower", lower, ("0,-1", "1,0"))):
        mortier("mesh", "crisscross", "--cells", f"{cells},{cells}", f"--lower={box[0]}", "--upper", box[1],
                folder / f"{name}.mesh")
    settings = [f"body.{name}.mesh={folder}/{name}.mesh" for name in ("upper", "lower")]
    settings += ["body.material={ young = 3e11, poisson = 0.3 }"] if elastic else []
    mortier("run", ROOT / "scenes/compression.toml", "--out", folder / "c", "--quiet", "--set", *settings,
            "contact.variant=interpolation", f"contact.swap={swap}", f"time.steps={1 if elastic else 20}")
    return effectivity(folder / "c", lambda x: np.column_stack([0 * x[1], 0 * x[1] - 10, 0 * x[1]]), 3e11,
                       0.3)


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for cut in ("rising", "both"):
            for nu in (0.3, 0.45, 0.49, 0.499, 0.4999):
                for n in (4, 8, 16, 32):
                    true, ratio = bending(folder, "strain", nu, cut, (2 * n, n), 2)
                    print(f"bending, plane strain, {cut:<6} nu {nu:<6} {n:2} cells: error {true:.3f}, "
                          f"estimate {ratio:.2f} of it")
            for n in (1, 2, 3, 4, 8):
                for length, aspect in ((2, 1), (10, 1), (10, 4)):
                    true, ratio = bending(folder, "stress", 0.3, cut, (max(1, length * n // aspect), n),
                                          length)
                    print(f"bending, plane stress, {cut:<6} {n} cells, length {length:2}, aspect {aspect}: "
                          f"error {true:.3f}, estimate {ratio:.2f} of it")
        for upper, lower in ((7, 8), (9, 4), (5, 13), (6, 16), (20, 23)):
            for swap in ("false", "true"):
                for elastic in (True, False):
                    true, ratio = compression(folder, upper, lower, swap, elastic)
                    print(f"interpolation {upper}:{lower}, swap {swap:<5} "
                          f"{'elastic' if elastic else 'flowing'}: error {true:.4f}, estimate "
                          f"{ratio:.2f} of it")
        for elastic in (True, False):
            true, ratio = compression(folder, 2, 50, "false", elastic)
            print(f"interpolation 2:50, {'elastic' if elastic else 'flowing'}: error {true:.4f}, estimate "
                  f"{ratio:.2f} of it")


if __name__ == "__main__":
    main()
