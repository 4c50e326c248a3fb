"""The rows of tests/compare/published.py that bench/hard.py has not: tests of other projects and papers, each
with the value that they publish (`theirs`), the exact one, and its tolerance, theirs where they state one.

Theirs are read from: Code_Aster's astest/*.comm (VALE_CALC; of an external reference VALE_REFE) and its
validation manual (V...), Kratos' JSON files of
applications/ContactStructuralMechanicsApplication/tests/ALM_frictional_contact_test_2D, MOOSE's comments in
the inputs named, the Verification Manual of Ansys Mechanical APDL (2024 R2) and the Benchmarks Guide of
Abaqus, which also give NAFEMS' targets.
"""
import math
from pathlib import Path

import numpy as np

from known import Row, located
from published_reads import (along, constant, course, courses, flow, motions, prandtl_reuss, quantities,
                             scaled_width, stress_at)
from reads import off_hertz, off_stress, peak, quantity, radius_of_contact, total


def aster_contact_rows():
    case = ("SSNP121, two blocks", "Code_Aster V6.03.121, ssnp121a.comm: E 0.1/2")
    yield Row(*case, "contact pressure", "ssnp121.toml", (), quantity("pressure"), 1e5, 1.00351e5, 1e-9,
              test="within")
    yield Row(*case, "displacement of the interface", "ssnp121.toml", (), quantity("motion"), -0.05,
              -0.0499784, 1e-9)
    pressure = 2e6 * 0.8 / (1 + 0.36 * 0.6 + 0.64 / 0.32 * (0.36 * 0.6 + 0.04))
    for degree, within in ((1, 0.02), (2, 1e-4)):
        yield Row("SSNP152 B, two rings", "Code_Aster V6.03.152, ssnp152b.comm; Lame",
                  f"contact pressure, degree {degree}", "ssnp152.toml", (f"degree={degree}",),
                  quantity("pressure"), pressure, 918462.2, within, test="within")
    yield Row("NAFEMS R0094, benchmark 1", "Konter 2006 by Code_Aster's ssnp154a.comm (Abaqus, Marc)",
              "displacement of the block in the middle", "../../../bench/hard/nafems.toml",
              ("body.block.boundary.1.ux=0",), lambda run: motions("block", (0, 0))(run)[1], None, -1.30690,
              0.03)
    for friction, sinks in ((0, -0.132941), (0.1, -0.130794)):
        yield Row("NAFEMS R0094, benchmark 2", "Konter 2006 by Code_Aster's ssna122b.comm (V6.01.122)",
                  f"displacement in the middle, friction {friction}", "ssna122.toml",
                  (f"contact.friction={friction}", "time.steps=4"), quantity("sinks"), None, sinks, 0.01,
                  test="" if friction else "within")
    yield Row("SSNV128, plate on a rigid plane, friction 1",
              "GRECO; Code_Aster V6.04.128, ssnv128a.comm (its own: 4 % off)",
              "displacement of five points below", "ssnv128.toml", (),
              lambda run: motions("plate", *((x, 0) for x in (0, 0.00125, 0.005, 0.0075, 0.01125)))(run)[::2],
              None, (2.86e-5, 2.72e-5, 2.28e-5, 1.98e-5, 1.5e-5), 0.05, each=True, test="within")
    case = ("SSNV503, pad on an inclined plane, friction 0.3", "Code_Aster V6.04.503, ssnv503b.comm: statics")
    cosine = math.cos(math.pi / 6)
    for what, direction, exact in (("across", (-0.5, cosine), 12000), ("along", (cosine, 0.5), -3564)):
        yield Row(*case, f"contact force {what} the plane, pushed by 0.99 of mu N", "ssnv503.toml", (),
                  along(direction), exact, within=1e-9, test="within")
    yield Row(*case, "pushed by 1.01 of mu N it slides", "ssnv503.toml",
              ("body.pad.boundary.4.pressure=181.8*t",), total, None,
              named=r"cannot hold body pad: translation along \(0\.866, 0\.5\)", test="named")
    corner = (-18.320508075688775, -8.267949192431123)
    for i, (what, theirs, within) in enumerate((("x", 1, 0.027), ("y", -1.732, 0.01))):
        yield Row(*case, f"displacement of a corner along {what}", "ssnv503.toml", (),
                  lambda run, i=i: motions("pad", corner)(run)[i], None, theirs, within, test="within")
    case = ("ZZZZ237, block on a rigid one", "Code_Aster V1.01.237, zzzz237a.comm: plane strain")
    yield Row(*case, "displacement of its corners", "zzzz237.toml", (), quantities("left", "right"),
              (-30 / 7, 30 / 7), (-4.28571, 4.28571), 1e-5, test="within")
    yield Row(*case, "contact force", "zzzz237.toml", (), quantity("force"), 4e10 / 0.91, 4.3956e10, 1e-5)


