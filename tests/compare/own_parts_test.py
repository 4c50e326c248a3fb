"""Parts that Gmsh meshes, with the default settings, against exact solutions: Hertz, a shrink fit (Lame), a
pin in a hole with clearance."""
import unittest

import numpy as np

from scene_parts import body, contact, quantity, timed
from support import InFolder
import results

HERTZ_GEO = """
// Half of a cylinder of radius 50 on a block.
R = 50; fine = 0.05; coarse = 4; x = 3.4;
Point(1) = {0, 0, 0, fine}; Point(2) = {0, R, 0, coarse}; Point(3) = {R, R, 0, coarse};
Point(4) = {x, R - Sqrt(R^2 - x^2), 0, fine};
Circle(1) = {1, 2, 4}; Circle(2) = {4, 2, 3}; Line(3) = {3, 2}; Line(4) = {2, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(5) = {0, 0, 0, fine}; Point(6) = {0, -100, 0, 8}; Point(7) = {100, -100, 0, 8};
Point(8) = {100, 0, 0, 8}; Point(9) = {x, 0, 0, fine};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 9}; Line(9) = {9, 5};
Curve Loop(2) = {5:9}; Plane Surface(2) = {2};
Physical Surface("cylinder") = {1}; Physical Surface("block") = {2};
Physical Curve("arc") = {1, 2}; Physical Curve("lid") = {3}; Physical Curve("axis") = {4, 5};
Physical Curve("floor") = {6}; Physical Curve("surface") = {8, 9};
"""
HERTZ = ('plane = "strain"\n'
         + body("cylinder", '{ file = "hertz.geo", region = "cylinder" }', 210e3,
                'label = "lid", uy = "-0.12*t"', 'label = "axis", ux = 0')
         + body("block", '{ file = "hertz.geo", region = "block" }', "young = 70e3, poisson = 0.33",
                'label = "floor", ux = 0, uy = 0', 'label = "axis", ux = 0')
         + contact(("cylinder", "arc"), ("block", "surface"), sides=True) + timed())
FIT_GEO = """
// A quarter of two rings, the inner one too large by 0.02.
a = 10; b = 20; c = 35; delta = 0.02; h = 0.2;
Point(1) = {0, 0, 0};
Point(2) = {a, 0, 0, h}; Point(3) = {0, a, 0, h}; Point(4) = {b + delta, 0, 0, h};
Point(5) = {0, b + delta, 0, h};
Point(6) = {b, 0, 0, h}; Point(7) = {0, b, 0, h}; Point(8) = {c, 0, 0, 2*h}; Point(9) = {0, c, 0, 2*h};
Circle(1) = {2, 1, 3}; Circle(2) = {4, 1, 5}; Line(3) = {2, 4}; Line(4) = {5, 3};
Curve Loop(1) = {3, 2, 4, -1}; Plane Surface(1) = {1};
Circle(5) = {6, 1, 7}; Circle(6) = {8, 1, 9}; Line(7) = {6, 8}; Line(8) = {9, 7};
Curve Loop(2) = {7, 6, 8, -5}; Plane Surface(2) = {2};
Physical Surface("shaft") = {1}; Physical Surface("hub") = {2};
Physical Curve("seat") = {2}; Physical Curve("bore") = {5}; Physical Curve("rim") = {6};
Physical Curve("below") = {3, 7}; Physical Curve("left") = {4, 8};
"""
FIT = (body("shaft", '{ file = "fit.geo", region = "shaft" }', 210e3, 'label = "below", uy = 0',
            'label = "left", ux = 0')
       + body("hub", '{ file = "fit.geo", region = "hub" }', "young = 70e3, poisson = 0.33",
              'label = "below", uy = 0', 'label = "left", ux = 0')
       + contact(("shaft", "seat"), ("hub", "bore"), sides=True)
       + quantity("swell", "displacement", "hub", component="x", point=[35, 0]) + timed())
PIN_GEO = """
// Half of a pin of radius 10 on the bottom of a hole that is larger by 0.02, in a large plate.
R = 10; clearance = 0.02; far = 20*R; fine = 0.2;
H = R + clearance;  // the hole about the origin, the pin about (0, -clearance)
Point(1) = {0, 0, 0}; Point(2) = {0, -clearance, 0, 2};
Point(3) = {0, -H, 0, fine}; Point(4) = {R*Sin(Pi/4), -clearance - R*Cos(Pi/4), 0, fine};
Point(5) = {0, R - clearance, 0, 2};
Circle(1) = {3, 2, 4}; Circle(2) = {4, 2, 5}; Line(3) = {5, 2}; Line(4) = {2, 3};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(6) = {0, -H, 0, fine}; Point(7) = {H*Sin(Pi/4), -H*Cos(Pi/4), 0, fine}; Point(8) = {0, H, 0, 2};
Point(9) = {0, -far, 0, 20}; Point(10) = {far, 0, 0, 20}; Point(11) = {0, far, 0, 20};
Circle(5) = {6, 1, 7}; Circle(6) = {7, 1, 8}; Line(7) = {8, 11}; Circle(8) = {11, 1, 10};
Circle(9) = {10, 1, 9}; Line(10) = {9, 6};
Curve Loop(2) = {5:10}; Plane Surface(2) = {2};
Physical Surface("pin") = {1}; Physical Surface("plate") = {2};
Physical Curve("shank") = {1, 2}; Physical Curve("hole") = {5, 6};
Physical Curve("axis") = {3, 4, 7, 10}; Physical Curve("far") = {8, 9};
"""
PIN = (body("pin", '{ file = "pin.geo", region = "pin" }', 210e3, 'label = "axis", ux = 0',
            force={"y": "-2.5*t"})
       + body("plate", '{ file = "pin.geo", region = "plate" }', 210e3, 'label = "axis", ux = 0',
              'label = "far", ux = 0, uy = 0') + contact(("pin", "shank"), ("plate", "hole"), sides=True)
       + timed())
