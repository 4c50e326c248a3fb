"""The scene of a study as Python sees it: what the norms of the errors and the other codes need of it.

Messages about a wrong scene are the program's own (`mortier run` reads it first); here it is taken as sound.
"""
import re
import tomllib
from pathlib import Path

import numpy as np

from problems import RunFailure


def load(path, settings=()):
    """The document with KEY=VALUE settings applied (docs/scene.md); meshes as absolute paths."""
    path = Path(path)
    document = tomllib.loads(path.read_text())
    for body in document.get("body", []):
        body["mesh"] = str((path.parent / body["mesh"]).resolve())
    for setting in settings:
        key, _, text = setting.partition("=")
        change(document, key.split("."), value_of(text))
    for body in document.get("body", []):
        body["mesh"] = str(Path(body["mesh"]).resolve())
    contacts = document.get("contact", [])
    document["contact"] = [contacts] if isinstance(contacts, dict) else contacts
    for contact in document["contact"]:
        if contact.get("swap"):
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
    chosen = [each for i, each in enumerate(inside) if rest[0] in (str(each.get("name", each.get("label", i))),)]
    for each in chosen or inside:
        change(each, rest[1:] if chosen else rest, value)


def materials(document):
    """name -> (E, nu) of the bodies."""
    return {body["name"]: (float(body["material"]["young"]), float(body["material"]["poisson"]))
            for body in document["body"]}


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

    def edges_of(self, label):
        return self.edges[self.labels == label]

    def nodes_of(self, label):
        return np.unique(self.edges_of(label))

    def line(self, label):
        """Nodes of a straight boundary part, in the order of x, then y."""
        nodes = self.nodes_of(label)
        return nodes[np.lexsort((self.points[nodes, 1], self.points[nodes, 0]))]

    def areas(self):
        a, b, c = (self.points[self.triangles[:, i]] for i in range(3))
        return ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