# Nodes of Kratos' punch and base: x, displacement along x, and along y beyond the 5e-5 that part them
PUNCH = ((0.1, 4.2945e-7, -4.2793e-7), (0.075, 3.0674e-7, -5.8411e-7), (0.05, 2.1551e-7, -6.3005e-7),
         (0.025, 1.2210e-7, -6.5827e-7), (0, 0, -6.8509e-7))
BASE = ((0.35, 4.8802e-7, 0), (0.105, 3.0116e-7, -2.9238e-7), (0.0875, 2.9373e-7, -5.3066e-7),
        (0.0525, 2.2403e-7, -6.2651e-7), (0, 3.6213e-8, -6.8509e-7))
# Of the block's lower side at x = 0.2, 0.5, 0.8
DRAGGED = {1.5: (9.4930e-7, 9.9869e-7, 9.4490e-7), 2.0: (1.8988e-6, 1.9985e-6, 2.0344e-6),
           2.5: (1.4419e-3, 2.0423e-3, 2.4180e-3), 3.0: (3.3993e-3, 4.6869e-3, 5.6365e-3)}


def kratos_rows():
    def moved(run):
        punch = motions("punch", *((x, 0.075) for x, _, _ in PUNCH))(run)
        punch[1::2] += 5e-5
        return np.concatenate([punch, motions("base", *((x, 0.075) for x, _, _ in BASE))(run)])
    yield Row("Kratos, punch with friction 0.05", "pure_friction_test (computed there on quadrilaterals)",
              "displacements of ten nodes", "kratos-punch.toml", (), moved, None,
              tuple(each for _, *motion in (*PUNCH, *BASE) for each in motion), 0.05, test="within")
    for time, values in DRAGGED.items():
        yield Row("Kratos, dragged block, friction 1", "static_evolution_load_test; two cells across",
                  f"displacements of three nodes, {'sticks' if time <= 2 else 'slides'}, t = {time:g}",
                  "kratos-dragged.toml", (), courses([time], x02=1, x05=1, x08=1), None, values,
                  0.03 if time <= 2 else 0.15, each=True, test="within")


def line_contact_rows():
    case = ("MOOSE, hertz_spherical", "contact/test/tests/hertz_spherical/hertz_contact_hex20.i: Hertz")
    yield Row(*case, "radius of contact", "spheres.toml", (), radius_of_contact, 0.1, within=0.02,
              test="within")
    yield Row(*case, "pressure in the middle", "spheres.toml", (), peak, 1.5e6 / math.pi, within=0.02)
    case = ("Ansys VM191, two cylinders", "Verification Manual, VM191 (PLANE182, Lagrange)")
    yield Row(*case, "force at the approach of 0.4181 mm, plane stress", "vm191.toml", (),
              lambda run: 2 * total(run), None, 3200, 0.03)
    yield Row(*case, "half width at 3200 N/mm, plane strain as their target", "vm191.toml", ("plane=strain",),
              scaled_width(3200), 1.19998, 1.1609, 0.02)
    yield Row("Ansys VM272, two half cylinders, first step", "Yang, Laursen, Meng 2005; Hertz",
              "pressure in the middle", "vm272.toml", (), peak,
              math.sqrt(10 * 100 / 0.91 / (4 * math.pi)), within=0.02, test="within")
    yield Row("Abaqus, two cylinders", "Benchmarks Guide, The Hertz contact problem; Hertz",
              "nodal pressures", "abaqus-hertz.toml", (), off_hertz(206000 / 0.91, 254, symmetric=True),
              within=0.03)


