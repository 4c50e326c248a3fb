"""Meshes of Abaqus and CalculiX (.inp): nodes, elements, sets and surfaces; all else is passed over. meshio's
reader takes the last *NODE block for all of them and knows neither CPS6, CPE3, CAX3 nor surfaces."""
from __future__ import annotations

import re
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from mesh_files import CORNERS, SIDES, Block, Groups, Wrong

SOLIDS = {4: "tetra", 10: "tetra", 5: "pyramid", 13: "pyramid", 6: "wedge", 15: "wedge", 8: "hexahedron",
          20: "hexahedron", 27: "hexahedron"}
PLANE = {3: "triangle", 6: "triangle", 4: "quad", 8: "quad"}
KINDS = ((r"(?:DC|AC|C)3D(\d+)", SOLIDS), (r"(?:DC|AC|C)(?:PS|PEG|PE|GAX|AX|2D)(\d+)", PLANE),
         (r"(?:STRI|DS|S|M3D|SFM3D|R3D)(\d)", PLANE), (r"(?:T2D|T3D|B2|B3|R2D|RAX|SAX|MAX)(\d)", None))
POINTS = re.compile(r"MASS|ROTARY|SPRING|DASHPOT|CONN|DCOUP|GAP|PIPE|U\d|D$")
GENERATED = {"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM"}


