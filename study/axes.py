"""The axes of a sweep: what a study can vary, and the values that it takes."""
from study_file import is_count, is_number, is_shown, is_text, unknown

# axis of a sweep: key of the scene that it sets, and what it takes
AXES = {
    "steps": ("time.steps", "integers >= 1"), "tolerance": ("time.tolerance", "numbers > 0"),
    "scheme": ("time.scheme", "strings"), "variant": ("contact.variant", "strings"),
    "projection": ("body.material.projection", "strings"), "linear": ("solver.linear", "strings"),
    "swap": ("contact.swap", "booleans"), "degree": ("degree", "1 or 2"),
    "accuracy": ("accuracy.energy", "numbers > 0"),
    "level": (None, "integers >= 0"), "code": (None, "strings"), "threads": (None, "integers >= 1"),
}
CODES = ("mortier", "freefem")


def check_axis(table, axis, values, levels):
    expected = AXES.get(axis, (axis, "values"))[1]
    tests = {"integers >= 1": is_count(1), "integers >= 0": is_count(0),
             "numbers > 0": lambda v: is_number(v) and v > 0, "1 or 2": lambda v: is_count(1)(v) and v <= 2,
             "strings": is_text, "booleans": lambda v: isinstance(v, bool),
             "values": lambda v: is_number(v) or isinstance(v, bool) or is_shown(v)}
    for value in values:
        if not tests[expected](value):
            raise table.fault(axis, value, expected)
        if axis == "level" and value >= levels:
            raise table.fault(axis, value,
                              f"a level below {levels} (the levels of [mesh])"
                              if levels else "a table [mesh]")
        if axis == "code" and value not in CODES:
            raise table.fault(axis, value, "one of " + ", ".join(CODES))


def flattened(values, prefix=""):
    """TOML reads `time.end = 1` as a table in a table."""
    for key, value in values.items():
        if isinstance(value, dict):
            yield from flattened(value, f"{prefix}{key}.")
        else:
            yield prefix + key, value


def read_axes(table, levels, single):
    """axis -> value (single) or list of values."""
    axes = {}
    for axis, value in flattened(table.values):
        if axis not in AXES and "." not in axis:
            raise table.wrong(unknown("axis", axis, AXES) + ", or a dotted key of the scene", axis)
        if not is_shown(axis):
            raise table.fault(axis, value, "a key of the scene")
        values = value if isinstance(value, list) else [value]
        if not values or (single and isinstance(value, list)):
            raise table.fault(axis, value, "one value" if single else "one value or more")
        check_axis(table, axis, values, levels)
        axes[axis] = value if single else list(dict.fromkeys(values))
    return axes
