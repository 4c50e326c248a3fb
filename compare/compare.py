#!/usr/bin/python3
"""Compares a run of mortier with a run of FreeFEM on the same meshes, or any two runs.

    compare/compare.py OUT_MORTIER OUT_FREEFEM [--json FILE] [--quiet]

Displacement by vertex, stress by triangle, contact forces and gaps by node, scalars: largest difference over
the largest value, of the whole run where one of the two tells it. Exit code 1 when one is beyond its
tolerance, 2 when a run cannot be read.
"""
import json
import sys
from dataclasses import asdict, dataclass, replace

import numpy as np

import results

# Relative, in the maximum norm. Both codes stop at |H^-1 r| = 1e-10 sigma_Y or at their rounding floor.
DISPLACEMENT = 1e-9
STRESS = 1e-8
FORCE = 1e-8
# Meshes are the same files, so positions differ by nothing but the last digit printed.
POSITION = 1e-15


@dataclass
class Difference:
    quantity: str
    difference: float  # relative
    tolerance: float
    first: float = None  # of scalars
    second: float = None

    @property
    def within(self):
        return self.difference <= self.tolerance  # false for NaN


class Verdict:
    """Everything that was compared."""

    def __init__(self, differences, faults):
        self.differences = differences
        self.faults = faults  # what cannot be compared, in words

    @property
    def agrees(self):
        return not self.faults and all(d.within for d in self.differences)

    def norm(self, quantity):
        """Largest relative difference of what begins with this word."""
        values = [d.difference for d in self.differences if d.quantity.startswith(quantity)]
        return max(values, default=np.nan)

    def __str__(self):
        if self.agrees:
            return "agree"
        beyond = [d for d in self.differences if not d.within]
        return "DIFFER: " + "; ".join(self.faults + [f"{d.quantity} {d.difference:.1e}" for d in beyond[:3]])

    def table(self):
        lines = [f"{'quantity':<20} {'first':>19} {'second':>19} {'difference':>10} {'tolerance':>9}"]
        for d in self.differences:
            numbers = [f"{x:.12g}" if x is not None else "" for x in (d.first, d.second)]
            lines.append(f"{d.quantity:<20} {numbers[0]:>19} {numbers[1]:>19} {d.difference:>10.1e} "
                         f"{d.tolerance:>9.0e}" + ("" if d.within else "  <-- beyond"))
        return "\n".join(lines + self.faults)

    def json(self):
        return {"agree": self.agrees, "faults": self.faults,
                "differences": [asdict(d) | {"within": d.within} for d in self.differences]}


def compare(first, second, within=None):
    """The verdict on two runs on the same meshes; within takes the place of all tolerances."""
    faults = []
    for key in ("contact", "nonmortar", "projection"):
        a, b = first.summary.get(key), second.summary.get(key)
        if set(str(a).split(", ")) != set(str(b).split(", ")):
            faults.append(f"{key}: {a} and {b}")
    cut = [run.summary.get("rungs", {}).get("cut", 0) for run in (first, second)]
    if cut[0] != cut[1]:
        faults.append(f"steps that were cut into shorter ones: {cut[0]} and {cut[1]}")
    if set(first.bodies) != set(second.bodies):
        return Verdict([], faults + [f"bodies: {sorted(first.bodies)} and {sorted(second.bodies)}"])
    for name in first.bodies:
        a, b = first.bodies[name], second.bodies[name]
        if a.displacement.shape != b.displacement.shape or a.stress.shape != b.stress.shape:
            faults.append(f"body {name}: {len(a.displacement)} and {len(b.displacement)} vertices, "
                          f"{len(a.stress)} and {len(b.stress)} elements")
    if not np.array_equal(first.contact.vertex, second.contact.vertex):
        faults.append("contact nodes: other vertices")
    if (first.contact.friction is None) != (second.contact.friction is None):
        faults.append("friction in one of them alone")
    if faults:
        return Verdict([], faults)

    names = sorted(first.bodies)
    # A run may end without loads: what is left is rounding of what there was.
    bodies, forces = second.bodies.values(), second.contact.force
    length = max(peak("displacement", first, second), *(np.abs(body.displacement).max() for body in bodies))
    stress = max(peak("von_mises", first, second), *(np.abs(body.stress).max() for body in bodies))
    force = max(peak("contact_force", first, second) / max(1, len(forces)), np.abs(forces).max(initial=0))
    extent = np.ptp(second.contact.position) if second.contact.position.size > 0 else length
    differences = []
    for what, scale, tolerance in (("displacement", length, DISPLACEMENT), ("stress", stress, STRESS)):
        for name in names:
            a, b = getattr(first.bodies[name], what), getattr(second.bodies[name], what)
            differences.append(Difference(f"{what} {name}", relative(a, b, scale), tolerance))
    # conditions depend on each other: nodal forces are one choice of many, and each code has its own
    chosen = first.code != second.code and any(run.summary.get("dependent_conditions", 0) > 0
                                               for run in (first, second))
    if not chosen:
        differences.append(Difference("contact force", relative(first.contact.force, second.contact.force,
                                                                force), FORCE))
    differences += [
        Difference("contact gap", relative(first.contact.gap, second.contact.gap, length), DISPLACEMENT),
        Difference("contact position", relative(first.contact.position, second.contact.position, extent),
                   POSITION),
    ]
    if first.contact.friction is not None and not chosen:
        differences.append(Difference("friction", relative(first.contact.friction, second.contact.friction,
                                                           force), FORCE))
    differences += quantity_differences(first, second, within)
    pressed = max(np.abs(run.contact.force).max(initial=0) for run in (first, second)) > FORCE*force
    # nodes that carry no force: rounding says which of them are closed
    left_out = {"active_nodes"} if force > 0 and not pressed else set()
    if chosen:
        left_out |= {"contact_force", "active_nodes"}
    in_space = second.contact.position.shape[1] == 3
    if in_space:  # one point a cell of the refinement, the cut of which is free
        left_out |= {"interpenetration"}
    scalars = {key: value for key, value in first.scalars.items() if key not in left_out}
    differences += scalar_differences(scalars, second.scalars, length, stress, force,
                                      extent**2 if in_space else extent)
    if within is not None:
        differences = allowing(differences, within)
    return Verdict(differences, [])


