"""Expressions in x, y, t as scenes have them (docs/scene.md), evaluated on arrays."""
import ast
import operator

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
            self.tree = ast.parse(conditional(text).strip(), mode="eval").body
        except (SyntaxError, RecursionError, MemoryError) as error:
            raise ValueError("expected an expression in x, y, t") from error
        allowed = {"x", "y", "t", "pi", *names}
        for node in ast.walk(self.tree):
            if isinstance(node, ast.Call):
                node.func.is_function = True
                if not isinstance(node.func, ast.Name) or node.func.id not in FUNCTIONS or node.keywords:
                    raise ValueError("unknown function")
            elif isinstance(node, ast.Name):
                if not hasattr(node, "is_function") and node.id not in allowed:
                    raise ValueError(f"unknown name {node.id}")
            elif isinstance(node, ast.Constant):
                if isinstance(node.value, bool) or not isinstance(node.value, (int, float)):
                    raise ValueError(f"unexpected {node.value!r}")
            elif not isinstance(node, (ast.BinOp, ast.UnaryOp, ast.Compare, ast.BoolOp, ast.expr_context,
                                       ast.operator, ast.unaryop, ast.cmpop, ast.boolop)):
                raise ValueError(f"unexpected {type(node).__name__.lower()}")
        try:  # functions know how many values they take
            self(np.zeros(1), np.zeros(1), 0.0, **{name: np.zeros(1) for name in names})
        except (TypeError, ArithmeticError, RecursionError, AttributeError) as error:
            raise ValueError(f"cannot be evaluated: {error}") from error

    def __reduce__(self):
        return Expression, (self.text, self.names)

    def __call__(self, x, y, t, **values):
        names = {"x": x, "y": y, "t": t, "pi": np.pi, **values}
        with np.errstate(all="ignore"):
            return np.broadcast_to(np.asarray(evaluate(self.tree, names), float), np.shape(x))


def conditional(text):
    """`a ? b : c` as where(a, b, c), innermost parentheses first."""
    parts, depth, begin = [], 0, 0
    out = ""
    for i, c in enumerate(text):
        if c == "(":
            if depth == 0:
                out += text[begin:i + 1]
                begin = i + 1
            depth += 1
        elif c == ")":
            depth -= 1
            if depth < 0:
                raise SyntaxError("unmatched )")
            if depth == 0:
                inner = ", ".join(conditional(part) for part in at_top(text[begin:i], ","))
                out += f"\0{len(parts)}\0)"
                parts.append(inner)
                begin = i + 1
    if depth:
        raise SyntaxError("unmatched (")
    out += text[begin:]
    if "?" in out:
        test, rest = out.split("?", 1)
        level = 0
        for i, c in enumerate(rest):
            level += (c == "?") - (c == ":")
            if level < 0:
                out = f"where({test}, {conditional(rest[:i])}, {conditional(rest[i + 1:])})"
                break
        else:
            raise SyntaxError("? without :")
    for i, part in enumerate(parts):
        out = out.replace(f"\0{i}\0", part)
    return out


def at_top(text, separator):
    depth, begin, parts = 0, 0, []
    for i, c in enumerate(text):
        depth += (c == "(") - (c == ")")
        if c == separator and depth == 0:
            parts.append(text[begin:i])
            begin = i + 1
    return [*parts, text[begin:]]


def evaluate(node, names):
    if isinstance(node, ast.Constant):
        return node.value
    if isinstance(node, ast.Name):
        return names[node.id]
    if isinstance(node, ast.Call):
        return FUNCTIONS[node.func.id](*(evaluate(each, names) for each in node.args))
    if isinstance(node, ast.BinOp):
        return OPERATORS[type(node.op)](np.asarray(evaluate(node.left, names), float),
                                        evaluate(node.right, names))
    if isinstance(node, ast.UnaryOp):
        return OPERATORS[type(node.op)](evaluate(node.operand, names))
    if isinstance(node, ast.BoolOp):
        values = [evaluate(each, names) for each in node.values]
        return OPERATORS[type(node.op)](values[0], evaluate(ast.BoolOp(node.op, node.values[1:]), names)
                                        if len(values) > 2 else values[1])
    left = evaluate(node.left, names)
    result = True
    for op, right in zip(node.ops, node.comparators):
        right = evaluate(right, names)
        result = np.logical_and(result, OPERATORS[type(op)](left, right))
        left = right
    return result
