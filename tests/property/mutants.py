"""Mooring files and records as accidents and adversaries leave them."""

import re
from random import Random

NUMBERS = ["0", "-1", "1e308", "-1e29", "1e-308", ".nan", ".inf", "99999999", "0.001", "1,5", "½"]
UNITS = ["m", "km", "N", "kN", "kgf", "kg", "deg", "m/s", "knot", "N/m", "kg/m^3", "%", "parsec"]
VALUES = [
    "[]", "{}", "~", "yes", "no", "2026-03-01", "*a", "&a 1", "!!python/object:os.system", "|",
    "[/x]", "[bold]", "\\x00", "ü" * 200, "'", '"', "- ", "? ", "<<: *b", "0x1F", "12:30", "",
]  # fmt: skip
SIGNS = "\t\n\r\x00\x1b[]{}:,&*#?|-<>=!%@`\"'\\ \u2028\u202e\ufeff😀"


def mutant(text: str, random: Random) -> str:
    """The text with one to four accidents."""
    for _ in range(random.randint(1, 4)):
        text = random.choice(_ACCIDENTS)(text, random)
    return text


def _lines(text: str, random: Random) -> str:
    lines = text.splitlines(keepends=True) or [""]
    at, other = random.randrange(len(lines)), random.randrange(len(lines))
    match random.randrange(4):
        case 0:
            del lines[at]
        case 1:
            lines.insert(at, lines[other])
        case 2:
            lines[at], lines[other] = lines[other], lines[at]
        case _:
            lines[at] = " " * random.randint(1, 4) + lines[at]
    return "".join(lines)


def _number(text: str, random: Random) -> str:
    return _replaced(r"-?\d+(\.\d+)?", random.choice(NUMBERS), text, random)


def _unit(text: str, random: Random) -> str:
    return _replaced(r"(?<=\d )[a-zA-Z/^\d]+", random.choice(UNITS), text, random)


def _value(text: str, random: Random) -> str:
    return _replaced(r"(?<=: )[^,}\n]+", random.choice(VALUES), text, random)


def _word(text: str, random: Random) -> str:
    words = re.findall(r"[a-z][a-z_-]{2,}", text) or ["x"]
    return _replaced(r"[a-z][a-z_-]{2,}", random.choice(words), text, random)


def _sign(text: str, random: Random) -> str:
    at = random.randrange(len(text) + 1)
    return text[:at] + random.choice(SIGNS) * random.choice((1, 1, 1, 50)) + text[at:]


def _cut(text: str, random: Random) -> str:
    start = random.randrange(len(text) + 1)
    return text[:start] + text[start + random.choice((1, 1, 5, 200, 100_000)) :]


def _replaced(pattern: str, new: str, text: str, random: Random) -> str:
    found = list(re.finditer(pattern, text))
    if not found:
        return text
    place = random.choice(found)
    return text[: place.start()] + new + text[place.end() :]


_ACCIDENTS = (_lines, _number, _number, _unit, _value, _word, _sign, _cut)