def scalar_differences(first, second, length, stress, force, extent=1.0, within=None):
    """Against the size of their kind: a penetration of 1e-18 m^2 has no digits of its own."""
    scales = {"von_mises_min": (stress, STRESS), "von_mises_max": (stress, STRESS),
              "contact_force": (force, FORCE), "interpenetration": (length * extent, DISPLACEMENT),
              "steps": (1, 0), "active_nodes": (1, 0), "time": (1, 1e-14)}
    found = []
    for key, a in first.items():
        scale, tolerance = scales.get(key, (length, DISPLACEMENT))
        found.append(Difference(key, relative(a, second[key], scale), tolerance, a, second[key]))
    return found if within is None else allowing(found, within)


def allowing(differences, within):
    """With this tolerance; without counts, which are for the same steps on the same meshes."""
    return [replace(each, tolerance=within) for each in differences if each.tolerance > 0]


def peak(name, *runs):
    """The largest value over both runs, as far as they tell it."""
    return max(run.summary.get("peaks", {}).get(name, {}).get("value", 0.0) for run in runs)


def quantity_differences(first, second, within=None):
    """Of the quantities that the scene asks for, against the largest one of the same unit."""
    pairs = [run.summary.get("quantities", {}) for run in (first, second)]
    known = [name for name in pairs[0] if name in pairs[1]]
    units = first.summary.get("units", {"force": "N", "length": "m"})
    in_space = first.summary.get("plane") == "space"
    of_reaction = units["force"] if in_space else f"{units['force']}/{units['length']}"
    found = []
    for name in known:
        a, b = (each[name]["value"] for each in pairs)
        size = max(abs(value) for each in pairs for other in known
                   if each[other]["unit"] == pairs[0][name]["unit"]
                   for value in (each[other]["value"], *(each[other][end]["value"] for end in
                                                         ("smallest", "largest") if end in each[other])))
        if pairs[0][name]["unit"] == of_reaction:  # a reaction may be zero to the rounding of what presses
            size = max(size, *(abs(run.scalars["contact_force"]) for run in (first, second)))
        found.append(Difference(name, relative(a, b, size), FORCE if within is None else within, a, b))
    return found


def relative(a, b, scale):
    difference = float(np.abs(np.asarray(a) - np.asarray(b)).max(initial=0))
    return difference / float(scale) if difference > 0 else difference


def main():
    parser = results.argument_parser(__doc__)
    parser.add_argument("first", help="run folder of mortier")
    parser.add_argument("second", help="run folder of FreeFEM (or of mortier)")
    parser.add_argument("--json", metavar="FILE", help="writes the differences as JSON")
    parser.add_argument("--quiet", action="store_true", help="the verdict only")
    arguments = parser.parse_args()
    try:
        verdict = compare(results.read(arguments.first), results.read(arguments.second))
    except results.ResultError as error:
        print(f"compare: {error}", file=sys.stderr)
        return 2
    if not arguments.quiet:
        print(verdict.table())
    print(f"verdict: the runs {verdict}")
    if arguments.json:
        with open(arguments.json, "w") as file:
            json.dump(verdict.json(), file, indent=2)
            file.write("\n")
    return 0 if verdict.agrees else 1


if __name__ == "__main__":
    sys.exit(main())
