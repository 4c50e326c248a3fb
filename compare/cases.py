"""The cases in which the codes are compared: the note's test on every shared pair of meshes,
and the scenes."""
import itertools
import re
from dataclasses import asdict, dataclass

# name: nonmatching pairs, upper and lower; the third is unstructured, graded in opposite directions
PAIRS = {
    "6/16": ("upper-crisscross-6", "lower-crisscross-16"),
    "16/6": ("upper-crisscross-16", "lower-crisscross-6"),
    "7/11": ("upper-unstructured-7", "lower-unstructured-11"),
}
PROJECTIONS = ("elasticity", "frobenius", "compliance")
VARIANTS = ("mortar", "interpolation")
SIDES = ("upper", "lower")


class Shown:
    """How a case is shown: WIDTHS is of its columns."""

    @classmethod
    def head(cls):
        return "".join(f"{name:<{width}} " for name, width in cls.WIDTHS.items())

    @property
    def line(self):
        return "".join(f"{getattr(self, name):<{width}} " for name, width in self.WIDTHS.items())

    @property
    def folder(self):
        return re.sub(r"[^\w-]+", "_", str(self))


@dataclass(frozen=True)
class Case(Shown):
    """The note's test."""
    pair: str
    projection: str
    variant: str
    nonmortar: str
    steps: int
    scene = "scenes/compression.toml"
    within = None
    WIDTHS = {"pair": 5, "projection": 11, "variant": 13, "nonmortar": 9, "steps": 5}

    @property
    def row(self):
        return asdict(self)

    def __str__(self):
        return f"{self.pair} {self.projection} {self.variant} nonmortar {self.nonmortar} N={self.steps}"

    @property
    def settings(self):
        upper, lower = PAIRS[self.pair]
        swap = "true" if self.nonmortar == "lower" else "false"
        return [f"body.upper.mesh=shared-meshes/{upper}.mesh", f"body.lower.mesh=shared-meshes/{lower}.mesh",
                f"body.material.projection={self.projection}", f"contact.variant={self.variant}",
                f"contact.swap={swap}", f"time.steps={self.steps}"]


def all_cases():
    return [Case(*each) for each in itertools.product(PAIRS, PROJECTIONS, VARIANTS, SIDES, (20, 100))]


def quick_cases():
    """Every pair, projection, variant, side and N at least once."""
    return ([Case("6/16", *choice, "upper", 20) for choice in itertools.product(PROJECTIONS, VARIANTS)]
            + [Case("16/6", "frobenius", variant, "lower", 20) for variant in VARIANTS]
            + [Case("16/6", "elasticity", "interpolation", "upper", 20)]
            + [Case("7/11", "elasticity", variant, "upper", 20) for variant in VARIANTS]
            + [Case("7/11", "compliance", "interpolation", "lower", 20)]
            # step 10 has several solutions (docs/measurements.md)
            + [Case("7/11", "elasticity", "interpolation", "upper", 100)])


@dataclass(frozen=True)
class SceneCase(Shown):
    """A scene of scenes/ in both codes."""
    name: str
    variant: str
    what: str = "as it stands"  # what the settings change
    changes: tuple = ()
    WIDTHS = {"name": 15, "variant": 13, "what": 42}

    @property
    def row(self):
        return {"case": str(self)}

    def __str__(self):
        return f"{self.name} {self.variant} {self.what}"

    @property
    def scene(self):
        return f"scenes/{self.name}.toml"

    @property
    def settings(self):
        return [f"contact.variant={self.variant}", *COARSE.get(self.name, ()), *self.changes]

    @property
    def within(self):
        return QUADRATURE.get(self.name)


def coarse(**meshes):
    return tuple(f"body.{body}.mesh=shared-meshes/coarse-{mesh}.mesh"
                 for body, mesh in meshes.items())


