"""The rows of bench/hard.py (known.py says what a row is)."""
import math
from pathlib import Path

from known import Row, located
from reads import (ball_peak, curved_motion, curved_pressure, dragged, growth, half_width, inner_motion,
                   iterations, number, off_cone, off_fit, off_hertz, off_punch, off_ring, off_stress,
                   off_stuck, off_tube, order, peak, quantity, radius_of_contact, receding, shell_motion,
                   shell_pressure, stuck_part, total, unloading)


def disc(ratio, stiffness, degree=1, side="disc", variant="", up_to=0.85, within=0.02, **more):
    """Up to that part of the half width, on which there are at least 20 cells of the coarser body."""
    young = 210000 / stiffness
    fine, core = {1: (64, 10), 1.4: (64, 10), 2: (64, 7.5), 4: (64, 5), 8: (128, 5)}[ratio]
    cells = round(120 / (core / fine * ratio)) // 2 * 2 + 1
    modulus = 1 / (1 / 210000 + 1 / young)
    settings = (f"body.block.material.young={young!r}", f"body.block.mesh.cells=[{cells}, 40]",
                f"body.disc.mesh.cells={fine}", f"body.disc.mesh.core={core}",
                f"degree={degree}", f"contact.swap={'true' if side == 'block' else 'false'}")
    return Row("Disc on block", "Hertz; in MorteX (Akula and others) pressures alternate",
               f"nodal pressures up to {up_to:g} b, cells 1:{ratio:g}, E {stiffness:g}:1, {side} nonmortar, "
               f"degree {degree}" + (f", {variant}" if variant else ""), "disc.toml",
               settings + ((f"contact.variant={variant}",) if variant else ()),
               off_hertz(modulus, 50, up_to=up_to), within=within, **more)


def disc_rows():
    for stiffness in (1, 3, 1000):
        for side in ("disc", "block"):
            for degree in (1, 2):
                for ratio in (1, 1.4, 2, 4, 8):
                    fast = ratio == 2 and side == "disc" and stiffness < 1000 and degree == 1
                    yield disc(ratio, stiffness, degree, side, test="within" if fast else "")
        yield disc(2, stiffness, variant="mortar", named="alternate|not resolved by the coarser side",
                   test="named" if stiffness == 3 else "")
    for side in ("disc", "block"):  # against a wall the tangential motion of the disc counts most
        yield disc(2, 1e-9, side=side, up_to=0.5, within=0.01, test="within")


def prandtl_rows():
    exact = (2 + math.pi) / math.sqrt(3)
    meshes = {"one diagonal": ("body.ground.mesh.cut=rising",),
              "the other": ("body.ground.mesh.cut=falling",),
              "both": ("body.ground.mesh.cut=both",), "Gmsh": ("body.ground.mesh=prandtl.geo",)}
    for mesh, settings in meshes.items():
        for volume, verdict in (("pointwise", "named"), ("averaged", "within")):
            for degree in (1, 2):
                yield Row("Prandtl's punch, 8 cells on the half width", "Prandtl 1920: (2 + pi)/sqrt3",
                          f"limit load, {mesh}, {volume}, degree {degree}", "prandtl.toml",
                          (*settings, f"body.ground.volume={volume}", f"degree={degree}"), total, exact,
                          within=0.05 if degree == 1 else 0.03,  # of first order: 4 % with both cuts
                          named="flow-locks", test=verdict if mesh == "Gmsh" and degree == 1 else "",
                          published=mesh == "Gmsh" and volume == "averaged")


def circular_rows():
    for volume, degree in (("pointwise", 1), ("averaged", 1), ("averaged", 2)):
        settings = ("plane=axisymmetric", "body.ground.mesh=prandtl.geo", f"body.ground.volume={volume}",
                    f"degree={degree}")
        yield Row("Circular punch, 8 cells on the radius",
                  "limit of degree 2; with Tresca's criterion 2.845 (Shield 1955)",
                  f"mean pressure over the yield stress, Gmsh, {volume}, degree {degree}", "prandtl.toml",
                  settings, lambda run: total(run) / math.pi, 3.02,
                  within=0.05 if degree == 1 else 0.03,
                  named="flow-locks")


def ring_rows():
    k = 1 / math.sqrt(3)
    for volume in ("pointwise", "averaged"):
        for degree in (1, 2):
            settings = (f"body.ring.volume={volume}", f"degree={degree}")
            common = ("A ring that flows by 100 elastic strains, 12 cells", "2 k ln 2; 2 k ln(2/r)")
            yield Row(*common, f"pressure inside, {volume}, degree {degree}", "ring.toml", settings,
                      quantity("push", 1 / math.pi), 2 * k * math.log(2), within=0.02, named="flow-locks")
            yield Row(*common, f"radial stress over k, {volume}, degree {degree}", "ring.toml", settings,
                      off_ring, within=0.1 if degree == 1 else 0.02,  # 2 k/r times half a cell
                      named="flow-locks",
                      test="within" if degree == 1 and volume == "averaged" else "")


