"""Parts of scenes as text, of which tests and harnesses make their scenes. Values are Python's; a mesh, a
material and conditions may be text as well."""
import json

LARGE_CHANGES = '[check]\nallow = ["large-strain", "large-displacement", "large-rotation", "sliver"]\n'


def pairs(keys):
    """Of keys and values as TOML, without those that are None."""
    return [f"{key} = {written(value)}" for key, value in keys.items() if value is not None]


def written(value):
    """A value as TOML; a dictionary in one line."""
    if isinstance(value, dict):
        return "{ " + ", ".join(pairs(value)) + " }"
    if hasattr(value, "tolist"):  # of numpy
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(written, value)) + "]"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, (str, bool)) else repr(value)


def lines(keys):
    return "".join(f"{pair}\n" for pair in pairs(keys))


def shape(kind, **keys):
    return written({"shape": kind, **keys})


def box(lower, upper, cells, **keys):
    """A rectangle or a cuboid."""
    return shape("rectangle" if len(lower) == 2 else "cuboid", lower=lower, upper=upper, cells=cells, **keys)


def body(name, mesh, material, *boundary, more="", **keys):
    """material: its keys as text, or Young's modulus beside a Poisson's ratio of 0.3. boundary: conditions
    without braces. more: further lines."""
    if not isinstance(material, str):
        material = elastic(material, 0.3)
    conditions = ", ".join("{ " + each + " }" for each in boundary)
    return (f'[[body]]\nname = "{name}"\nmesh = {mesh}\nmaterial = {{ {material} }}\n{lines(keys)}'
            + (f"boundary = [ {conditions} ]\n" if boundary else "") + more)


def elastic(young, poisson):
    return f"young = {young!r}, poisson = {poisson!r}"


def tool(name, more="", **keys):
    return f'[[tool]]\nname = "{name}"\n{lines(keys)}{more}'


def side(of, label=None):
    return written({"body": of, "label": label})


def contact(first, second, sides=False, more="", **keys):
    """Between two of (body, label) or (body,); sides: in any order, else the first is nonmortar."""
    first, second = side(*first), side(*second)
    between = f"sides = [ {first}, {second} ]" if sides else f"nonmortar = {first}\nmortar = {second}"
    return f"[[contact]]\n{between}\n{lines(keys)}{more}"


def tied(first, second, **keys):
    return contact(first, second, sides=True, kind="tied", **keys)


def quantity(name, kind, of, label=None, component=None, about=None, **keys):
    """keys: of the place, beside its label."""
    return f'[[quantity]]\nname = "{name}"\n' + lines(
        {kind: {"body": of, "label": label, **keys}, "component": component, "about": about})


def stresses(*bodies):
    return "".join(quantity(f"energy_{each}", "stored_energy", each)
                   + quantity(f"mises_{each}", "largest_mises", each) for each in bodies)


def timed(steps=1, end=1, more="", **keys):
    return "[time]\n" + lines({"end": end, "steps": steps, **keys}) + more
