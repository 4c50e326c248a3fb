"""Ways to spoil a scene or a mesh: each makes of a file's bytes, with a generator of random numbers,
other bytes."""
import re

NUMBERS = ["nan", "inf", "-inf", "1e400", "-1e400", "1e308", "1e-320", "-0", "-0.0", "0", "-1", "0.5", "1e12",
           "2147483647",
           "2147483648", "-2147483649", "9223372036854775807", "99999999999999999999999", "1e9", "0x7fffffff",
           "1_000",
           "0.30000000000000004", "--3", "3e", "+", ".", "1979-05-27T07:32:00Z", "true", "\"7\"", "[1]", "{}"]
EXPRESSIONS = ["\"" + "(" * 3000 + "t" + ")" * 3000 + "\"", "\"" + "-" * 20000 + "t\"", "\"1/(t-0.5)\"",
               "\"sqrt(-t)\"",
               "\"0/0\"", "\"t,t\"", "\"t=1\"", "\"" + "sin(" * 500 + "t" + ")" * 500 + "\"", "\"x^9999\"",
               "\"\\u0000t\"",
               "\"\\u001b[31mt\"", "\"t ? t : \"", "\"" + "t?t:" * 2000 + "t\"", "\"" + "t+" * 50000 + "t\"",
               "\"\""]
NUMBER = re.compile(rb"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def flip_bytes(text, rng):
    data = bytearray(text)
    for _ in range(rng.choice([1, 1, 2, 8, 64])):
        data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    return bytes(data)


def truncate(text, rng):
    return text[:rng.randrange(len(text))]


def lines(change):
    def mutate(text, rng):
        rows = text.split(b"\n")
        change(rows, rng)
        return b"\n".join(rows)
    return mutate


def delete_line(rows, rng):
    begin = rng.randrange(len(rows))
    del rows[begin:begin + rng.choice([1, 1, 1, 2, 5])]


def repeat_line(rows, rng):
    row = rng.randrange(len(rows))
    rows.insert(rng.randrange(len(rows) + 1), rows[row])


def swap_lines(rows, rng):
    a, b = rng.randrange(len(rows)), rng.randrange(len(rows))
    rows[a], rows[b] = rows[b], rows[a]


def replace_number(text, rng):
    found = list(NUMBER.finditer(text))
    if not found:
        return text
    at = rng.choice(found)
    return text[:at.start()] + rng.choice(NUMBERS).encode() + text[at.end():]


def scale_number(text, rng):
    found = list(NUMBER.finditer(text))
    if not found:
        return text
    at = rng.choice(found)
    value = float(at.group()) * rng.choice([-1, 1e-9, 1e-3, 0.5, 1.1, 2, 1e3, 1e9, 1e150])
    return text[:at.start()] + repr(value).encode() + text[at.end():]


def swap_tokens(text, rng):
    found = list(re.finditer(rb"[^\s=,{}\[\]]+", text))
    if len(found) < 2:
        return text
    a, b = sorted(rng.sample(found, 2), key=lambda token: token.start())
    return text[:a.start()] + b.group() + text[a.end():b.start()] + a.group() + text[b.end():]


def binary(text, rng):
    begin = rng.randrange(len(text))
    return text[:begin] + rng.randbytes(rng.choice([1, 16, 400])) + text[begin + rng.choice([0, 16]):]


def noise(text, rng):
    return rng.randbytes(rng.choice([0, 1, 100, 5000]))


def nest(text, rng):
    depth = rng.choice([50, 1000, 100000])
    return text + rng.choice([b"\na = " + b"[" * depth, b"\na = " + b"{a=" * depth,
                              b"\n[" + b"a." * depth + b"a]\n",
                              b"\na." + b"a." * depth + b"a = 1\n", b"\n" + b"[" * depth + b"\n"])


def replace_expression(text, rng):
    rows = [m for m in re.finditer(rb"(?:[ut][xy]|[xy]) = (\"[^\"\n]*\"|[-0-9.e]+)", text)]
    if not rows:
        return text
    at = rng.choice(rows)
    return text[:at.start(1)] + rng.choice(EXPRESSIONS).encode() + text[at.end(1):]


def endings(text, rng):
    return text.replace(b"\n", rng.choice([b"\r\n", b"\r", b"\x00\n", b" ", b"\n\n"]))


OF_MESHES = [flip_bytes, truncate, lines(delete_line), lines(repeat_line), lines(swap_lines), replace_number,
             replace_number,
           scale_number, scale_number, swap_tokens, swap_tokens, binary, noise, endings]
OF_SCENES = OF_MESHES + [nest, replace_expression, replace_expression]