# Meshes of scenes in all cases: FreeFEM's scripts take time by elements, and the codes agree on any mesh.
COARSE = {
    "hertz": coarse(cylinder="cylinder", block="cylinder-block"), "ring": coarse(ring="ring", plate="hole"),
    "thick-cylinder": coarse(liner="liner", jacket="jacket"),
    "sphere": ("body.ball.mesh.cells=5", "body.block.mesh.cells=[16, 16]"),
    "cone": ("body.ground.mesh.cells=[20, 20]",),
    "tilted": ("body.upper.mesh.parameters.h=0.6", "body.lower.mesh.parameters.h=0.45"),
    # the part of the block that is below the lowest part of the disc, which has 720 sides: few of a large one
    "ironing": ("tool.cylinder.radius=20", "tool.cylinder.centre=[0, 20]",
                'tool.cylinder.uy="-0.02*min(5*t, 1)"', "body.block.mesh.cells=[8, 3]",
                "body.block.mesh.lower=[-0.6, -1]", "body.block.mesh.upper=[1.6, 0]", "time.end=0.4"),
}
# The scenes that FreeFEM solves as they stand but for meshes, or with these settings.
SCENES = {
    "sloped": (), "broken-line": (), "stack": (), "exact-contact": (), "edge": (), "punch": (),
    "eccentric-punch": (), "receding": (), "turned": (), "cut-ring": (), "hertz": (), "ring": (),
    "sphere": (), "cone": (), "thick-cylinder": (), "open-close": ("time.scheme=backward-euler",),
    "ironing": ("time.steps=1",), "wedge": ("time.steps=4",),
    "cubes": ("body.material.young=3e4", "time.steps=4"), "tilted": (), "bimetal": (),
}
# Where FreeFEM's rule of degree 9 is further off the integrals of the tractions than the tolerances.
QUADRATURE = {"edge": 1e-8}
# Those that it does not, and why (the beginning of what mortier freefem says behind the scene's name).
UNKNOWN_TO_FREEFEM = {"cook": "no contact interface",
                      "roller": 'a tool that turns beside sliding = "finite"',
                      "press-fit": "contact: a line with corners",
                      "hook": "contact: a line with corners",
                      "bolt": "stage: expected --set stage=NAME", "rail": 'contact: kind = "tied"',
                      "rolling-ball": 'tool ball: a tool that turns beside sliding = "finite"',
                      "ball": "degree = 2", "shells": "degree = 2", "round-punch": "degree = 2",
                      "known-end": "degree = 2"}
HELD = ("body.top.boundary.4.uy=-1e-4*t", "body.middle.boundary.4.uy=-1e-4*t*(1+y)",
        "body.bottom.boundary.4.uy=0")
FREE_BUT_FOR_POINTS = (
    'body.lower.boundary=[{label=4, tx="10*t"}, {label=1, ty="10*t"}, {label=2, tx="-10*t"}]',
    'body.upper.boundary=[{label=4, tx="10*t"}, {label=3, ty="-10*t"}, {label=2, tx="-10*t"}]',
    "body.lower.point=[{at=[0, -1], ux=0, uy=0}, {at=[1, -1], uy=0}]", "body.upper.point=[{at=[1, 1], ux=0}]")
POINTS_THAT_PUSH = ("body.bottom.boundary=[{label=4, ux=0}]",
                    'body.bottom.point=[{at=[0, -2], uy=0}, {at=[1, -2], ux="-1e-5*t*(1+x)", uy="2e-5*t"}]')
# Laws, in all bodies or one in each.
LAWS = {"elastic": "", "Perzyna": "viscosity=1, yield_stress=1",
        "Norton": 'law="norton", reference_stress=10, reference_rate=0.05, exponent=5',
        "Maxwell": 'law="maxwell", relaxation_time=0.4',
        "solid": 'law="standard-solid", relaxation_time=0.4, relaxed_fraction=0.3',
        "plastic": 'law="viscoplastic", yield_stress=1, viscosity=0, kinematic_hardening=5, '
                   'isotropic_hardening=10',
        "power": 'law="viscoplastic", yield_stress=1, reference_stress=2, reference_rate=0.5, exponent=4'}


def of_law(law, more="", body=""):
    parameters = "".join(f", {each}" for each in (LAWS[law], more) if each)
    return f"body.{body and body + '.'}material={{young=100, poisson=0.3{parameters}}}"