def patch_rows():
    case = ("MOOSE, simple_contact_rz_test", "contact/test/tests/simple_contact")
    yield Row(*case, "displacements outside and above", "moose-rz.toml", (), quantities("in", "up"),
              (-1.4e-4, 6e-5), within=1e-9, each=True, test="within")
    yield Row(*case, "stresses", "moose-rz.toml", (), off_stress(-100, 0, 0), within=1e-9)
    case = ("MOOSE, simple_contact_rspherical", "contact/test/tests/simple_contact")
    for degree, within in ((1, 1e-2), (2, 1e-4)):
        yield Row(*case, f"contact pressure, degree {degree}", "moose-spherical.toml", (f"degree={degree}",),
                  quantity("pressure"), 6000, within=within, test="within")
    yield Row("Tribol, contact patch test", "MFEM, miniapps/tribol/contact-patch-test.cpp: E 0.01/2",
              "stress", "tribol.toml", (), constant(1), -0.625, within=1e-9, test="within")


def tube(inner, outer, young, poisson, pressure, plane):
    """Lame: displacement inside, hoop stress inside."""
    lift = pressure * inner**2 / (outer**2 - inner**2)
    if plane == "strain":
        motion = (1 + poisson) / young * lift * ((1 - 2 * poisson) * inner + outer**2 / inner)
    else:
        motion = lift / young * ((1 - poisson) * inner + (1 + poisson) * outer**2 / inner)
    settings = (f"plane={plane}", f"body.tube.mesh.inner={inner}", f"body.tube.mesh.outer={outer}",
                f"body.tube.material.young={young}", f"body.tube.material.poisson={poisson}",
                f"body.tube.boundary.1.pressure={pressure}*t")
    return settings, motion, lift * (1 + outer**2 / inner**2)


def tube_rows():
    for case, source, data, theirs, within in (
            ("SSLV100, tube", "Code_Aster V3.04.100; Lame", (0.1, 0.2, 2e11, 0.3, 60e6, "strain"),
             (5.72e-5, 100e6), 1e-3),
            ("SSLV130, incompressible tube", "Code_Aster V3.04.130 (nu = 0.5); Lame",
             (0.1, 0.2, 2e11, 0.49999, 60e6, "strain"), (6e-5, 100e6), 5e-3),
            ("MacNeal and Harder, thick cylinder", "SAP2000 example 5-008; Lame",
             (3, 9, 1000, 0.4999, 1, "strain"), (None, None), 5e-3),
            ("solids4foam, pressurisedCylinder", "solids4foam's tutorials; Lame",
             (7, 18.625, 10e9, 0.3, 100e6, "stress"), (None, None), 2e-3)):
        settings, motion, hoop = tube(*data)
        yield Row(case, source, "displacement inside", "tube.toml", settings,
                  lambda run, at=data[0]: float(motions("tube", (at, 0))(run)[0]), motion, theirs[0], within,
                  test="within" if "SSLV1" in case else "")
        yield Row(case, source, "hoop stress inside", "tube.toml", settings,
                  stress_at("tube", (data[0], 0), 1), hoop, theirs[1], 4 * within)


