"""The projection on the elastic domain in the basis p, q, r = (s11 + s22)/sqrt2, (s11 - s22)/sqrt2, sqrt2
s12, for all triangles at once: B is A . s^2 <= limit^2, and P_B s = s/(1 + m b),
b = A over the weights of the norm.
"""
import numpy as np

A = np.array([0.5, 1.5, 1.5])


def project(s, b, limit):
    """s - P_B s and the derivative of P_B: |P| = limit by Newton's method on 1/|P|, monotone from m = 0."""
    beyond = (A * s**2).sum(1) >= limit**2 * (1 - 1e-13)
    m = np.zeros(len(s))
    for _ in range(60):
        d = 1 / (1 + m[:, None] * b)
        norm2, slope = (A * s**2 * d**2).sum(1), (A * b * s**2 * d**3).sum(1) + 1e-300
        change = np.where(beyond, (np.sqrt(norm2) / limit - 1) * norm2 / slope, 0)
        m += change
        if np.abs(change).max() <= 1e-14 * (1 + m.max()):
            break
    d = 1 / (1 + m[:, None] * b)
    slope = (A * b * s**2 * d**3).sum(1) + 1e-300
    derivative = d[:, :, None] * np.eye(3)
    inverse = np.where(beyond, 1 / slope, 0)
    derivative -= inverse[:, None, None] * (b * s * d**2)[:, :, None] * (A * s * d**2)[:, None, :]
    return s * (m[:, None] * b) * d, derivative  # no difference: theta E is 1e8