def beside(upper, lower):
    return of_law(upper, body="upper"), of_law(lower, body="lower")


SOFT = of_law("Perzyna")  # Newton's method is at ease
NORTON, SOLID, MAXWELL, PLASTIC = ((of_law(law),) for law in ("Norton", "solid", "Maxwell", "plastic"))
POWER = (of_law("power", "kinematic_hardening=5"),)
GROWING = (PLASTIC[0].replace("viscosity=0", "viscosity=1"),)

OWN = 'body.material={young=100, poisson=0.3, law="expression", '
# Creep by a hyperbolic sine beyond a threshold.
SINH = (OWN + 'rate11="f*(2*s11-s22)/3", rate22="f*(2*s22-s11)/3", rate12="f*s12", '
        'parameters={mises="sqrt(s11^2-s11*s22+s22^2+3*s12^2)", limit=2, '
        'f="mises > limit ? 0.1*sinh((mises - limit)/4)/mises : 0"}}',)
# The volume creeps too, beside a spring: every component depends on every other.
SPRUNG = (OWN + 'rate11="0.02*x_11*size", rate22="0.03*x_22*size + 0.004*s33", rate12="0.04*x_12*size", '
          'rate33="0.02*s33*size - 0.003*s11", parameters={K=30, x_11="s11-K*e11", x_22="s22-K*e22", '
          'x_12="s12-K*e12", size="1 + (x_11^2+x_22^2+2*x_12^2+s33^2)/50"}}', 'plane="strain"')

TURNED_FEW = tuple(f"body.{body}.mesh={{shape='quadrilateral', cells={cells}, cut='both', corners={corners}}}"
                   for body, cells, corners in (
                       ("upper", 2, "[[0, 0], [0.8, 0.6], [0.2, 1.4], [-0.6, 0.8]]"),
                       ("lower", 3, "[[0.6, -0.8], [1.4, -0.2], [0.8, 0.6], [0, 0]]")))

# The note's stiff bodies.
STIFF = ("time.steps=3", "body.upper.material={young=3e11, poisson=0.3, law=\"viscoplastic\", viscosity=10, "
         "yield_stress=1}")
# What is there at t = 0 acts at once.
AT_ONCE = {
    "supports": ("body.lower.boundary=[{label=1, ux=0, uy=0}]",
                 "body.upper.boundary=[{label=3, ux=0.004, uy=-0.02}]"),
    "loads": ("body.upper.boundary=[{label=4, ux=0}, {label=3, ty=-2}]", "body.lower.force.y=-1",
              "body.lower.boundary.2.tx=-1"),
    "distances": ("body.upper.boundary=[{label=4, ux=0}, {label=3, uy=0}]", "contact.gap=-0.01*(1+x)",
                  "body.lower.boundary.2.tx=0"),
    "temperatures": ("body.upper.boundary=[{label=4, ux=0}, {label=3, uy=0}]", "body.material.expansion=1e-3",
                     "body.upper.temperature=20", "body.lower.boundary.2.tx=0"),
    "friction": ("contact.friction=0.3", "body.lower.boundary=[{label=1, ux=0, uy=0}]",
                 'body.upper.boundary=[{label=3, uy=-0.02, ux="0.004-0.01*t"}]'),
}

# Pressed, pushed along, pulled back until some nodes slip, on a sloped line and on two level ones.
THERE_AND_BACK = "{time=[0, 1, 2, 3], value=[0, 0, 1e-3, 4e-4]}"
RUBBED = ("contact.friction=0.3", "time.end=3", "time.steps=12",
          "body.lower.boundary=[{label=1, ux=0, uy=0}]",
          f'body.upper.boundary=[{{label=3, uy="-1e-3*min(t, 1)", ux={THERE_AND_BACK}}}]')
STACK_RUBBED = ("contact.friction=0.2", "contact.1.friction=0", "contact.1.shear_limit=20", "time.end=3",
                "time.steps=12", "body.bottom.boundary=[{label=1, ux=0, uy=0}]",
                'body.middle.boundary=[{label=4, ux="1e-4*t"}, {label=2, uy=0}]',
                f'body.top.boundary=[{{label=3, uy="-1e-3*min(t, 1)", ux={THERE_AND_BACK}}}]')
