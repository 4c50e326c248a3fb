"""The exact solution of the note's test, found without a line of either code: the stress is (0, -10 t, 0), so

    eps_22' = -10/E + (s22 - P_B sigma_22) / (2 lambda),   u2 on top = 2 eps_22.
"""
import numpy as np

YOUNG, POISSON, VISCOSITY, YIELD, LOAD = 3e11, 0.3, 10.0, 1.0, 10.0
NORMS = {  # weights of the norm of the projection on (s11 + s22)/sqrt2 and (s11 - s22)/sqrt2
    "elasticity": (1 / (1 - POISSON), 1 / (1 + POISSON)),
    "frobenius": (1.0, 1.0),
    "compliance": (1 - POISSON, 1 + POISSON),
}


def overstress(s22, projection):
    """s22 - (P_B sigma)_22 for sigma = (0, s22, 0), by bisection on the multiplier of the projection."""
    p, q = s22 / np.sqrt(2), -s22 / np.sqrt(2)
    if 0.5 * p**2 + 1.5 * q**2 <= YIELD**2:
        return 0.0
    wp, wq = NORMS[projection]
    low, high = 0.0, 1e6
    for _ in range(200):
        m = (low + high) / 2
        P, Q = p / (1 + 0.5 * m / wp), q / (1 + 1.5 * m / wq)
        low, high = (m, high) if 0.5 * P**2 + 1.5 * Q**2 > YIELD**2 else (low, m)
    return s22 - (P - Q) / np.sqrt(2)


def top_exact(projection):
    """u2 on top at T = 1 [m]: Gauss's rule from first yield on, where the rate is smooth."""
    x, w = np.polynomial.legendre.leggauss(60)
    first = YIELD / LOAD
    t = first + (1 - first) * (x + 1) / 2
    integral = sum(wi * overstress(-LOAD * ti, projection) for ti, wi in zip(t, w)) * (1 - first) / 2
    return 2 * (-LOAD / YOUNG + integral / (2 * VISCOSITY))


def top_backward_euler(projection, steps):
    """u2 on top at T = 1 after equal steps of backward Euler [m]: what a code must meet to rounding."""
    total = sum(overstress(-LOAD * n / steps, projection) for n in range(1, steps + 1))
    return 2 * (-LOAD / YOUNG + total / steps / (2 * VISCOSITY))