ASKED = 1e-2  # relative


def pin_in_a_hole(load, clearance, young, radius, cells=200, modes=3000):
    """Angles [rad] and pressures [Pa] there, plane stress, pin and infinite plate of one material.

    A pressure p_n cos(n theta) on both closes the gap by 4 n p_n R / (E (n^2 - 1)), n >= 2, and by 2 p_0 R/E
    (Michell's series of both, added); n = 1 is the pin's way d into the hole and its load,
    Q = pi R p_1. The gap c - d cos(theta) + K p and p are complementary. p is linear on equal cells.
    """
    theta, step = np.linspace(0, np.pi / 2, cells, endpoint=False, retstep=True)
    n = np.arange(1, modes)
    hat = 2 / np.pi * np.cos(np.outer(theta, n)) * 2 * (1 - np.cos(n * step)) / (n**2 * step)
    mean = np.full(cells, step / np.pi)
    hat[0] /= 2
    mean[0] /= 2
    closes = np.append(0, 4 * n[1:] / (n[1:]**2 - 1))
    influence = radius / young * (np.cos(np.outer(theta, n)) * closes @ hat.T + 2 * mean)
    held = theta < 0.5
    for _ in range(100):
        rows = np.flatnonzero(held)
        system = np.block([[influence[np.ix_(rows, rows)], -np.cos(theta[rows])[:, None]],
                           [np.pi * radius * hat[rows, 0], np.zeros(1)]])
        *found, way = np.linalg.solve(system, np.append(np.full(len(rows), -clearance), load))
        pressure = np.zeros(cells)
        pressure[rows] = found
        gap = clearance - way * np.cos(theta) + influence @ pressure
        if ((now := np.where(held, pressure > 0, gap < 0)) == held).all():
            return theta, pressure
        held = now
    raise AssertionError("no contact set found")


class OwnParts(InFolder):
    def run_of(self, name, geometry, scene):
        self.write(geometry, f"{name}.geo")
        self.write(scene)
        self.mortier("run", "scene.toml", "--quiet", "--out", "out")
        return results.read_mortier(self.folder / "out")

    def close(self, found, exact, what):
        print(f"{what}: {found:.6g}, exact {exact:.6g}, relative error {abs(found / exact - 1):.1e}")
        self.assertLess(abs(found / exact - 1), ASKED, what)

    def test_hertz(self):
        run = self.run_of("hertz", HERTZ_GEO, HERTZ)
        load = 2 * np.sum(run.contact.force)
        modulus = 1 / ((1 - 0.3**2) / 210e3 + (1 - 0.33**2) / 70e3)
        peak, half = np.sqrt(load * modulus / (np.pi * 50)), np.sqrt(4 * load * 50 / (np.pi * modulus))
        self.close(run.contact.pressure.max(), peak, "largest pressure")
        # p^2 is linear in x^2
        x, p = run.contact.position[:, 0], run.contact.pressure
        inside = x < 0.9 * half
        self.assertGreater(inside.sum(), 10)
        slope, constant = np.polyfit(x[inside]**2, p[inside]**2, 1)
        self.close(np.sqrt(-constant / slope), half, "half-width")
        exact = peak * np.sqrt(1 - (x[inside] / half)**2)
        np.testing.assert_allclose(p[inside], exact, rtol=0, atol=2 * ASKED * peak)

    def test_shrink_fit(self):
        run = self.run_of("fit", FIT_GEO, FIT)
        a, b, c, interference = 10, 20, 35, 0.02
        exact = interference / b / (((c**2 + b**2) / (c**2 - b**2) + 0.33) / 70e3
                                    + ((b**2 + a**2) / (b**2 - a**2) - 0.3) / 210e3)
        self.close(np.sum(run.contact.force) / (b * np.pi / 2), exact, "pressure of the fit")
        self.close(run.contact.pressure.max(), exact, "largest pressure")
        self.close(run.contact.pressure.min(), exact, "smallest pressure")
        self.close(run.summary["quantities"]["swell"]["value"],
                   2 * exact * b**2 * c / (70e3 * (c**2 - b**2)), "swell of the rim")

    def test_pin_in_a_hole_with_clearance(self):
        run = self.run_of("pin", PIN_GEO, PIN)
        theta, exact = pin_in_a_hole(2.5 * np.pi * 10**2, 0.02, 210e3, 10)
        x, y = run.contact.position.T
        at, p = np.arctan2(x, -y), run.contact.pressure
        self.close(2 * np.sum(run.contact.force * np.cos(at)), 2.5 * np.pi * 10**2, "load")
        self.close(p.max(), exact.max(), "largest pressure")
        half = theta[exact > 0].max()
        self.assertGreater(half, 0.6)  # far from Hertz
        inside = at < 0.9 * half
        np.testing.assert_allclose(p[inside], np.interp(at[inside], theta, exact), rtol=0,
                                   atol=ASKED * exact.max())

    def test_the_exact_pin_is_that_of_hertz_where_contact_is_narrow(self):
        load, clearance, young, radius = 2, 0.02, 210e3, 10
        theta, pressure = pin_in_a_hole(load, clearance, young, radius, cells=1000, modes=20000)
        of_both = radius * (radius + clearance) / clearance
        half = np.sqrt(4 * load * of_both / (np.pi * young / 2))
        self.assertAlmostEqual(pressure[0] / (2 * load / (np.pi * half)), 1, delta=5e-3)


if __name__ == "__main__":
    unittest.main()