def elastic_rows():
    yield Row("NAFEMS LE1, elliptic membrane", "NAFEMS TNSB by Abaqus' Benchmarks Guide (CPS6: 94.0 MPa)",
              "stress s22 at D", "le1.toml", (), stress_at("membrane", (2, 0), 1), None, 92.7e6, 0.02,
              test="within")
    yield Row("NAFEMS LE11, cylinder, taper, sphere",
              "NAFEMS TNSB by OptiStruct's OS-V: 0070 (-99.1 MPa)",
              "axial stress at A", "le11.toml", (), stress_at("body", (1, 0), 1), None, -105e6, 0.02,
              test="within")
    case = ("HPLA100, thin tube", "Code_Aster hpla100a.comm")
    yield Row(*case, "displacements inside and outside, in rotation", "rotating.toml", (),
              quantities("inside", "outside"), (2.9424e-7, 2.8801e-7), (2.9423745e-7, 2.8800655e-7), 2e-5,
              test="within")
    hot = ("body.tube.force=", "body.tube.temperature=(x - 20)*t")
    yield Row(*case, "the same, heated", "rotating.toml", hot, quantities("inside", "outside"),
              (1.056145e-6, 1.110317e-6), (1.0562499e-6, 1.1104166e-6), 2e-4)
    case = ("HSNV100, heated bar", "Code_Aster hsnv100a.comm: elastic")
    yield Row(*case, "displacement outside", "hsnv100.toml", (), quantity("outside"), 1.3e-5 * 66.666,
              8.66658e-4, 1e-9)
    yield Row(*case, "axial stress", "hsnv100.toml", (), constant(1), -2 * 66.666, -133.332, 1e-9)
    yield Row("SSLV07, bar under its own weight", "Code_Aster sslv07a.comm: rho g L^2/(2 E)",
              "displacement of the lower end", "sslv07.toml", (), quantity("sinks"), -1.721655e-6,
              -1.7216738e-6, 1e-9)
    case = ("SSLP02, plate with a hole", "Code_Aster V3.02.326, sslp02a.comm; Kirsch")
    yield Row(*case, "stress beside the hole", "plate.toml", (), stress_at("plate", (1, 0), 1), 7.5, 7.58517,
              0.015, test="within")
    yield Row(*case, "stress above the hole", "plate.toml", (), stress_at("plate", (0, 1), 0), -2.5, -2.56082,
              0.025)


def flow_rows():
    case = ("NAFEMS NL1, biaxial strain", "NAFEMS NNB by Abaqus' Benchmarks Guide; Prandtl, Reuss")
    strains = 1e-4 * np.array([(0, 0), (0.25, 0), (0.5, 0), (0.5, 0.25), (0.5, 0.5), (0.25, 0.5), (0, 0.5),
                               (0, 0.25), (0, 0)])
    for what, hardening, theirs in (("perfectly plastic", 0, (5, 5, 5, 5, 5, 5, 3.917, 5)),
                                    ("isotropic hardening", 62500, (5, 5.862, 5.482, 6.362, 6.640, 7.322,
                                                                    4.230, 5.673))):
        yield Row(*case, f"von Mises stress at eight times, {what}", "nl1.toml",
                  (f"body.square.material.isotropic_hardening={hardening}",), course("stress", range(1, 9)),
                  prandtl_reuss(strains, 1e5, 5, hardening), theirs, 0.005, test="within")
    case = ("NAFEMS R0027, creep under load", "Becker, Hyde; Ansys VMR027, VMR049: A s^4 (s1 - s2/2) t")
    yield Row(*case, "creep strains, uniaxial", "creep.toml", (), flow("square", 0, 1), (10, -5), (10, -5),
              1e-3, test="within")
    yield Row(*case, "creep strains, equibiaxial", "creep.toml",
              ('body.square.boundary=[{label=4,ux=0},{label=1,uy=0},{label=2,tx=200},{label=3,ty=200}]',),
              flow("square", 0, 1), (5, 5), within=1e-3)
    case = ("SSNA104, creep of a tube", "Code_Aster ssna104a.comm")
    yield Row(*case, "displacement outside", "ssna104.toml", (), quantity("outside"), 2.14498e-3, 2.144935e-3,
              1e-3, test="within")
    yield Row(*case, "axial stress outside", "ssna104.toml", (), stress_at("tube", (2, 0), 1), 2.7912e-4,
              2.75975e-4, 0.015)
    yield Row(*case, "hoop stress outside", "ssna104.toml", (), stress_at("tube", (2, 0), 3), 6.666e-4,
              6.63504e-4, 5e-3)
    yield Row("SSNP14, tension and shear", "Code_Aster V6.03.014, ssnp14a.comm (30 steps)",
              "strains e11 and e12 at t = 1, 2, 3", "ssnp14.toml", (), courses([1, 2, 3], e11=1, shear=0.5),
              None, (0.01482971, 0.04066130, 0.04415127, 0.01360140, 0.01978007, 0.01908533), 1e-3,
              test="within")