def end_rows():
    case = ("Dropped edges, crosspoints, supports at an end", "equilibrium; MOOSE #18853, #33493, #15215")
    for overlap in (1, 0.5, 1e-2, 1e-4, 1e-6, 1e-9):
        left = 1 - overlap
        yield Row(*case, f"force through an overlap of {overlap:g}", "overlap.toml",
                  (f"body.lower.mesh.lower=[{left!r}, -1]", f"body.lower.mesh.upper=[{left + 1!r}, 0]"),
                  total, 10, within=1e-9, peers=("freefem",) if overlap == 0.5 else (),
                  test="within" if overlap == 1e-6 else "", published=overlap == 1e-6)
    for scene, what in (("crosspoint.toml", "three bodies at a point"), ("held-end.toml", "a held end")):
        for variant in ("mortar", "weighted"):
            yield Row(*case, f"stress, {what}, {variant}", scene, (f"contact.variant={variant}",),
                      off_stress(-1, -1, 0), within=1e-9,
                      test="within" if scene == "crosspoint.toml" and variant == "mortar" else "",
                      published=variant == "mortar")


def plank_rows():
    case = ("Block on plank with friction", "|T| = mu N; MOOSE PR #22533, #13508: not ready, dies")
    creep = ("body.block.material={young=1e7, poisson=0.3, law='norton', reference_stress=1e4, "
             "reference_rate=1e-3, exponent=3}")
    for plank in (1e7, 1e9, 1e12):
        for swap in ("false", "true"):
            settings = (f"body.plank.material.young={plank!r}", f"contact.swap={swap}")
            side = "plank" if swap == "true" else "block"
            what = f"plank {plank / 1e7:g} times as stiff, {side} nonmortar"
            yield Row(*case, f"friction, {what}", "plank.toml", settings,
                      dragged, within=1e-9,
                      test="within" if plank == 1e9 and swap == "false" else "",
                      published=plank == 1e7 and swap == "false")
    yield Row(*case, "friction, the block creeps", "plank.toml", (creep,), dragged, within=1e-9)
    yield Row(*case, "linear solves of the worst step over 1", "plank.toml", (),
              lambda run: iterations(run) - 1, within=10)


def punch_rows():
    modulus = 2e5 / (1 - 0.3**2)
    yield Row("Elastoplastic punch, unloaded", "2 E/(1 - nu^2) a; Code_Aster SSNA111",
              "force over motion in unloading", "unload.toml", (), unloading, 2 * modulus, within=0.02,
              published=True)
    for side, swap, cells, within in (("punch", "false", 13, 0.1), ("punch", "false", 39, 0.02),
                                      ("block", "true", 13, 0.02)):
        settings = (f"contact.swap={swap}", *(("body.block.mesh.cells=[192, 192]",) if cells > 13 else ()))
        yield Row("Cone, rigid", "Sneddon 1965; with all rows from -22 to 45 for 12",
                  f"nodal pressures from 0.1 a to 0.85 a, {cells} block cells on a, {side} nonmortar",
                  "cone.toml", settings, off_cone, within=within, test="within" if within == 0.1 else "")
    yield Row("Flat punch", "F/(pi sqrt(a^2 - x^2)); solids4foam", "nodal pressures up to 0.9 a",
              "flat-punch.toml", (), off_punch, within=0.03, peers=("freefem",), test="within",
              published=True)


def fit_rows():
    pairs = ((48, 96), (96, 48), (24, 96), (96, 24), (64, 67))
    for shaft, hub in ((1000, 1000), (1e6, 1000), (1000, 1e6)):
        for degree in (1, 2):
            settings = tuple(
                (f"body.shaft.material.young={shaft!r}", f"body.hub.material.young={hub!r}",
                 f"body.shaft.mesh.cells=[{inner}, {inner // 4}]",
                 f"body.hub.mesh.cells=[{outer}, {outer // 4}]", f"contact.swap={swap}", f"degree={degree}")
                for inner, outer in pairs for swap in ("false", "true"))
            yield Row("Shrink fit", "Lame",
                      f"nodal pressures, cells 2:1 to 1:4, either side, E {shaft / 1000:g}:{hub / 1000:g}, "
                      f"degree {degree}", "shrink.toml", settings, off_fit(shaft, hub), within=0.02,
                      test="within" if shaft > hub and degree == 1 else "")


