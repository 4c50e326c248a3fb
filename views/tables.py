"""Tables of a report: what summary.json holds, in words and with units. Of a summary that was changed, what
is not of the expected form is left out."""
from numbers import Real

from columns import WORDS
from ending import shown

PLANES = {"space": "bodies in space", "stress": "plane stress", "strain": "plane strain",
          "axisymmetric": "body of revolution"}
SCHEMES = {"backward-euler": "backward Euler", "crank-nicolson": "Crank-Nicolson",
           "sdirk2": "SDIRK2, two stages a step"}
VERIFIED = {"force_balance": "forces that are not balanced", "material_residual": "residual of the laws",
            "gap_on_active": "gap where there is contact", "open_penetration": "overlap where there is none",
            "sign": "contact forces that pull", "complementarity": "force times gap",
            "friction": "friction law", "rounding": "rounding that can be expected"}


def number(value, digits=6, unit=""):
    """Text, or None of what is no number."""
    if isinstance(value, bool) or not isinstance(value, Real):
        return None
    return f"{value:.{digits}g} {shown(unit, 60)}".rstrip()


def percent(value):
    return None if number(value) is None else f"{100 * value:.3g} %"


def at_time(each, unit, time_unit):
    """Of {value, time}."""
    if not isinstance(each, dict) or number(each.get("value")) is None:
        return None
    time = number(each.get("time"), 5, time_unit)
    return number(each["value"], 6, unit) + (f" at t = {time}" if time else "")


def place(point, unit):
    found = [number(x, 4) for x in point] if isinstance(point, list) else [None]
    return None if None in found else f"({', '.join(found)}) {shown(unit, 60)}".rstrip()


def part(of, key):
    """A table in a table."""
    found = of.get(key) if isinstance(of, dict) else None
    return found if isinstance(found, dict) else {}


def listed(of, key):
    """The tables of an array."""
    found = of.get(key) if isinstance(of, dict) else None
    return [each for each in found if isinstance(each, dict)] if isinstance(found, list) else []


def pairs(result):
    """Title -> rows of a name and a value, which several runs show side by side."""
    summary, length, stress, time = result.summary, result.length_unit, result.stress_unit, result.time_unit
    force, energy, area = (result.unit(name) for name in ("contact_force", "elastic_energy", "penetration"))
    final, peaks, accuracy = (part(summary, key) for key in ("final", "peaks", "accuracy"))

    def low_high(low, high, unit):
        found = [number(low), number(high, 6, unit)]
        return None if None in found else " to ".join(found)

    def displacement(axis):
        ends = [final.get(key) for key in ("displacement_min", "displacement_max")]
        if not all(isinstance(end, list) and len(end) == len(result.axes) for end in ends):
            return None
        return low_high(*(end[axis] for end in ends), length)

    run = [("problem", PLANES.get(str(summary.get("plane")))),
           ("contact", summary.get("contact")),
           ("time scheme", SCHEMES.get(str(summary.get("scheme")))),
           ("steps", number(summary.get("steps"))),
           (result.elements, number(summary.get(result.elements), 9)),
           ("unknowns", number(summary.get("dofs"), 9)),
           ("Newton iterations", number(summary.get("newton_iterations"), 9)),
           ("steps repeated for their error", number(summary.get("rejected_attempts")))]
    end = [("time", number(final.get("time"), 6, time)),
           ("von Mises stress", low_high(final.get("von_mises_min"), final.get("von_mises_max"), stress)),
           *((f"displacement {axis}", displacement(i)) for i, axis in enumerate(result.axes)),
           ("contact force", number(final.get("contact_force"), 6, force)),
           ("nodes in contact", number(final.get("active_nodes"))),
           ("overlap of the bodies", number(final.get("interpenetration"), 3, area)),
           ("work of friction", number(final.get("friction_work"), 6, energy))]
    largest = [(WORDS[column].removeprefix("largest "), at_time(peaks.get(key), unit, time))
               for key, column, unit in (
                   ("von_mises", "von_mises_max", stress), ("pressure", "max_pressure", stress),
                   ("contact_force", "contact_force", force), ("displacement", "displacement_max", length),
                   ("elastic_energy", "elastic_energy", energy))]
    verified = [(words, number(part(summary, "verification").get(key), 2))
                for key, words in VERIFIED.items()]
    titles = {"Run": run, "At the end": end, "Largest values of the run": largest,
              "Verification (worst step, relative)": verified,
              "Estimated accuracy": estimated(accuracy, length, time)}
    return {title: [[name, shown(value, 500)] for name, value in rows if value is not None]
            for title, rows in titles.items()}


