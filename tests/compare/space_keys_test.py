"""Every key of the table of keys in a scene in space: it changes the result, or it is refused in one line
that names it, or it chooses how the program works and a wrong value of it is refused."""
import hashlib
import json
import unittest

from scene_parts import body, box, contact, quantity, timed
from support import InFolder, mortier, told

SCENE = ("dimension = 3\n"
         + body("upper", box([0, 0, 0], [1, 1, 1], 2),
                "young = 100, poisson = 0.3, viscosity = 1, yield_stress = 1", "label = 4, ux = 0",
                "label = 5, uy = 0", 'label = 3, tz = "-2*t*(1 + 0.5*x)"')
         + body("lower", box([0, 0, -1], [1, 1, 0], [3, 2, 1]), 100, "label = 4, ux = 0", "label = 5, uy = 0",
                "label = 1, uz = 0") + contact(("upper", 1), ("lower", 3))
         + quantity("floor", "reaction", "lower", 1, "z") + timed(4)
         + '[check]\nallow = ["flow-locks", "large-strain", "large-displacement"]\n')
ELASTIC = "body.upper.material={young=100, poisson=0.3}"
UPPER = 'body.upper.mesh={shape="cuboid", lower=[0, 0, 0], upper=[1, 1, 1], cells=2}'
ORTHOTROPIC = ("young1=100, young2=50, young3=80, poisson12=0.2, poisson13=0.1, poisson23=0.2, shear12=30, "
               "shear13=20, shear23=25")
OWN = ('rate11="0.1*s11", rate22="0.1*s22", rate12="0.1*s12", rate33="0.1*s33", rate13="0.1*s13", '
       'rate23="0.1*s23"')
HELD_ABOVE = "body.upper.boundary=[{label=3, ux=0, uy=0, uz='-0.1*t*t'}]"
ALONG_Z = ("contact=", "body.upper.boundary=[{label='start', ux=0, uy=0, uz=0}, {label='end', tz='-x*t'}]")
NOT_IN_SPACE = "expected none with dimension = 3"


def material(text):
    return f"body.upper.material={{young=100, poisson=0.3, {text}}}"


def floor(text):
    return f"quantity=[{{name='floor', {text}}}]"


def either(key, first, second, *beside):
    """Two values of a key, of which the results differ."""
    return [*beside, f"{key}={first}"], [*beside, f"{key}={second}"]


def added(setting, *beside):
    """A key that is not there, and one that is."""
    return [*beside], [*beside, setting]


def refused(said, *settings):
    return said, [*settings]


def in_material(before, first, second):
    return [material(before + first)], [material(before + second)]


def ram(text, mesh="mesh={shape='cuboid', lower=[-1, -1, 1], upper=[2, 2, 2], cells=1}", at=(0.5, 0.5, 1)):
    """The upper block is pressed by a tool that friction holds."""
    return [ELASTIC, "body.upper.boundary=[{label=4, ux=0}, {label=5, uy=0}]",
            "contact=[{nonmortar={body='upper', label=1}, mortar={body='lower', label=3}}, "
            "{nonmortar={body='upper', label=3}, mortar={body='ram', label=1}, friction=0.5}]",
            f"tool=[{{name='ram', {mesh}, at={[*at]}, {text}}}]"]


def handle(text, more="uz=-0.01, rotation_x=0.01"):
    """The upper block is tied to the motion of a point."""
    return [ELASTIC, "body.upper.boundary=[{label=4, ux=0}, {label=5, uy=0}]",
            "contact=[{nonmortar={body='upper', label=1}, mortar={body='lower', label=3}}, "
            f"{{kind='tied', sides=[{{body='upper', label=3}}, {{body='handle'}}], {text}}}]",
            f"tool=[{{name='handle', shape='point', at=[0.5, 0.5, 1], {more}}}]"]


def wedge(text):
    """A point may move the sides of a tie apart."""
    return [ELASTIC, "contact=[{kind='tied', nonmortar={body='upper', label=1}, mortar={body='lower', "
            "label=3}, offset='wedge'}]", f"tool=[{{name='wedge', shape='point', at=[0, 0, 0], {text}}}]"]