def sliding_rows():
    times = (1.25, 1.5, 2)

    def ratio(run):
        return -course("drag", times)(run) / course("press", times)(run)
    yield Row("Shallow ironing, a twentieth of the depth",
              "Fischer, Wriggers 2006; Yang, Laursen, Meng 2005: tends to the coefficient",
              "drag over press at three times, friction 0.3", "ironing.toml", (), ratio, None,
              (0.3, 0.3, 0.3), 0.03, each=True, test="within")
    yield Row("Press fit, up to where the channel narrows", "Fischer, Wriggers 2006, Kratos; exact: a strip",
              "force that pushes the block", "press-fit.toml", (), quantity("push"), push_of_a_strip(),
              within=0.01, test="within")
    yield Row("Double arch, 0.5 mm of 70", "Drouet 2015, Code_Aster V6.03.165, Kratos; exact: a curved beam",
              "force over the flattening of the half ring", "double-arch.toml", (),
              lambda run: -quantity("press")(run) / (20.5 + quantity("crown")(run)), stiffness_of_half_ring(),
              within=0.03, test="within")


def push_of_a_strip(young=1e9, poisson=0.47, friction=0.1, length=0.45, height=0.2, overlap=1e-3):
    """What moves the strip of press-fit.toml in its channel. Pushed from behind, it presses the channel more
    there: with the stress s along it and n = nu/(1 - nu), p = p0 - n s and height s' = -friction p give
    p = p0 exp(n friction x/height), x from the front on. p0 closes the overlap in the strip and in the
    channel, a layer of the height 0.25 that cannot expand."""
    oedometric = 21e9 * 0.7 / (1.3 * 0.4)
    n = poisson / (1 - poisson)
    front = overlap / (height * (1 - poisson**2) / young + 0.25 / oedometric)
    return height * front / n * math.expm1(n * friction * length / height)


def stiffness_of_half_ring(inner=1e5, outer=1e3, poisson=0.3, radii=(90, 95, 100)):
    """Of the right half of double-arch.toml: the force at its lowest point over the displacement there.
    Winkler: with the extension a and the turn b by angle of the section, fibres strain by (a + b (r - c))/r;
    thrust and moment in the plane of symmetry do no work (Castigliano), the shear force sees the area of both
    layers."""
    centre = radii[1]
    section = np.zeros((2, 2))
    for young, low, high in zip((inner, outer), radii, radii[1:]):
        r = low + (high - low) * (np.arange(400) + 0.5) / 400
        fibre = np.stack([np.ones_like(r), r - centre])
        section += young / (1 - poisson**2) * (fibre / r) @ fibre.T * (high - low) / 400
    shear = 5 / 6 * (inner + outer) / (2 * (1 + poisson)) * (radii[1] - radii[0])
    angles = math.pi / 2 * (np.arange(2000) + 0.5) / 2000
    compliance = np.zeros((3, 3))  # of thrust, moment, force
    for sine, cosine in zip(np.sin(angles), np.cos(angles)):
        forces = np.array([[-cosine, 0, -sine], [centre * (cosine - 1), 1, centre * sine]])
        across = np.array([sine, 0, -cosine])
        compliance += forces.T @ np.linalg.solve(section, forces) + np.outer(across, across) * centre / shear
    return 2000 / (math.pi / 2) * np.linalg.inv(compliance)[2, 2]


ROWS = located(Path(__file__).parent, [
    *aster_contact_rows(), *kratos_rows(), *line_contact_rows(), *patch_rows(), *tube_rows(), *elastic_rows(),
    *flow_rows(), *sliding_rows()])