ON_A_SLOPE = ("body.lower.boundary=[{label=1, ux=0, uy=0}]", 'body.upper.boundary=[{label=3, ty="-10*t"}]')
STACK_OF_FREE_BODIES = ("contact.friction=0.4", "time.steps=8",
                        "body.bottom.boundary=[{label=1, ux=0, uy=0}]",
                        "body.middle.boundary=[{label=2, tx=0}]",
                        'body.top.boundary=[{label=3, ty="-10*min(4*t, 1)", tx="2*min(4*t, 1)*sin(9*t)"}]')
CREEPS_RUBBED = ('body.material={young=2e5, poisson=0.3, law="norton", reference_stress=100, '
                 'reference_rate=1e-3, exponent=3}',)
# Around an axis; there a pressure narrows the bodies outside.
RING = 'plane="axisymmetric"'
NARROWED = ("body.upper.boundary.2.tx=-5*t", "body.lower.boundary.2.tx=-5*t")
CONES = (RING, "time.end=3", "time.steps=12", "body.lower.boundary=[{label=1, ux=0, uy=0}]",
         'body.upper.boundary=[{label=3, uy={time=[0, 1, 2, 3], value=[0, -1e-3, -4e-4, -1e-3]}}]')
DISCS_RUBBED = (RING, "contact.friction=0.2", "contact.1.friction=0", "contact.1.shear_limit=20",
                "time.end=3", "time.steps=12", "body.bottom.boundary=[{label=1, ux=0, uy=0}]",
                'body.middle.boundary=[{label=2, tx={time=[0, 1, 2, 3], value=[0, 0, 60, -20]}}]',
                'body.top.boundary=[{label=3, uy="-1e-3*min(t, 1)"}]')
# Half of the section of a cone as a wedge of its own.
TURNED_TOOL = ('plane="strain"', "body.ground.boundary=[{label=1, ux=0, uy=0}, {label=4, ux=0}]",
               'tool.cone.rotation="-0.02*t"', "tool.cone.at=[0.2, 0.1]", "time.steps=4")
# The same, pushed down, along and about its reference point.
PUSHED_TOOL = (*TURNED_TOOL[:2], "tool.cone.at=[0.2, 0.1]", "tool.cone.uy=", "tool.cone.fy=-40*t",
               "tool.cone.moment=3*t", "time.steps=2")
# Blocks of the compression test.
FEW = ("body.upper.mesh=shared-meshes/block-upper-3.mesh", "body.lower.mesh=shared-meshes/block-lower-5.mesh")
# Blocks that flow, pressed, pushed along and pulled back.
FLOWING = (SOFT, "contact.friction=0.3", "time.end=3", "time.steps=12",
           *FEW, "body.lower.boundary=[{label=1, ux=0, uy=0}]",
           'body.upper.boundary=[{label=3, uy="-0.04*min(t, 1)", '
           'ux={time=[0, 1, 2, 3], value=[0, 0, 0.03, 0.01]}}]')
# A cylinder pressed on a block, pushed along and pulled back.
ROLLED = ("contact.friction=0.15", "time.end=3", "time.steps=6",
          'body.cylinder.boundary=[{label=2, uy="-1.22*min(t, 1)", '
          'ux={time=[0, 1, 2, 3], value=[0, 0, 0.2, 0.05]}}]')
# Contact that follows the bodies: a block pressed on a slope, pushed up along it beyond its end; a wedge
# that ploughs; a middle layer pulled out between two.
UP_THE_SLOPE = ("contact.sliding=finite", "time.steps=5", "body.lower.boundary=[{label=1, ux=0, uy=0}]",
                'body.upper.boundary=[{label=3, ux="0.6*max(0, t-0.2)", '
                'uy="0.3*max(0, t-0.2)-3e-3*min(5*t, 1)"}]')