# Key: the settings of two runs whose results differ, or what is said of the one setting that is refused.
DIFFERENT = {
    "title": either("title", "one", "two"), "dimension": refused("dimension = 4", "dimension=4"),
    "degree": either("degree", 1, 2), "units": added('units="mm, N, MPa"'),
    "body.name": refused('name = "a b"', "body.upper.name=a b"),
    "body.mesh": refused("mesh = ", "body.upper.mesh=nothing.mesh"),
    "body.temperature": either("body.upper.temperature", 0, 1, material("expansion=1e-2")),
    "body.mesh.file": either("body.upper.mesh", '{file="one.mesh"}', '{file="two.mesh"}'),
    "body.mesh.region": either("body.upper.mesh", '{file="two.mesh"}', '{file="two.mesh", region=1}',
                               "contact=", "body.upper.boundary=[{label=1, ux=0, uy=0, uz=0}, "
                               "{label=4, tx=1}]"),
    "body.mesh.size": either("body.upper.mesh", '{file="box.geo", size=1}', '{file="box.geo", size=0.14}'),
    "body.mesh.parameters": either("body.upper.mesh", '{file="box.geo", size=1}',
                                   '{file="box.geo", size=1, parameters={H=2}}'),
    "body.mesh.shape": either("body.upper.mesh", '{shape="cylinder", cells=1, height=1}',
                              '{shape="cuboid", cells=1}', HELD_ABOVE),
    "body.mesh.cells": either("body.upper.mesh.cells", 1, 2),
    "body.mesh.cut": either("body.upper.mesh", *(f'{{shape="rectangle", cells=2, extrude=1, layers=2, '
                                                 f'cut="{cut}"}}' for cut in ("rising", "both")), *ALONG_Z),
    "body.mesh.lower": either("body.lower.mesh.lower", "[0, 0, -1]", "[0, 0, -2]"),
    "body.mesh.upper": either("body.upper.mesh.upper", "[1, 1, 1]", "[1, 1, 2]"),
    "body.mesh.radius": either("body.upper.mesh", '{shape="cylinder", cells=1, height=1, keep=["x", "y"]}',
                               '{shape="cylinder", cells=1, height=1, keep=["x", "y"], radius=2}'),
    "body.mesh.centre": either("body.upper.mesh", '{shape="cylinder", cells=1, keep=["x", "y"]}',
                               '{shape="cylinder", cells=1, centre=[0, 0.1, 0], keep=["x", "y"]}'),
    "body.mesh.height": either("body.upper.mesh", '{shape="cylinder", cells=1, keep=["x", "y"]}',
                               '{shape="cylinder", cells=1, height=2, keep=["x", "y"]}'),
    "body.mesh.keep": either("body.upper.mesh", '{shape="cylinder", cells=1, keep=["x", "y"]}',
                             '{shape="cylinder", cells=1}', HELD_ABOVE),
    "body.mesh.extrude": either("body.upper.mesh", *(f'{{shape="rectangle", cells=2, extrude={length}, '
                                                     'layers=2}' for length in (1, 2)), *ALONG_Z),
    "body.mesh.layers": either("body.upper.mesh", *(f'{{shape="rectangle", cells=2, extrude=1, '
                                                    f'layers={layers}}}' for layers in (1, 2)), *ALONG_Z),
    "body.mesh.revolve": either("body.upper.mesh", *(f'{{shape="rectangle", lower=[5, 0], upper=[6, 1], '
                                                     f'cells=2, revolve={angle}, layers=2}}'
                                                     for angle in (0.5, 1)),
                                "contact=", "body.upper.boundary=[{label=1, ux=0, uy=0, uz=0}, "
                                "{label=3, ty=-1}]"),
    **{f"body.force.{axis}": added(f"body.upper.force={{{axis}=-0.1}}") for axis in "xyz"},
    "body.temperature.file": either("body.upper.temperature", "0", '{file="hot.txt"}',
                                    material("expansion=1e-2")),
    "body.temperature.factor": either("body.upper.temperature", '{file="hot.txt"}',
                                      '{file="hot.txt", factor=2}', material("expansion=1e-2")),
    "body.material.young": either("body.upper.material.young", 100, 50),
    "body.material.poisson": either("body.upper.material.poisson", 0.3, 0.2),
    "body.material.law": either("body.upper.material", "{young=100, poisson=0.3}",
                                '{young=100, poisson=0.3, law="maxwell", relaxation_time=1}'),
    "body.material.viscosity": either("body.upper.material.viscosity", 1, 2),
    "body.material.yield_stress": either("body.upper.material.yield_stress", 1, 0.5),
    "body.material.reference_stress": in_material('law="norton", reference_rate=1, exponent=2, ',
                                                  "reference_stress=1", "reference_stress=2"),
    "body.material.reference_rate": in_material('law="norton", reference_stress=1, exponent=2, ',
                                                "reference_rate=1", "reference_rate=2"),
    "body.material.exponent": in_material('law="norton", reference_stress=1, reference_rate=1, ',
                                          "exponent=2", "exponent=3"),
    "body.material.relaxation_time": in_material('law="maxwell", ', "relaxation_time=1", "relaxation_time=2"),
    "body.material.relaxed_fraction": in_material('law="standard-solid", relaxation_time=1, ',
                                                  "relaxed_fraction=0.2", "relaxed_fraction=0.4"),
    **{f"body.material.{kind}_hardening": in_material(
        'law="viscoplastic", yield_stress=1, viscosity=1, ', f"{kind}_hardening=1", f"{kind}_hardening=20")
       for kind in ("kinematic", "isotropic")},
    **{f"body.material.rate{ij}": in_material('law="expression", ', OWN,
                                              OWN.replace(f'{ij}="0.1', f'{ij}="0.2'))
       for ij in ("11", "22", "12", "33", "13", "23")},
    "body.material.parameters": in_material('law="expression", ' + OWN.replace('"0.1*s11', '"a*s11') + ", ",
                                            "parameters={a=1}", "parameters={a=2}"),
    "body.material.elasticity": either("body.upper.material", "{young=100, poisson=0.3}",
                                       f'{{elasticity="orthotropic", {ORTHOTROPIC}}}'),
    **{f"body.material.{key}": either("body.upper.material", *(
        f'{{elasticity="orthotropic", {text}}}'
        for text in (ORTHOTROPIC, ORTHOTROPIC.replace(f"{key}=", f"{key}=1"))))
       for key in ("young1", "young2", "young3", "shear12", "shear13", "shear23")},
    **{f"body.material.{key}": either("body.upper.material", *(
        f'{{elasticity="orthotropic", {text}}}'
        for text in (ORTHOTROPIC, ORTHOTROPIC.replace(f"{key}=0.", f"{key}=0.0"))))
       for key in ("poisson12", "poisson13", "poisson23")},
    "body.material.axes": either("body.upper.material", f'{{elasticity="orthotropic", {ORTHOTROPIC}}}',
                                 f'{{elasticity="orthotropic", {ORTHOTROPIC}, '
                                 'axes=[[0, 1, 0], [0, 0, 1]]}'),
    "body.material.angle": either("body.upper.material", *(
        f'{{elasticity="orthotropic", {ORTHOTROPIC}, angle={angle}}}' for angle in (0, 1))),
    "body.material.stiffness": either(
        "body.upper.material", *('{elasticity="general", stiffness=[' + ", ".join(
            "[" + ", ".join(str((size if i == j else 0)) for j in range(6)) + "]" for i in range(6))
            + "]}" for size in (100, 50))),
    "body.material.expansion": either("body.upper.temperature", 0, 1, material("expansion=1e-2")),
    **{f"body.initial_stress.s{ij}": added(f"body.upper.initial_stress={{s{ij}=0.1}}")
       for ij in ("11", "22", "12", "33", "13", "23")},
    "body.region.label": either("body.upper.region", "[{label=1, material={young=50, poisson=0.3}}]",
                                "[{label=2, material={young=50, poisson=0.3}}]",
                                'body.upper.mesh={file="two.mesh"}'),
    "body.region.material": added("body.upper.region=[{label=1, material={young=50, poisson=0.3}}]",
                                  'body.upper.mesh={file="two.mesh"}'),
    "body.region.initial_stress": added("body.upper.region=[{label=1, initial_stress={s13=0.1}}]",
                                        'body.upper.mesh={file="two.mesh"}'),
    "body.boundary.label": refused("label = 9", "body.upper.boundary=[{label=9, ux=0}]"),
    **{f"body.boundary.{key}": (["body.upper.boundary=[{label=3, ux=0, uy=0, uz=0}, {label=2, tx=0}]"],
                                ["body.upper.boundary=[{label=3, ux=0, uy=0, uz=0}, "
                                 f"{{label=2, {key}={v}}}]"])
       for key, v in (("ux", "'z - 1'"), ("uy", "'z - 1'"), ("uz", "'z - 1'"), ("un", "'z - 1'"),
                      ("ty", 1), ("tz", -1), ("pressure", 1))},
    "body.boundary.tx": either("body.upper.boundary.3.tx", 0, 0.1),
    "body.point.at": either("body.upper.point", "[{at=[1, 1, 1], uz=-0.1}]", "[{at=[1, 0, 1], uz=-0.1}]"),
    **{f"body.point.{key}": added(f"body.upper.point=[{{at=[1, 1, 1], {key}=-0.1}}]")
       for key in ("ux", "uy", "uz")},
    **{f"body.point.{key}": added(f"body.upper.point=[{{at=[1, 1, 1], {key}=-0.1}}]")
       for key in ("fx", "fy", "fz")},
    "tool.shape": (handle("along=['z']"), handle("along=['z']", "uz=-0.01")),
    "contact.coupling": (handle("coupling='kinematic'"), handle("coupling='distributing'")),
    "contact.along": (handle("along=['z']"), handle("along=['y', 'z']")),
    "contact.stiffness": (handle("coupling='distributing'"),
                          handle("coupling='distributing', stiffness=100")),
    "contact.offset": (wedge("uz=0.01"), wedge("uz=0.02")),
    "contact.nonmortar": either("contact", "[{nonmortar={body='upper', label=1}, mortar={body='lower', "
                                "label=3}}]", "[{nonmortar={body='lower', label=3}, mortar={body='upper', "
                                "label=1}}]"),
    "contact.mortar": refused("mortar", "contact=[{nonmortar={body='upper', label=1}}]"),
    "contact.sides": refused("sides", "contact=[{sides=[{body='upper', label=1}]}]"),
    "contact.sides.body": refused("body = \"no\"", "contact=[{sides=[{body='upper', label=1}, {body='no', "
                                  "label=1}]}]"),
    "contact.sides.label": refused("label = 9", "contact=[{sides=[{body='upper', label=1}, {body='lower', "
                                   "label=9}]}]"),
    "contact.kind": either("contact.kind", "unilateral", "tied"),
    "contact.variant": either("contact.variant", "weighted", "interpolation"),
    "contact.stabilised": either("contact.stabilised", "true", "false"),
    "contact.swap": either("contact.swap", "true", "false"),
    "contact.initial": refused("apart", "contact.initial=reject", "body.upper.mesh.lower=[0, 0, 0.1]"),
    "contact.gap": either("contact.gap", 0, 0.01, HELD_ABOVE),
    "tool.name": refused("name = ", *(each.replace("'ram'", "'a b'") for each in ram("uz=-0.005"))),
    "tool.mesh": (ram("uz=-0.005"), ram("uz=-0.005", "mesh={shape='cuboid', lower=[-1, -1, 1], "
                                        "upper=[0.4, 2, 2], cells=1}")),
    "tool.at": (ram("uz=-0.005, rotation_x=0.001"), ram("uz=-0.005, rotation_x=0.001", at=(0, 1, 0))),
    **{f"tool.{key}": (ram("uz=-0.005"), ram(f"uz=-0.005, {key}=-0.001" if key != "uz" else "uz=-0.006"))
       for key in ("ux", "uy", "uz", "rotation_x", "rotation_y", "rotation_z")},
    **{f"tool.{key}": tuple(ram(f"uz=-0.005, {key}={value}" if key != "fz" else f"fz={10*value}")
                            for value in (-0.01, -0.02))
       for key in ("fx", "fy", "fz", "moment_x", "moment_y", "moment_z")},
    **{f"tool.{key}": refused(f"{key} = ", *ram(f"uz=-0.1, {key}={value}"))
       for key, value in (("points", "[[0, 0], [1, 0]]"), ("labels", "[1]"),
                          ("centre", "[0, 0]"), ("radius", 1), ("lower", "[0, 0]"), ("upper", "[1, 1]"),
                          ("rotation", 0.1), ("moment", 0.1))},
    "quantity.name": either("quantity.name", "one", "two"),
    **{f"quantity.{kind}": either("quantity", "", f"[{{name='q', {kind}={{body='upper'}}}}]")
       for kind in ("stored_energy", "dissipated_energy", "work", "external_work", "thermal_work",
                    "largest_mises")},
    **{f"quantity.{kind}": either("quantity", "", f"[{{name='q', {kind}={{body='upper', label=1}}}}]")
       for kind in ("largest_pressure", "contact_area", "mean_pressure")},
    **{f"quantity.{kind}": either("quantity", "", f"[{{name='q', {kind}={{body='lower', label={label}}}, "
                                  "component='x'}]")
       for kind, label in (("reaction", 4), ("contact_force", 3), ("displacement", 3))},
    "quantity.component": either("quantity.component", "moment_x", "moment_y"),
    "quantity.about": either("quantity.about", "[0, 0, 0]", "[0, 1, 2]", "quantity.component=moment_x"),
    "quantity.stored_energy.body": either("quantity", *(f"[{{name='q', stored_energy={{body='{body}'}}}}]"
                                                        for body in ("upper", "lower"))),
    **{f"quantity.{kind}.body": refused('body = "no"', floor(
        f"{kind}={{body='no', label=1}}, component='x'")) for kind in ("contact_force", "reaction")},
    "quantity.mean_pressure.body": refused('body = "no"', floor("mean_pressure={body='no', label=1}")),
    **{f"quantity.{kind}.label": refused("label = 9", floor(
        f"{kind}={{body='upper', label=9}}, component='x'")) for kind in ("contact_force", "reaction")},
    "quantity.mean_pressure.label": refused("label = 9", floor("mean_pressure={body='upper', label=9}")),
    "quantity.reaction.point": either("quantity", *(
        f"[{{name='q', displacement={{body='upper', point=[1, {y}, 1]}}, component='x'}}]" for y in (0, 1))),
    "time.end": either("time.end", 1, 2), "time.steps": either("time.steps", 4, 2),
    "time.scheme": either("time.scheme", "backward-euler", "sdirk2"),
    "time.tolerance": added("time.tolerance=0.1"),
    "time.max_steps": refused("steps", "time.tolerance=1e-4", "time.max_steps=1"),
    "time.breaks": added("time.breaks=[0.123]", "time.tolerance=0.1"),
    "solver.list_solutions": refused("list_solutions = true", "solver.list_solutions=true"),
    "accuracy.energy": added("accuracy.energy=0.3", ELASTIC, "time.steps=1"),
    "accuracy.max_unknowns": refused("max_unknowns", "accuracy.max_unknowns=10", "accuracy.energy=0.1",
                                     ELASTIC, "time.steps=1"),
    "accuracy.max_seconds": refused("max_seconds = -1", "accuracy.energy=0.1", "accuracy.max_seconds=-1"),
    "output.every": added("output.every=1"),
    "output.state": added("output.state=true"),
    "start": added("start=begun"),
    **{f"stage.{key}": refused("the scene has no [[stage]]", "stage=one")  # going_on_test
       for key in ("name", "end", "steps", "set")},
    # Of the plane.
    "plane": refused(NOT_IN_SPACE, "plane=strain"),
    "body.volume": added("body.upper.volume=averaged", ELASTIC),
    **{f"body.mesh.{key}": refused(f"{key} = ", UPPER, f"body.upper.mesh.{key}={value}")
       for key, value in (("focus", "[0, 0]"), ("grading", 2), ("corners", "[0, 0]"), ("inner", 1),
                          ("outer", 2), ("span", "full"), ("lowest", "[0, 0]"), ("core", 0.1))},
    "body.boundary.ut": refused(NOT_IN_SPACE, "body.upper.boundary.3.ut=0"),
    "contact.friction": added("contact.friction=0.3"),
    "contact.shear_limit": added("contact.shear_limit=0.3"),
    "contact.sliding": added("contact.sliding=finite"),
    "quantity.friction_work": either("quantity", *(f"[{{name='floor', {text}}}]" for text in (
        "friction_work={body='upper', label=1}", "work={body='upper'}")), "contact.friction=0.3"),
    "quantity.contact_length": refused("contact_area with dimension = 3",
                                       floor("contact_length={body='upper', label=1}")),
    **{f"quantity.mean_pressure.{key}": refused(NOT_IN_SPACE, floor(
        f"mean_pressure={{body='upper', label=1, {key}={value}}}"))
       for key, value in (("from", "[0, 0]"), ("to", "[0, 0]"), ("margin", 0.1))},
    "solver.method": refused("penalty-duality", "solver.method=penalty-duality"),
    "accuracy.quantity": refused("quantity = ", "accuracy={quantity='floor', tolerance=0.1}"),
    "accuracy.tolerance": refused("tolerance = 0.1", "accuracy={energy=0.1, tolerance=0.1}"),
    "accuracy.bound": refused(NOT_IN_SPACE, "accuracy={energy=0.1, bound=true}"),
}
# What results do not depend on, or in their last digits: a value that is refused.
HOW = {
    "solver.tolerance": 2, "solver.max_iterations": 0, "solver.linear": "no", "solver.reduce": 3,
    "check.allow": 1, "body.material.projection": "no",
    "body.material.isotropic": "no",
}
BOX = """\
SetFactory("OpenCASCADE");
DefineConstant[ H = 1 ];
Box(1) = {0, 0, 0, 1, 1, H};
Physical Surface("left", 4) = {1};
Physical Surface("front", 5) = {3};
Physical Surface("bottom", 1) = {5};
Physical Surface("top", 3) = {6};
Physical Volume(1) = {1};
"""


