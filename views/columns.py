"""Columns of history.csv as pictures and reports draw them: which ones, and in which words."""
import re

import numpy as np

ROUNDING = 1e-9  # of the largest value of its kind: what is less is rounding
WORDS = {
    "contact_force": "contact force", "max_pressure": "largest contact pressure",
    "von_mises_max": "largest von Mises stress", "displacement_max": "largest displacement",
    "elastic_energy": "elastic energy", "penetration": "overlap of the bodies",
    "viscoplastic_fraction": "share of triangles that yield", "time_step": "length of the step"}
OF_THE_SOLVER = {"step", "time", "time_step", "estimate", "rejections", "guarded", "rung", "iterations",
                 "factorisations", "active", "joined", "left", "contact_resultant_x", "contact_resultant_y",
                 "contact_resultant_z", "force_balance", "material_residual", "gap_on_active", "sign",
                 "complementarity", "open_penetration", "rounding", "ambiguous"}


def bare(column):
    """Without its unit."""
    return column.split("[")[0]


def unit_of(column):
    found = re.search(r"\[(.*)\]$", column)
    return found[1] if found else ""


def words_of(column):
    name = bare(column)
    if found := re.fullmatch(r"friction_work_(\d+)", name):
        return f"friction work, contact {int(found[1]) + 1}"
    return WORDS.get(name, name.replace("_", " "))


def labelled(words, unit):
    return f"{words} [{unit}]" if unit else words


def titled(column):
    return labelled(words_of(column), unit_of(column))


def drawn(histories, size, also=()):
    """The columns worth a picture, in the order of WORDS, then those that the scene adds: none that is
    constantly 0 or rounding beside the others of its unit. histories: of runs, side by side; size: of the
    bodies; also: names of columns of the solver to draw as well."""
    names = list(dict.fromkeys(name for each in histories for name in each if len(each[name])))
    names = [name for name in names if bare(name) not in OF_THE_SOLVER or bare(name) in also]
    largest = {name: max(np.abs(each[name]).max() for each in histories if name in each and len(each[name]))
               for name in names}
    of_unit = {}
    for name in names:
        of_unit[unit_of(name)] = max(of_unit.get(unit_of(name), 0), largest[name])
    moved = max((largest[name] for name in names if bare(name) == "displacement_max"), default=0)

    def kind(name):  # an area or a volume has no other column of its unit
        return max(moved, np.finfo(float).tiny) * size**(2 if unit_of(name).endswith("^3") else 1) \
            if bare(name) == "penetration" else of_unit[unit_of(name)]

    order = {name: i for i, name in enumerate(WORDS)}
    kept = [name for name in names if largest[name] > (0 if bare(name) in also else ROUNDING * kind(name))]
    return sorted(kept, key=lambda name: (bare(name) in also, order.get(bare(name), len(order))))


def force_and_displacement(columns):
    """Of force over displacement: both columns, or None."""
    names = {bare(name): name for name in columns}
    if "contact_force" in names and "displacement_max" in names:
        return names["displacement_max"], names["contact_force"]
    return None
