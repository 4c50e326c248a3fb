"""Expressions in x, y, t as scenes have them (docs/scene.md), evaluated on arrays."""
import ast
import functools
import operator
import re

import numpy as np

FUNCTIONS = {name: getattr(np, name) for name in ("sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "log10",
                                                  "sqrt", "abs", "sign", "rint")}
FUNCTIONS |= {"asin": np.arcsin, "acos": np.arccos, "atan": np.arctan, "atan2": np.arctan2,
              "asinh": np.arcsinh, "acosh": np.arccosh, "atanh": np.arctanh, "log": np.log, "ln": np.log,
              "min": lambda *a: np.minimum.reduce(np.broadcast_arrays(*a)),
              "max": lambda *a: np.maximum.reduce(np.broadcast_arrays(*a)), "where": np.where}
OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
             ast.Pow: operator.pow, ast.USub: operator.neg, ast.UAdd: operator.pos, ast.Lt: operator.lt,
             ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge, ast.Eq: operator.eq,
             ast.NotEq: operator.ne, ast.And: np.logical_and, ast.Or: np.logical_or}


class Expression:
    """A number or a text; `names` are what it may use beside x, y, t and pi.
    ValueError where it is neither."""

    def __init__(self, value, names=()):
        if isinstance(value, bool) or not isinstance(value, (int, float, str)):
            raise ValueError("expected a number or an expression in x, y, t")
        self.text, self.names = str(value), tuple(names)
        if not self.text.isprintable():
            raise ValueError("expected visible characters")
        text = self.text.replace("^", "**").replace("&&", " and ").replace("||", " or ")
        try:
            self.tree = ast.parse(translated(text), mode="eval").body
        except (SyntaxError, RecursionError, MemoryError) as error:
            raise ValueError("expected an expression in x, y, t") from error
        try:  # an evaluation meets every part of it, and functions know how many values they take
            self(np.zeros(1), np.zeros(1), 0.0, **{name: np.zeros(1) for name in names})
        except (TypeError, ArithmeticError, RecursionError, AttributeError) as error:
            raise ValueError(f"cannot be evaluated: {error}") from error

    def __reduce__(self):
        return Expression, (self.text, self.names)

    def __call__(self, x, y, t, **values):
        names = {"x": x, "y": y, "t": t, "pi": np.pi, **values}
        with np.errstate(all="ignore"):
            return np.broadcast_to(np.asarray(evaluate(self.tree, names), float), np.shape(x))


def translated(text):
    """With every `a ? b : c` as where(a, b, c)."""
    words = re.split(r"([(),?:])", text)[::-1]
    found = conditional(words)
    if words:
        raise SyntaxError(f"unmatched {words[-1]}")
    return found.strip()


def conditional(words):
    """Takes an expression from the end of the words, up to a comma, a parenthesis or a colon behind it."""
    found = ""
    while words and words[-1] not in ("?", ":", ",", ")"):
        word = words.pop()
        found += word + (arguments(words) if word == "(" else "")
    if not words or words[-1] != "?":
        return found
    words.pop()
    yes = conditional(words)
    expect(words, ":")
    return f"where({found}, {yes}, {conditional(words)})"


def arguments(words):
    found = conditional(words)
    while words and words[-1] == ",":
        words.pop()
        found += ", " + conditional(words)
    expect(words, ")")
    return found + ")"


def expect(words, word):
    if not words or words.pop() != word:
        raise SyntaxError(f"expected {word}")


def evaluate(node, names):
    """ValueError: something that is no part of an expression."""
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return node.value
    if isinstance(node, ast.Name) and node.id in names:
        return names[node.id]
    if isinstance(node, ast.Call) and getattr(node.func, "id", "") in FUNCTIONS and not node.keywords:
        return FUNCTIONS[node.func.id](*(evaluate(each, names) for each in node.args))
    if isinstance(node, ast.BinOp):
        return operation(node.op)(np.asarray(evaluate(node.left, names), float), evaluate(node.right, names))
    if isinstance(node, ast.UnaryOp):
        return operation(node.op)(evaluate(node.operand, names))
    if isinstance(node, ast.BoolOp):
        return functools.reduce(operation(node.op), (evaluate(each, names) for each in node.values))
    if isinstance(node, ast.Compare):
        values = [evaluate(each, names) for each in (node.left, *node.comparators)]
        pairs = zip(node.ops, values, values[1:])
        return functools.reduce(np.logical_and, (operation(op)(left, right) for op, left, right in pairs))
    what = {ast.Name: "unknown name", ast.Call: "unknown function"}.get(type(node), "unexpected")
    raise ValueError(f"{what} {ast.unparse(node)}")


def operation(op):
    if type(op) not in OPERATORS:
        raise ValueError(f"unexpected operator {type(op).__name__.lower()}")
    return OPERATORS[type(op)]