def setting(key):
    return key.replace("body.", "body.upper.", 1)


def blocks(middle):
    """The cube of the scene in two cells, of six tetrahedra each; the upper one has a region of
    its own, and begins at `middle`."""
    x = [(i & 1, i >> 1 & 1, (0, middle, 1)[z]) for z in range(3) for i in range(4)]
    cells = [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]]
    tets = [[4*k + v for v in cell] + [k + 1] for k in range(2) for cell in cells]
    triangles = [([0, 1, 3], 1), ([0, 3, 2], 1), ([8, 11, 9], 3), ([8, 10, 11], 3)]
    for k in range(2):
        a = 4*k
        triangles += [([a, a + 2, a + 6], 4), ([a, a + 6, a + 4], 4), ([a, a + 4, a + 5], 5),
                      ([a, a + 5, a + 1], 5)]
    return "\n".join(["MeshVersionFormatted 2", "Dimension 3", f"Vertices {len(x)}",
                      *(f"{a} {b} {c} 0" for a, b, c in x), f"Tetrahedra {len(tets)}",
                      *(" ".join(str(v + 1) for v in tet[:4]) + f" {tet[4]}" for tet in tets),
                      f"Triangles {len(triangles)}",
                      *(" ".join(str(v + 1) for v in t) + f" {label}" for t, label in triangles), "End", ""])