def estimated(accuracy, length, time):
    of_run, worst = part(accuracy, "largest_of_run"), part(accuracy, "largest")
    rows = [("asked for", percent(accuracy.get("asked"))),
            ("error of the stress, energy norm, at the end", percent(accuracy.get("energy_error")))]
    rows += [(f"the same, {shown(name, 60)}", percent(value))
             for name, value in part(accuracy, "bodies").items()]
    if (error := percent(of_run.get("energy_error"))) is not None:
        rows.append(("largest error of the run", f"{error} at t = {number(of_run.get('time'), 5, time)}"))
    rows.append(("error in time", percent(accuracy.get("time"))))
    if where := place(worst.get("at"), length):
        rows.append(("largest error", f"{shown(worst.get('body', ''), 60)} at {where}"))
    bound = part(accuracy, "bound")
    rows.append(("guaranteed error of the stress", percent(bound.get("energy_error"))
                 or bound.get("reason")))
    doubts = accuracy.get("not_reliable")
    if isinstance(doubts, list):
        rows.append(("not reliable", "; ".join(map(str, doubts)) or "nothing known"))
    return rows


def grids(result):
    """Title -> rows, the first of which are heads."""
    summary, length = result.summary, result.length_unit
    lines = "Contact surfaces" if result.space else "Contact lines"
    made = {"Bodies": [["body", "material", result.elements, "nodes", "unknowns"]],
            lines: [["nonmortar side", "mortar side", "nodes", "discretisation",
                               "largest sliding"]],
            "Rounds of refinement": [["round", result.elements, "unknowns", "steps", "error of meshes",
                                      "error in time", "time taken"]]}
    for each in listed(summary, "bodies"):
        made["Bodies"].append([each.get("name"), each.get("material"),
                               number(each.get(result.elements), 9), number(each.get("nodes"), 9),
                               number(each.get("dofs"), 9)])
    for each in listed(summary, "interfaces"):
        nodes = [number(each.get(f"{side}_nodes"), 9) for side in ("nonmortar", "mortar")]
        made[lines].append([each.get("nonmortar"), each.get("mortar"),
                                      " and ".join(map(str, nodes)), each.get("variant"),
                                      number(part(each, "sliding").get("slip"), 3, length)])
    for i, each in enumerate(listed(summary, "rounds")):
        made["Rounds of refinement"].append(
            [str(i + 1), number(each.get(result.elements), 9), number(each.get("unknowns"), 9),
             number(each.get("steps")), percent(each.get("mesh")), percent(each.get("time")),
             number(each.get("seconds"), 3, "s")])
    return {title: [[shown("" if cell is None else cell, 300) for cell in row] for row in rows]
            for title, rows in made.items() if len(rows) > 1}


def quantities(result):
    """Of the scene: name, value, unit, where, smallest, largest and what is known of the error."""
    rows, time, length = [], result.time_unit, result.length_unit
    for name, each in part(result.summary, "quantities").items():
        if not isinstance(each, dict) or number(each.get("value")) is None:
            continue
        rows.append([shown(name, 200), number(each["value"]), shown(each.get("unit", ""), 60),
                     place(each.get("at"), length) or "",
                     *(at_time(each.get(key), "", time) or "" for key in ("smallest", "largest")),
                     error_of(each)])
    return rows


def error_of(each):
    bound = part(each, "bound")
    for key, words in (("error", "guaranteed"), ("estimate", "estimated")):
        if number(bound.get(key)) is not None:
            return f"\u00b1 {number(bound[key], 3)}, {words}"
    if number(each.get("unbounded_order")) is not None:
        return f"no limit: stresses are unbounded there, about like r^-{each['unbounded_order']:.1f}"
    if each.get("grows_with_rounds"):
        return "no limit: it grows with every refinement"
    if number(each.get("change_in_last_round")) is not None:
        return f"changed by {number(each['change_in_last_round'], 3)} in the last round of refinement"
    if number(each.get("estimated_error")) is not None:
        return f"\u00b1 {number(each['estimated_error'], 3)}, estimated"
    return shown(f"no estimate: {each['no_estimate']}" if "no_estimate" in each else "not known", 300)
