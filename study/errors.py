"""The errors that a study measures: quantities, and the exact solution that they are measured against."""
from dataclasses import dataclass

from expressions import Expression
from study_file import is_number, is_text

FIELDS = {"energy": ("s11", "s22", "s12"), "displacement": ("ux", "uy"), "pressure": ("p",)}
BEYOND = {"energy": ("s33",)}  # may be given as well
SCALARS = ("von_mises_min", "von_mises_max", "interpenetration", "contact_force", "active_nodes",
           "displacement_min_x", "displacement_min_y", "displacement_min_z",
           "displacement_max_x", "displacement_max_y", "displacement_max_z")


@dataclass
class ErrorMeasure:
    name: str
    quantity: str
    exact: object = None  # a number; or {body or "": {component: Expression}}; None: the reference run


def read_let(table):
    """Named expressions for the exact solution, in their order."""
    let = []
    for name, value in list(table.values.items()) if table else []:
        if not name.isidentifier() or name in ("x", "y", "t", "pi"):
            raise table.fault(name, value, "a name of letters, digits and _ that is not x, y, t or pi")
        let.append((name, expression(table, name, value, [known for known, _ in let])))
    return let


def expression(table, key, value, names):
    try:
        return Expression(value, names)
    except ValueError as error:
        expected = f"a number or an expression in {', '.join(['x, y, t', *names])} ({error})"
        raise table.fault(key, value, expected) from error


def read_errors(top, bodies, names, in_space):
    errors = []
    for table in top.tables("error", required=True):
        quantities = SCALARS if in_space else (*FIELDS, *SCALARS)
        quantity = table.take("quantity", "one of " + ", ".join(quantities) + " in space" * in_space,
                              lambda v: v in quantities)
        name = table.take("name", "a text", is_text, quantity)
        table.words = f"error {name}"
        if name in [each.name for each in errors]:
            raise table.fault("name", name, "a name of its own")
        exact = None
        if quantity in FIELDS:
            if (value := table.table("exact")) is not None:
                exact = read_exact(value, quantity, bodies, names)
        else:
            exact = table.take("exact", "a number", lambda v: is_number(v) and v != 0, None)
        table.finish()
        errors.append(ErrorMeasure(name, quantity, exact))
    return errors


def read_exact(table, quantity, bodies, names):
    """{"": components} for all bodies alike, or {body: components}."""
    components = FIELDS[quantity]
    each_body = quantity != "pressure" and set(table.values) <= set(bodies) and table.values
    tables = {"": table}
    if each_body:
        if missing := [body for body in bodies if body not in table.values]:
            raise table.wrong(f"{missing[0]} is missing, expected every body")
        tables = {body: table.table(body) for body in bodies}
    exact = {}
    for body, inner in tables.items():
        given = [*components, *(c for c in BEYOND.get(quantity, ()) if c in inner.values)]
        exact[body] = {c: expression(inner, c, inner.take(c, "an expression", lambda v: True), names)
                       for c in given}
        inner.finish()
    return exact
