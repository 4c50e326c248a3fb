"""Numbers that README.md and docs/ state, and what commands give for them.

A statement is a piece of a text with {} in place of its numbers, {_} in place of those that do not count, as
times, and ... in place of other words of a line; spaces and line breaks are the same. The text has it once. A
value agrees with a number that is written if it is that number when it is rounded to the digits written.
"""
import re

NUMBER = r"-?\d+(?:,\d{3})*(?:\.\d+)?(?:e[-+]?\d+)?"


def occurrences(statement, text):
    """The numbers of a statement as they are written, wherever it is in the text."""
    def pattern(words):
        escaped = r"\s+".join(re.escape(word) for word in words.split())
        return escaped.replace(r"\{_\}", f"(?:{NUMBER})").replace(r"\{\}", f"({NUMBER})")
    parts = r"[^\n]*?".join(pattern(words) for words in statement.split("..."))
    return [found.groups() for found in re.finditer(rf"(?<![\d.]){parts}(?!\.?\d)", text)]


def written(statement, text):
    """Those of a statement that is in the text once."""
    found = occurrences(statement, text)
    assert len(found) == 1, f"{len(found)} times in the text: {statement}"
    return found[0]


def read(statement, text):
    """The numbers of a statement, of all its occurrences."""
    return [float(number.replace(",", "")) for found in occurrences(statement, text) for number in found]


def agrees(number, value):
    mantissa, _, exponent = number.replace(",", "").partition("e")
    unit = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
    return abs(value - float(number.replace(",", ""))) <= 0.5 * unit * (1 + 1e-6)


def altered(number):
    """The number with each of its digits replaced in turn, by the one above and the one below."""
    for at, digit in enumerate(number):
        if digit.isdigit():
            for other in {(int(digit) + 1) % 10, (int(digit) - 1) % 10}:
                yield f"{number[:at]}{other}{number[at + 1:]}"


def check(test, text, statement, *values):
    """A text states these values, and no digit of them could be another one. Returns how many there are."""
    with test.subTest(statement):
        numbers = written(statement, text)
        test.assertEqual(len(numbers), len(values), numbers)
        for number, value in zip(numbers, values):
            test.assertTrue(agrees(number, value), f"{number} is stated, {value:.9g} is found")
            for other in altered(number):
                test.assertFalse(agrees(other, value), f"{other} would not be told from {number}")
    return len(values)