class SpaceKeys(InFolder):
    def setUp(self):
        super().setUp()
        self.write(SCENE)
        for name, middle in (("one.mesh", 0.25), ("two.mesh", 0.5)):
            self.write(blocks(middle), name)
        self.write(BOX, "box.geo")
        self.write("\n".join(str(i) for i in range(27)) + "\n", "hot.txt")
        done = mortier("run", "scene.toml", "--out", "begun", "--set", "output.state=true", "--set",
                       "time.end=0.1", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)

    def result(self, settings):
        """Of the title, the histories and the fields."""
        words = [word for each in settings for word in ("--set", each)]
        done = mortier("run", "scene.toml", "--out", "out", *words, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        digest = hashlib.sha256(json.loads(self.read("out/summary.json")).get("title", "").encode())
        for name in self.names("out"):
            if name.endswith((".csv", ".vtu", "state")):
                digest.update(name.encode() + (self.folder / "out" / name).read_bytes())
        return digest.hexdigest()

    def refusal(self, settings):
        words = [word for each in settings for word in ("--set", each)]
        done = mortier("run", "scene.toml", "--out", "no", *words, cwd=self.folder)
        self.assertIn(done.returncode, (1, 2), done.stderr)
        self.assertEqual(len(told(done.stderr)), 1)
        return done.stderr

    def test_every_key_is_used_or_refused(self):
        listed = [line.split("\t")[0] for line in mortier("keys").stdout.splitlines()]
        for key in listed:
            with self.subTest(key):
                if key in HOW:
                    self.assertIn(key.rpartition(".")[2] + " = ",
                                  self.refusal([f"{setting(key)}={HOW[key]}"]))
                elif isinstance(DIFFERENT[key][0], str):
                    said, settings = DIFFERENT[key]
                    self.assertIn(said, self.refusal(settings))
                else:
                    first, second = DIFFERENT[key]
                    self.assertNotEqual(self.result(first), self.result(second))
        self.assertEqual({*HOW, *DIFFERENT} - {*listed}, set())


if __name__ == "__main__":
    unittest.main()
