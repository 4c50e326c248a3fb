"""Scenes and settings as the program reads them: TOML."""
from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from mortier.errors import InputError


def value(of: Any, key: str) -> str:
    """A value in one line. InputError: TOML has no such value."""
    if isinstance(of, (np.ndarray, np.generic)):
        of = of.tolist()
    if isinstance(of, bool):
        return "true" if of else "false"
    if isinstance(of, (int, float)):
        return repr(of)
    if isinstance(of, str):
        return json.dumps(of, ensure_ascii=False).replace("\x7f", "\\u007F")
    if isinstance(of, Mapping):
        return "{ " + ", ".join(f"{name(each)} = {value(of[each], f'{key}.{each}')}" for each in of) + " }"
    if isinstance(of, Sequence) and not isinstance(of, bytes):
        return "[" + ", ".join(value(each, key) for each in of) + "]"
    raise InputError(f"{key}: a value of type {type(of).__name__}, expected a number, text, a truth value, "
                     "a list or a dict")


def name(key: object) -> str:
    if not isinstance(key, str):
        raise InputError(f"a key {key!r} of type {type(key).__name__}, expected text")
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else json.dumps(key, ensure_ascii=False)


def document(scene: Mapping[str, Any]) -> str:
    """A scene, its tables as in docs/scene.md."""
    lines = [f"{name(key)} = {value(of, key)}" for key, of in scene.items() if not is_table(of)]
    for key, of in scene.items():
        if isinstance(of, Mapping):
            lines += ["", f"[{name(key)}]", *entries(of, key)]
        elif is_table(of):
            for each in of:
                lines += ["", f"[[{name(key)}]]", *entries(each, key)]
    return "\n".join(lines) + "\n"


def is_table(of: Any) -> bool:
    return isinstance(of, Mapping) or (isinstance(of, (list, tuple)) and len(of) > 0
                                       and all(isinstance(each, Mapping) for each in of))


def entries(table: Mapping[str, Any], key: str) -> list[str]:
    return [f"{name(each)} = {value(of, f'{key}.{each}')}" for each, of in table.items()]


def settings(changes: Mapping[str, Any] | Sequence[str] | None) -> list[str]:
    """As after --set: key=value."""
    if changes is None:
        return []
    if isinstance(changes, str):
        return [changes]
    if not isinstance(changes, Mapping):
        return list(changes)
    return [f"{key}={of if isinstance(of, str) and is_word(of) else value(of, key)}"
            for key, of in changes.items()]


def is_word(text: str) -> bool:
    """Whether it is text without quotes too."""
    return bool(re.fullmatch(r"[A-Za-z][\w./-]*", text)) and text not in ("true", "false", "inf", "nan")
