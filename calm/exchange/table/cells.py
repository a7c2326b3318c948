"""Numbers in the cells of a list, as people write them."""

from __future__ import annotations

import re

_NUMBER = re.compile(r"[-+−]?\s*(?:\d{1,3}(?:[ \u00a0]\d{3})+|\d+)?(?:[.,]\d+)?(?:[eE][-+]?\d+)?")
_NOTHING = {
    "", "-", "–", "—", "/", "*", "**", "n/a", "na", "nan", "none", "?", "nil", "x", "sans", "null",
}  # fmt: skip


def number(cell: str) -> tuple[float | None, str]:
    """The number of a cell, None where there is none; and how it was interpreted.

    A comma is a decimal sign, or parts thousands where a point follows; a word or unit after the
    number, or `~` before it, is left out and reported.
    """
    text = cell.strip().lstrip("'")
    if text.lower() in _NOTHING:
        return None, ""
    if re.fullmatch(r"[-+]?\d{1,3}(,\d{3})+\.\d+", text):
        return float(text.replace(",", "")), ""
    bare = text.lstrip("~≈≃<> ").removeprefix("ca.").removeprefix("env.").strip()
    found = _NUMBER.match(bare)
    if found is None or not any(sign.isdigit() for sign in found[0]):
        return None, f"`{cell}` is not a number"
    plain = found[0].replace("−", "-").replace(",", ".")
    value = float("".join(plain.split()).replace("\u00a0", ""))
    rest = bare[found.end() :].strip()
    reading = f"`{cell}` read as {value:g}" if rest or bare != text else ""
    return value, reading