def hertz_rows():
    case = ("NAFEMS R0094, benchmark 1", "Hertz; with friction Konter 2006 (Abaqus, Marc)")
    for degree in (1, 2):
        yield Row(*case, f"half width, degree {degree}", "nafems.toml", (f"degree={degree}",), half_width,
                  6.2146, within=0.015, peers=("freefem",) if degree == 1 else (),
                  test="within", published=degree == 1)
        yield Row(*case, f"pressure, degree {degree}", "nafems.toml", (f"degree={degree}",), peak, 3585.4,
                  3801.5, 0.02, published=degree == 1)
    rough = ("contact.friction=0.1", "time.steps=10")
    yield Row(*case, "pressure, friction 0.1", "nafems.toml", rough, peak, None, 3800, 0.1,
              published=True)
    yield Row("Two spheres, SSNV104", "half space; the tolerance is theirs (Code_Aster astest/ssnv104a.comm)",
              "pressure in the middle", "spheres.toml", (), peak, 2798.3, 3176.3, 0.14, published=True)
    case = ("Kratos' hemispheres", "half space")
    yield Row(*case, "contact radius", "hemispheres.toml", (),
              radius_of_contact, 0.6302, within=0.02, published=True)
    yield Row(*case, "pressure in the middle", "hemispheres.toml", (), peak, 1.4164e5, within=0.02,
              published=True)
    yield Row("Two spheres in space, SSNV104", "about the axis (above); Code_Aster astest/ssnv104a.comm",
              "pressure in the middle", "two-balls.toml", (), peak, 2903, 3176.3, 0.01, published=True)
    case = ("Kratos' hemispheres in space", "half space")
    yield Row(*case, "contact radius", "hemispheres-space.toml", (), radius_of_contact, 0.6302, within=0.02,
              published=True)
    yield Row(*case, "pressure in the middle", "hemispheres-space.toml", (), peak, 1.4164e5, within=0.01,
              published=True)


def scene_rows():
    """Scenes of the gallery, other degrees, sides, stiffnesses and loads."""
    scenes = "../../scenes/"
    for degree, swap in ((1, "true"), (2, "false"), (2, "true")):
        yield Row("Sphere on a block", "Hertz", f"pressure in the middle, degree {degree}, "
                  f"{'block' if swap == 'true' else 'ball'} nonmortar", scenes + "sphere.toml",
                  (f"degree={degree}", f"contact.swap={swap}"),
                  ball_peak(1 / ((1 - 0.3**2) / 210000 + (1 - 0.33**2) / 70000), 50), 1, within=0.01,
                  test="within")
    case = ("Receding contact", "Keer, Dundurs, Tsai 1972")
    for young, exact in ((1e9, 0.960333), (0.1, 0.36535)):
        yield Row(*case, f"p(0)/P, half-plane {young:g} times as stiff", scenes + "receding.toml",
                  (f"body.half-plane.material.young={young!r}",), receding, exact, within=0.01, test="within")
    load = 'body.layer.boundary.3.ty="-{}*t*exp(-(x/0.05)^2)/(0.05*sqrt(pi))"'
    yield Row(*case, "change of p(0)/P from loads of 1e-6 to 1e5", scenes + "receding.toml",
              tuple((load.format(size), "contact.sliding=allow") for size in ("1e-6", "1", "1e5")),
              lambda one, *others: max(abs(receding(each) / receding(one) - 1) for each in others),
              within=1e-10, test="within")


def order_rows():
    def cells(n):
        return (f"body.inner.mesh.cells=[{8 * n}, {4 * n}]", f"body.outer.mesh.cells=[{11 * n}, {7 * n}]")
    case = ("Manufactured curved contact, fitted orders", "Code_Aster V6.03.150, V6.04.219: theirs")
    for degree, motion, pressure in ((1, 2.0, 0.5), (2, 2.5, 1.0)):
        settings = tuple((*cells(n), f"degree={degree}") for n in ((1, 2, 4) if degree == 1 else (1, 2, 3)))
        for what, error, least in (("displacement", curved_motion, motion),
                                   ("pressure", curved_pressure, pressure)):
            yield Row(*case, f"order of the {what}, degree {degree}", "curved.toml", settings, order(error),
                      None, least, 0.05, at_least=True,
                      test="within" if degree == 1 and what == "pressure" else "", published=True)