class Reader:
    def __init__(self) -> None:
        self.places: list[list[float]] = []
        self.nodes: dict[tuple[str, int], int] = {}  # part and number: index
        self.elements: dict[tuple[str, int], tuple[str, int]] = {}  # type and index in it
        self.left_out: set[tuple[str, int]] = set()  # elements of points
        self.of_type: dict[str, list[tuple[str, list[int]]]] = {}  # by type: line, nodes
        self.kinds: dict[str, tuple[str, int]] = {}  # of a type: kind, nodes
        self.parts: dict[str, str] = {}  # of elements: as written
        self.instances: dict[str, str] = {}
        self.moved: dict[str, list[float]] = {}
        self.node_sets: dict[str, list[Any]] = {}
        self.element_sets: dict[str, list[Any]] = {}
        self.internal: set[str] = set()
        self.surfaces: dict[str, list[Any]] = {}
        self.written: dict[str, str] = {}  # names in capitals: as written first
        self.scope = ""

    def fail(self, place: str, what: str) -> NoReturn:
        raise Wrong(f"{place}: {what}")

    def named(self, name: str) -> str:
        self.written.setdefault(name.upper(), name)
        return name.upper()

    def file(self, path: Path, depth: int = 0) -> None:
        text = path.read_text(encoding="utf-8", errors="surrogateescape")
        keyword, options, head, pending = "", {}, "", []
        lines = text.split("\n")
        data = False
        at = 0
        while at < len(lines):
            line, place = lines[at].strip(), f"{path}:{at + 1}"
            at += 1
            if not line or line.startswith("**"):
                continue
            if line.startswith("*"):
                while line.endswith(",") and at < len(lines):
                    line += lines[at].strip()
                    at += 1
                if pending:
                    self.fail(place, f"{line[:30]}, expected the other nodes of element {pending[0]}")
                words = [word.strip() for word in line[1:].split(",")]
                keyword = words[0].upper()
                options = {key.strip().upper(): value.strip().strip('"')
                           for key, _, value in (word.partition("=") for word in words[1:])}
                head, data = place, False
                self.begin(keyword, options, place, path, depth)
                continue
            data = keyword in ("NODE", "ELEMENT", "NSET", "ELSET", "SURFACE")
            if data:
                pending = self.row(keyword, options, line, place, pending)
            elif keyword == "INSTANCE":
                self.move(options, line, place, head)
        if pending:
            self.fail(f"{path}:{len(lines)}",
                      f"end of file, expected the other nodes of element {pending[0]}")
        if data and lines[-1].strip():
            self.fail(f"{path}:{len(lines)}", "end of file within a line, expected a line break after it")

    def begin(self, keyword: str, options: dict[str, str], place: str, path: Path, depth: int) -> None:
        if keyword in GENERATED or (keyword == "NODE" and options.get("SYSTEM", "R").upper() != "R"):
            self.fail(place, f"*{keyword}, expected all nodes and elements one by one, at x, y, z")
        if keyword == "INCLUDE":
            other = path.parent / options.get("INPUT", "")
            if depth > 16 or not other.is_file():
                self.fail(place, f"*INCLUDE of {other}, expected a file")
            self.file(other, depth + 1)
        if keyword == "PART":
            self.scope = self.named(options.get("NAME", ""))
        if keyword == "INSTANCE":
            self.scope = self.named(options.get("PART", options.get("NAME", "")))
            if self.scope in self.instances.values():
                self.fail(place, f"a second instance of part {options.get('PART')}, expected one of each")
            self.instances[options.get("NAME", "").upper()] = self.scope
        if keyword in ("END PART", "END INSTANCE"):
            self.scope = ""
        if keyword == "ELEMENT":
            self.type(options.get("TYPE", "").upper(), place)
        if keyword in ("ELSET", "NSET") and "INTERNAL" in options:
            self.internal.add(options.get(keyword, "").upper())

    def type(self, name: str, place: str) -> None:
        if name in self.kinds:
            return
        for pattern, kinds in KINDS:
            if match := re.match(pattern, name):
                nodes = int(match[1])
                if kinds is None:
                    count = 3 if name.startswith(("B22", "B32")) or (name[0] in "TRSM" and nodes == 3) else 2
                    self.kinds[name] = ("line", count)
                elif nodes in kinds:
                    self.kinds[name] = (kinds[nodes], nodes)
        if POINTS.match(name):
            self.kinds[name] = ("", 0)
        if name not in self.kinds:
            self.fail(place, f"elements of type {name or 'none'}, expected C3D4, C3D10, C3D8, C3D6, C3D20, "
                             "CPS3, CPE6, CAX4 or others with these corners")

    def row(self, keyword: str, options: dict[str, str], line: str, place: str,
            pending: list[int]) -> list[int]:
        """What there is of an element so far is `pending`, and after this line the result."""
        words = [word.strip() for word in line.rstrip(",").split(",")]
        instance = options.get("INSTANCE", "").upper()
        scope = self.instances.get(instance, instance) or self.scope
        if keyword == "NODE":
            number, x = self.whole(words[0], place), numbers(words[1:4])
            if not 2 <= len(x) or not np.isfinite(x).all():
                self.fail(place, f"node {number} at {', '.join(words[1:4])[:60]}, expected two or three "
                                 "finite coordinates")
            if (scope, number) in self.nodes:
                self.fail(place, f"node {number}, expected it once")
            self.nodes[scope, number] = len(self.places)
            self.places.append(x + [0.0] * (3 - len(x)))
            if "NSET" in options:
                self.node_sets.setdefault(self.named(options["NSET"]), []).append((scope, number, place))
        elif keyword == "ELEMENT":
            name = options["TYPE"].upper()
            kind, nodes = self.kinds[name]
            if not kind:
                if words[0].isdecimal():
                    self.left_out.add((scope, int(words[0])))
                return []
            pending = pending + [self.whole(word, place) for word in words if word]
            if len(pending) <= nodes:
                return pending
            if len(pending) > nodes + 1:
                self.fail(place, f"element {pending[0]} with {len(pending) - 1} nodes, expected {nodes}")
            if (scope, pending[0]) in self.elements:
                self.fail(place, f"element {pending[0]}, expected it once")
            rows = self.of_type.setdefault(name, [])
            self.elements[scope, pending[0]] = (name, len(rows))
            rows.append((place, [self.index(scope, node, pending[0], place)
                                 for node in pending[1:CORNERS[kind] + 1]]))
            self.parts[scope] = self.written.get(scope, scope)
            if "ELSET" in options:
                self.element_sets.setdefault(self.named(options["ELSET"]), []).append(
                    (scope, pending[0], place))
        elif keyword in ("NSET", "ELSET"):
            sets = self.node_sets if keyword == "NSET" else self.element_sets
            members = sets.setdefault(self.named(options.get(keyword, "")), [])
            if "GENERATE" in options:
                first, last, step = (*(self.whole(word, place) for word in words), 1)[:3]
                if step < 1 or (last - first) // step > 100_000_000:
                    self.fail(place, f"numbers {first} to {last} by {step}, expected them to rise")
                known = self.nodes if keyword == "NSET" else self.elements
                members += [(scope, k, place) for k in range(first, last + 1, step) if (scope, k) in known]
            else:
                members += [(scope, int(word) if re.fullmatch(r"[+-]?\d{1,15}", word) else word, place)
                            for word in words if word]
        elif keyword == "SURFACE":
            self.surfaces.setdefault(self.named(options.get("NAME", "")), []).append(
                (scope, options.get("TYPE", "ELEMENT").upper(), words, place))
        return []

    def move(self, options: dict[str, str], line: str, place: str, head: str) -> None:
        x = numbers(line.rstrip(",").split(","))
        if self.scope in self.moved or len(x) != 3:
            self.fail(place, f"instance {options.get('NAME')} of line {head.rpartition(':')[2]} is turned, "
                             "expected three numbers by which it is moved")
        self.moved[self.scope] = x

    def whole(self, word: str, place: str) -> int:
        if not re.fullmatch(r"[+-]?\d{1,15}", word):
            self.fail(place, f"{word[:40]!r}, expected a whole number")
        return int(word)

    def index(self, scope: str, node: int, element: int, place: str) -> int:
        if (scope, node) not in self.nodes:
            self.fail(place, f"element {element} has node {node}, which is not there before it")
        return self.nodes[scope, node]

    def members(self, sets: dict[str, list[Any]], known: dict[tuple[str, int], Any], name: str,
                inside: tuple[str, ...] = ()) -> list[Any]:
        """Of a set, and of those that it names."""
        found = []
        for scope, each, place in sets[name]:
            if isinstance(each, int):
                if sets is self.element_sets and (scope, each) in self.left_out:
                    continue
                if (scope, each) not in known:
                    self.fail(place, f"set {self.written[name]} has {each}, which is not there")
                found.append(known[scope, each])
            elif each.upper() in sets and each.upper() not in inside:
                found += self.members(sets, known, each.upper(), (*inside, name))
            elif each.upper() not in inside:
                self.fail(place, f"set {self.written[name]} has the set {each}, which is not there")
        return found

    def groups(self) -> Groups:
        for scope, x in self.moved.items():
            for (part, _), node in self.nodes.items():
                if part == scope:
                    self.places[node] = [a + b for a, b in zip(self.places[node], x)]
        regions = {name: self.members(self.element_sets, self.elements, name)
                   for name in self.element_sets if name not in self.internal}
        if len(self.parts) > 1:
            for part, name in self.parts.items():
                regions.setdefault(self.named(name), []).extend(
                    element for (scope, _), element in self.elements.items() if scope == part)
        blocks = []
        for type_name, rows in self.of_type.items():
            kind, nodes = self.kinds[type_name]
            groups = {}
            for name, members in regions.items():
                chosen = sorted({i for each, i in members if each == type_name})
                if chosen:
                    groups[self.written[name]] = np.array(chosen)
            blocks.append(Block(kind, np.array([cell for _, cell in rows]), nodes > CORNERS[kind], groups))
        sides: dict[str, list[tuple[int, ...]]] = {}
        nodes_of = {self.written[name]: self.members(self.node_sets, self.nodes, name)
                    for name in self.node_sets if name not in self.internal}
        for name, rows in self.surfaces.items():
            for scope, of, words, place in rows:
                if of == "NODE":
                    nodes_of.setdefault(self.written[name], []).extend(
                        self.named_by(words[0], self.node_sets, self.nodes, "a node", scope, place))
                elif of == "ELEMENT":
                    sides.setdefault(self.written[name], []).extend(self.sides_named(scope, words, place))
        return Groups(np.array(self.places).reshape(-1, 3), blocks, sides, nodes_of)

    def named_by(self, word: str, sets: dict[str, list[Any]], known: dict[tuple[str, int], Any], what: str,
                 scope: str, place: str) -> list[Any]:
        """What a set has, or a number stands for."""
        if word.upper() in sets:
            return self.members(sets, known, word.upper())
        if not word.isdecimal() or (scope, int(word)) not in known:
            self.fail(place, f"{word[:40]!r}, expected {what} or a set of {what.split()[1]}s")
        return [known[scope, int(word)]]

    def sides_named(self, scope: str, words: list[str], place: str) -> list[tuple[int, ...]]:
        found = []
        for name, i in self.named_by(words[0], self.element_sets, self.elements, "an element", scope, place):
            kind, cell = self.kinds[name][0], self.of_type[name][i][1]
            side = words[1].upper() if len(words) > 1 else ""
            if side in ("SPOS", "SNEG") and kind in ("triangle", "quad", "line"):
                found.append(tuple(cell))
            elif re.fullmatch(r"[SE]\d", side) and 1 <= int(side[1]) <= len(SIDES.get(kind, ())):
                found.append(tuple(cell[k] for k in SIDES[kind][int(side[1]) - 1]))
            else:
                self.fail(place,
                          f"side {side or 'none'} of a {kind}, expected S1 to S{len(SIDES.get(kind, ()))}")
        return found


def numbers(words: list[str]) -> list[float]:
    """None where one of the words is no number; D stands for E in those of Fortran."""
    try:
        return [float(word.upper().replace("D", "E")) for word in words]
    except ValueError:
        return []


def read(path: Path) -> Groups:
    reader = Reader()
    reader.file(path)
    if not reader.places:
        raise Wrong("no *NODE, expected an input file of Abaqus or CalculiX")
    return reader.groups()