PLOUGHED = ("contact.sliding=finite", 'plane="strain"', "body.ground.mesh.cells=[16, 6]",
            "body.ground.mesh.lower=[-4, -4]", "body.ground.mesh.upper=[12, 0]",
            "body.ground.mesh.focus=[2, 0]", "body.ground.mesh.grading=[4, 4]",
            "body.ground.boundary=[{label=1, ux=0, uy=0}]",
            "tool.cone.uy=-0.2*min(4*t, 1)", "tool.cone.ux=2*max(0, t-0.25)", "time.steps=8")
PULLED_OUT = ("contact.sliding=finite", "contact.1.sliding=allow", "contact.friction=0.2", "time.steps=5",
              "body.bottom.boundary=[{label=1, ux=0, uy=0}]",
              'body.top.boundary=[{label=3, ux="0.5*max(0, t-0.2)", uy="-2e-3*min(5*t, 1)"}]',
              "body.middle.boundary=[{label=4, ux=0}]")
WOOD = ('body.material={elasticity="orthotropic", young1=100, young2=30, young3=20, poisson12=0.3, '
        'poisson13=0.2, poisson23=0.25, shear12=15, angle="0.3 + x*y"}',)
GENERAL = ('body.material={elasticity="general", angle=0.4, '
           'stiffness=[[90, 20, 5, 30], [20, 70, 1, 20], [5, 1, 30, 0], [30, 20, 0, 80]]}', 'plane="strain"')
STABILISED = ("contact.stabilised=true", "contact.swap=true", "contact.gap=1e-5*x^2+2e-6",
              "body.upper.material.young=1e4")
IN_TURN = (("mortar",), ("interpolation", 'plane="strain"'), ("weighted", "degree=2"))
PAIRS_OF_LAWS = (("Perzyna", "Perzyna"), ("solid", "elastic"), ("power", "Maxwell"))