def shell_rows():
    case = ("Spherical shells in space, fitted orders", "Lame; Code_Aster V6.03.150, V6.04.219: theirs")
    for degree, sizes, motion, pressure in ((1, (0.07, 0.055, 0.042), 2.0, 0.5),
                                            (2, (0.25, 0.15, 0.09), 2.5, 1.0)):
        settings = tuple((f"degree={degree}", f"body.inner.mesh.parameters.h={h}",
                          f"body.outer.mesh.parameters.h={1.25 * h}") for h in sizes)
        for what, error, least in (("displacement", shell_motion, motion),
                                   ("pressure", shell_pressure, pressure)):
            yield Row(*case, f"order of the {what}, degree {degree}", "shells.toml", settings, order(error),
                      None, least, 0.05, at_least=True, published=True)


def patch_rows():
    for degree in (1, 2):
        for cuts in (("rising", "both"), ("falling", "rising")):
            settings = (f"degree={degree}", f"body.upper.mesh.cut={cuts[0]}",
                        f"body.lower.mesh.cut={cuts[1]}")
            peers = ("freefem", "getfem", "calculix") if degree == 1 and cuts[0] == "rising" else ()
            yield Row("Patch on unlike elements, SSNP121", "-1e5 everywhere",
                      f"stress, {' on '.join(cuts)}, degree {degree}", "patch.toml", settings,
                      off_stress(0, -1e5, 0), within=1e-9, peers=peers,
                      test="within" if degree == 2 and cuts[0] == "rising" else "")


def volume_rows():
    for volume, verdict in (("pointwise", "named"), ("averaged", "within")):
        for degree in (1, 2):
            yield Row("Cook's membrane, nu 0.4999", "limit of both degrees",
                      f"deflection, {volume}, degree {degree}", "cook.toml",
                      (f"body.membrane.volume={volume}", f"degree={degree}"), quantity("deflection"), 18.515,
                      within=0.03, named="poisson-limit", test=verdict if degree == 1 else "")
    k, shear = 1 / math.sqrt(3), 1000 / (2 * 1.4999)
    for volume in ("pointwise", "averaged"):
        for degree in (1, 2):
            settings = (f"body.tube.volume={volume}", f"degree={degree}")
            case = ("Hill's tube, plastic to 1.5", "Hill 1950")
            yield Row(*case, f"mean stress over k, {volume}, degree {degree}", "tube.toml", settings,
                      off_tube, within=0.03, named="flow-locks|poisson-limit")
            yield Row(*case, f"inner displacement, {volume}, degree {degree}", "tube.toml", settings,
                      inner_motion, k * 1.5**2 / (2 * shear), within=0.03,
                      named="flow-locks|poisson-limit", published=volume == "averaged" and degree == 1)


def other_rows():
    lines = tuple((f"body.upper.mesh.cells=[{n}, 12]", f"body.lower.mesh.cells=[{n * 8 // 5}, 12]")
                  for n in (100, 200, 400, 800))
    yield Row("Iterations and the mesh", "PETSc's vinewtonrsls: 5, 9, 17, 34 (MOOSE #14166)",
              "growth of the linear solves from 100 to 800 nodes", "growing.toml", lines, growth, within=0.25)
    yield Row("Shallow ironing", "slips are finite: out of the model", "the run ends", "ironing.toml", (),
              total, named="contact-slides|past the end")
    yield Row("Rough punch", "Spence 1975: c/a 0.680", "c/a", "rough.toml", (), stuck_part, 0.680,
              within=0.02, published=True)
    yield Row("Half planes pushed along", "Cattaneo, Mindlin", "stick zones, worst of 11 forces [%]",
              "stick.toml", (), off_stuck, within=1, published=True)
    yield Row("Steps that stall elsewhere", "limits of the certificate (tests/theory/hard_cases.h)",
              "cases beyond the limits", command=("build/bench/hard_cases", "--fast"),
              read=number(r"(\d+) cases beyond"))
    yield Row("Inf-sup constant of nodal pressures", "0 where all nodes have a row (El-Abbasi, Bathe 2001)",
              "stabilised, least of ratios 1.1 to 8, degrees 1 and 2", command=(
                  "build/tests/unit_tests", "--gtest_filter=PressureCompliance.keepsTheInfSupConstant"),
              read=number(r"inf-sup constant ([\d.e+-]+)", min), exact=0.1, within=0.1, at_least=True)


ROWS = located(Path(__file__).parent, [
    *disc_rows(), *prandtl_rows(), *circular_rows(), *ring_rows(), *end_rows(), *plank_rows(), *punch_rows(),
    *fit_rows(), *hertz_rows(), *scene_rows(), *order_rows(), *shell_rows(), *patch_rows(), *volume_rows(),
    *other_rows()])
