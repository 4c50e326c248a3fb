"""The scene of a study as Python sees it: what the norms of the errors need of it.

Messages about a wrong scene are the program's own (`mortier run` reads it first); here it is taken as sound.
"""
import re
import tomllib
from pathlib import Path

import numpy as np

from problems import RunFailure


def load(path, settings=(), script=None):
    """The document with KEY=VALUE settings applied (docs/scene.md); meshes as absolute paths. Those that are
    shapes or geometries are the files that mortier wrote beside a script for FreeFEM, where one is given."""
    path = Path(path)
    document = tomllib.loads(path.read_text())
    for body in document.get("body", []):
        if isinstance(body.get("mesh"), str):
            body["mesh"] = str((path.parent / body["mesh"]).resolve())
    for setting in settings:
        key, _, text = setting.partition("=")
        change(document, key.split("."), value_of(text))
    for body in document.get("body", []):
        written = script and script.with_name(f"{script.stem}-{body['name']}.mesh")
        if written and written.is_file():
            body["mesh"] = str(written)
        elif isinstance(body.get("mesh"), str):
            body["mesh"] = str(Path(body["mesh"]).resolve())
    contacts = document.get("contact", [])
    document["contact"] = [contacts] if isinstance(contacts, dict) else contacts
    for contact in document["contact"]:
        if contact.get("swap") and "sides" not in contact:
            contact["nonmortar"], contact["mortar"] = contact["mortar"], contact["nonmortar"]
    return document


def value_of(text):
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text


def change(table, path, value):
    """Where the path meets an array of tables its next component names an element, or is left out for all."""
    key, rest = path[0], path[1:]
    if not rest:
        table[key] = value
        return
    inside = table.setdefault(key, {})
    if isinstance(inside, dict):
        change(inside, rest, value)
        return
    chosen = [each for i, each in enumerate(inside)
              if rest[0] in (str(each.get("name", each.get("label", i))),)]
    for each in chosen or inside:
        change(each, rest[1:] if chosen else rest, value)


def materials(run, document):
    """name -> (E, nu) of the bodies, in the units of the scene: as a run of mortier tells them, or as the
    scene says. Absent where a body has no such two numbers."""
    told = {body["name"]: body["laws"][0] for body in run.summary.get("bodies", ())
            if isinstance(body, dict) and body.get("laws")}
    said = {body["name"]: body.get("material", {}) for body in document["body"]}
    pairs = {name: [each.get(key) for key in ("young", "poisson")] for name, each in {**said, **told}.items()}
    return {name: pair for name, pair in pairs.items() if all(isinstance(x, (int, float)) for x in pair)}


class Mesh:
    """A Medit mesh: points n x 2, triangles m x 3 from 0, edges k x 2 from 0 with their labels."""

    def __init__(self, path):
        try:
            words = re.sub(r"#.*", "", Path(path).read_text()).split()
        except (OSError, UnicodeDecodeError) as error:
            raise RunFailure(f"{path}: cannot be read") from error
        blocks = {}
        i = 0
        while i < len(words):
            width = {"Vertices": 3, "Triangles": 4, "Edges": 3}.get(words[i])
            if width is None:
                i += 1
                continue
            count = int(words[i + 1])
            begin = i + 2
            i = begin + count * width
            blocks[words[begin - 2]] = np.array(words[begin:i], float).reshape(count, width)
        self.points = blocks["Vertices"][:, :2]
        self.triangles = blocks["Triangles"][:, :3].astype(int) - 1
        self.edges = blocks["Edges"][:, :2].astype(int) - 1
        self.labels = blocks["Edges"][:, 2].astype(int)

    def with_middles(self):
        """Points of quadratic triangles, with straight sides: the vertices, then the middles as triangles
        name their sides 0-1, 1-2, 2-0 first; and triangles x 6."""
        sides = np.sort(np.stack([self.triangles, np.roll(self.triangles, -1, 1)], -1).reshape(-1, 2), 1)
        _, first, number = np.unique(sides, axis=0, return_index=True, return_inverse=True)
        order = np.argsort(first)
        place = np.empty(len(first), int)
        place[order] = np.arange(len(first))
        middles = self.points[sides[np.sort(first)]].mean(1)
        elements = np.column_stack([self.triangles, len(self.points) + place[number.reshape(-1, 3)]])
        return np.concatenate([self.points, middles]), elements