# Changes of scenes for what no scene has: scene, variant, what the settings change, and these.
CHANGED = [
    ("sloped", "interpolation", "sides swapped, parted by a parabola", "contact.swap=true",
     "contact.gap=1e-5*x^2+2e-6"),
    ("punch", "mortar", "sides swapped: overlap in part", "contact.swap=true"),
    ("punch", "mortar", "a round punch", "contact.gap=2e-3*x^2"),
    ("ring", "mortar", "sides swapped", "contact.swap=true"),
    ("ring", "mortar", "distances of the circles", 'contact.initial="as-meshed"'),
    ("hertz", "mortar", "sides swapped", "contact.swap=true"),
    ("sloped", "interpolation", "plane strain", 'plane="strain"'),
    ("turned", "interpolation", "plane strain, nearly incompressible", 'plane="strain"',
     SOFT.replace("0.3", "0.49"), 'body.material.projection="elasticity"'),
    ("stack", "mortar", "held on the left up to the contact lines", *HELD),
    ("stack", "interpolation", "held on the left, but for the bottom", *HELD[:2]),
    ("turned", "mortar", "sheared by a tangential motion", SOFT, "contact.swap=true", "contact.sliding=allow",
     "body.lower.boundary.4.ut=-0.02*t*(y+0.8)"),
    ("turned", "interpolation", "a bent roller, body forces", SOFT, "body.lower.boundary.1.un=0.1*t*(x-0.6)",
     "body.lower.force.x=x*t", "body.upper.force.y=-3*sin(x)*t"),
    ("sloped", "interpolation", "Norton creep", *NORTON, "time.steps=3"),
    ("turned", "mortar", "Norton creep, plane strain", *NORTON, 'plane="strain"'),
    ("sloped", "mortar", "a user-defined law", *SINH, "time.steps=3"),
    ("turned", "interpolation", "a user law of the strain", *SPRUNG, *TURNED_FEW, "time.steps=2"),
    ("sloped", "mortar", "held at points that carry nothing", *FREE_BUT_FOR_POINTS),
    ("stack", "interpolation", "held at points that push", *POINTS_THAT_PUSH),
    ("sloped", "interpolation", "standard linear solid", *SOLID, "time.steps=3"),
    ("turned", "mortar", "Maxwell, plane strain", *MAXWELL, 'plane="strain"'),
    ("sloped", "interpolation", "power of the overstress", *POWER, "time.steps=3"),
    ("turned", "mortar", "power of the overstress, plane strain", *POWER, 'plane="strain"'),
    ("sloped", "mortar", "hardening", *GROWING, "time.steps=3"),
    ("sloped", "mortar", "plasticity", *PLASTIC, "time.steps=3"),
    ("turned", "interpolation", "plasticity, plane strain", *PLASTIC, 'plane="strain"'),
    ("sloped", "mortar", "orthotropic, turning axes", *WOOD),
    ("turned", "interpolation", "orthotropic, plane strain", *WOOD, 'plane="strain"'),
    ("turned", "mortar", "averaged volume, flowing and elastic, plane strain", 'plane="strain"',
     "body.upper.volume=averaged", "contact.sliding=allow", SOFT.replace("body.", "body.upper.", 1),
     "body.lower.material={young=100, poisson=0.49999}"),
    ("sloped", "weighted", "averaged volume, creeping, plane strain, quadratic", *NORTON, 'plane="strain"',
     "degree=2", "body.volume=averaged", "time.steps=3"),
    ("sloped", "mortar", "averaged volume, flowing, heated, around an axis", *GROWING, RING,
     "body.volume=averaged", "time.steps=3", "body.material.expansion=1e-3",
     "body.upper.temperature=t*(1+x)"),
    ("sloped", "weighted", "averaged volume, heated, around an axis, quadratic", RING,
     "body.material={young=100, poisson=0.4999}", "body.material.expansion=1e-3",
     "body.upper.temperature=t*(1+x*y)", "degree=2", "time.steps=3"),
    ("turned", "weighted", "any elasticity, plane strain, quadratic", *GENERAL, "degree=2"),
    ("ring", "mortar", "heated", "body.material.expansion=1e-3", "body.ring.temperature=50*t*(1+x*y)",
     "time.steps=2"),
    ("ring", "weighted", "heated, plane strain, quadratic", "body.material.expansion=1e-3",
     "body.plate.temperature=-50*t*x", 'plane="strain"', "degree=2"),
    ("sloped", "mortar", "standard linear solid, heated, plane strain", *SOLID,
     "body.material.expansion=1e-3", "body.upper.temperature=t*(1+x)", 'plane="strain"', "time.steps=3"),
    ("sloped", "interpolation", "a distance that changes", SOFT, "contact.gap=(1e-3*x^2+1e-3)*cos(3*t)"),
    ("sloped", "weighted", "a distance that changes, quadratic", SOFT, "contact.gap=(1e-3*x^2+1e-3)*cos(3*t)",
     "degree=2"),
    ("sphere", "weighted", "sides swapped", "contact.swap=true"),
    ("cone", "weighted", "quadratic", "degree=2"),
    ("cone", "mortar", "stabilised, flowing, in three steps", "contact.stabilised=true",
     SOFT.replace("100", "1000", 1), "body.ground.mesh.cells=[10, 10]", "time.steps=3"),
    ("cone", "mortar", "a wedge that turns, plane strain", *TURNED_TOOL),
    ("cone", "weighted", "a wedge that turns and rubs, plane strain", *TURNED_TOOL, "contact.friction=0.3",
     'tool.cone.ux="0.02*t"'),
    ("cone", "mortar", "a cone that a force moves, quadratic", "degree=2", "tool.cone.uy=",
     "tool.cone.fy=-60*t"),
    ("cone", "weighted", "a wedge that a force and a moment move, plane strain", *PUSHED_TOOL),
    ("cone", "mortar", "a wedge that a force and a moment press and a motion drags, friction", *PUSHED_TOOL,
     "contact.friction=0.3", "tool.cone.ux=0.01*t"),
    ("sloped", "mortar", "a cone that flows, around an axis", SOFT, 'plane="axisymmetric"', "time.steps=4",
     "body.upper.boundary.2.tx=-5*t", "body.lower.boundary.2.tx=-5*t", "contact.sliding=allow"),
    ("sloped", "interpolation", "around an axis, heated, creeping", *NORTON, RING, "time.steps=3",
     "body.material.expansion=1e-3", "body.upper.temperature=t*(1+x)"),
    ("sloped", "weighted", "around an axis, heated, quadratic", RING, "degree=2",
     "body.material.expansion=1e-5", "body.lower.temperature=20*t*(1+x*y)"),
    ("sloped", "mortar", "around an axis, power of the overstress", *POWER, RING, "time.steps=3", *NARROWED),
    ("sloped", "weighted", "around an axis, hardening", *GROWING, RING, "time.steps=3", *NARROWED),
    ("sloped", "interpolation", "around an axis, plasticity", *PLASTIC, RING, "time.steps=3", *NARROWED),
    ("sloped", "mortar", "around an axis, orthotropic, turning axes", *WOOD, RING, *NARROWED),
    ("sloped", "weighted", "around an axis, any elasticity, quadratic", *GENERAL[:1], RING, "degree=2",
     *NARROWED),
    ("punch", "weighted", "linear, sides swapped: overlap in part", "contact.swap=true"),
    ("ring", "weighted", "linear"),
    ("sloped", "weighted", "linear, parted by a parabola", "contact.gap=1e-5*x^2+2e-6"),
    ("stack", "weighted", "linear, held on the left up to the contact lines", *HELD),
    ("stack", "mortar", "beside weighted", "contact.1.variant=weighted", *HELD),
    *(("sloped", variant, f"degree {degree}, stabilised, finer and stiffer side nonmortar", *STABILISED,
       f"degree={degree}") for degree, variant in ((1, "mortar"), (2, "weighted"))),
    ("sloped", "weighted", "stabilised, finer and stiffer side nonmortar, on a wall", *STABILISED,
     "body.upper.boundary=[{label=1, ux=0, uy=0}]"),
    # Laws beside each other
    *(("sloped", variant, f"{upper} on {lower}", *beside(upper, lower), "time.steps=3",
       "contact.sliding=allow", *more)
      for upper, lower, (variant, *more) in zip(LAWS, [*LAWS][3:] + [*LAWS][:3], itertools.cycle(IN_TURN))),
    *(("compression", variant, "viscoplastic on Perzyna", *STIFF) for variant in VARIANTS),
    # What acts at once
    *(("sloped", variant, f"at once, {what}", *beside(*laws), "time.steps=3", *changes, *more)
      for (what, changes), laws, (variant, *more) in zip(AT_ONCE.items(), itertools.cycle(PAIRS_OF_LAWS),
                                                         itertools.cycle(IN_TURN))),
    ("sloped", "mortar", "ends without loads", *beside("elastic", "elastic"), "time.steps=2",
     'body.upper.boundary=[{label=4, ux=0, uy=0}, {label=3, ty="-10*t*(1-t)"}]',
     'body.lower.boundary=[{label=4, ux=0}, {label=1, uy=0}]'),
    # Friction
    ("sloped", "mortar", "friction, rubbed", *RUBBED),
    ("sloped", "interpolation", "friction, rubbed, sides swapped", *RUBBED, "contact.swap=true"),
    ("sloped", "weighted", "friction, rubbed, plane strain", *RUBBED, 'plane="strain"'),
    ("sloped", "mortar", "friction, rubbed, quadratic", *RUBBED, "degree=2"),
    ("stack", "mortar", "friction of two laws", *STACK_RUBBED),
    ("stack", "interpolation", "friction of two laws", *STACK_RUBBED),
    ("compression", "mortar", "friction, flowing", *FLOWING),
    ("compression", "interpolation", "friction, flowing, plane strain, sides swapped", *FLOWING,
     "contact.swap=true", "plane=\"strain\""),
    ("compression", "mortar", "friction, flowing, steps chosen by their error", *FLOWING,
     "time.tolerance=0.03"),
    ("sloped", "mortar", "friction, Norton creep", *RUBBED, *CREEPS_RUBBED),
    ("sloped", "mortar", "friction, cones pressed and pulled", *CONES, "contact.friction=0.3"),
    ("sloped", "weighted", "friction, cones pressed and pulled", *CONES, "contact.friction=0.3",
     "contact.swap=true"),
    ("stack", "interpolation", "friction of two laws, around an axis", *DISCS_RUBBED),
    ("sloped", "mortar", "friction, a block on a slope", *ON_A_SLOPE, "contact.friction=0.501"),
    ("sloped", "interpolation", "friction, a block on a slope, sides swapped", *ON_A_SLOPE,
     "contact.friction=0.55", "contact.swap=true"),
    ("stack", "mortar", "friction, free bodies", *STACK_OF_FREE_BODIES),
    ("stack", "weighted", "friction, free bodies", *STACK_OF_FREE_BODIES),
    ("hertz", "mortar", "friction along an arc", *ROLLED),
    ("hertz", "weighted", "friction along an arc, sides swapped", *ROLLED, "contact.swap=true"),
    # Contact that follows the bodies
    ("ironing", "weighted", "quadratic, follows", "body.block.mesh.cells=[6, 2]", "degree=2", "time.steps=2"),
    ("sloped", "weighted", "stabilised, axes that turn, follows", "contact.stabilised=true", *UP_THE_SLOPE,
     *WOOD, "contact.swap=true"),
    ("sloped", "weighted", "off the end, follows", *UP_THE_SLOPE),
    ("sloped", "mortar", "friction, sides swapped, follows", *UP_THE_SLOPE, "contact.friction=0.3",
     "contact.swap=true"),
    ("sloped", "interpolation", "plane strain, the upper one stiffer, follows", *UP_THE_SLOPE,
     'plane="strain"', "body.upper.material.young=1e7"),
    ("sloped", "weighted", "friction, quadratic, follows", *UP_THE_SLOPE, "contact.friction=0.3", "degree=2"),
    ("sloped", "mortar", "flowing, quadratic, sides swapped, follows", *UP_THE_SLOPE, SOFT, "degree=2",
     "contact.swap=true", "time.steps=10"),
    ("cone", "mortar", "a wedge that ploughs, follows", *PLOUGHED, "contact.friction=0.2"),
    ("sphere", "weighted", "around an axis, follows", "contact.sliding=finite", "body.ball.mesh.cells=5",
     "body.block.mesh.cells=[12, 12]", "body.ball.boundary.2.uy=-1*t", "time.steps=2"),
    ("stack", "weighted", "beside one that does not, friction, follows", *PULLED_OUT),
    # Quadratic displacements
    ("compression", "interpolation", "quadratic", *FEW, "degree=2", "time.steps=4"),
    ("compression", "weighted", "quadratic", *FEW, "degree=2", "time.steps=4", "contact.swap=true"),
    ("sloped", "weighted", "quadratic, parted by a parabola", "degree=2", "contact.gap=1e-5*x^2+2e-6"),
    ("sloped", "mortar", "quadratic, plane strain", "degree=2", 'plane="strain"'),
    ("stack", "weighted", "quadratic, held on the left up to the contact lines", "degree=2", *HELD),
    ("stack", "weighted", "quadratic, held at points that push", "degree=2", *POINTS_THAT_PUSH),
    ("sloped", "mortar", "quadratic, a cone that flows, around an axis", "degree=2", SOFT,
     'plane="axisymmetric"', "time.steps=4", "body.upper.boundary.2.tx=-5*t",
     "body.lower.boundary.2.tx=-5*t"),
    ("hertz", "weighted", "quadratic", "degree=2"),
    ("ring", "mortar", "quadratic", "degree=2"),
    ("thick-cylinder", "weighted", "quadratic", "degree=2", "time.steps=4"),
    ("turned", "weighted", "quadratic", "degree=2", SOFT),
    ("cut-ring", "interpolation", "normal and tangential motion", "body.upper.boundary.1.un=0.01*t*x",
     "body.lower.boundary.1.ut=0.01*t*x", "body.lower.boundary.1.un=0.003*t*y"),
]


def scene_cases():
    """Every scene with both variants, and the changed ones."""
    return [*(SceneCase(name, variant, changes=changes) for name, changes in SCENES.items()
              for variant in VARIANTS),
            *(SceneCase(scene, variant, what, tuple(changes)) for scene, variant, what, *changes in CHANGED)]
