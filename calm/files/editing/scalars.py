"""A text as YAML writes it: plain where that reads back, in quotes where it would not."""

from __future__ import annotations

import re

# Read otherwise by YAML, or by other programs that read it.
_WORD = re.compile(r"(?:~|=|<<|null|true|false|yes|no|on|off)?", re.IGNORECASE)

# What may stand without quotes: no sign of YAML at its beginning, no `: ` nor ` #` within.
_BEGINNING = r"(?:[^\s\-?:,\[\]{}#&*!|>'\"%@`]|-(?=[^\s,\[\]{}]))"
_PLAIN = re.compile(_BEGINNING + r"(?:[^\S\r\n\t](?=[^\s#])|:(?=\S)|[^\s:])*")
_NOT_IN_FLOW = re.compile(r"[,\[\]{}?]|:(?=[,\[\]{}]|$)")
_ESCAPED = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r", "\t": "\\t"}


def written(text: str, *, flow: bool, quote: str = "") -> str:
    """A text as a scalar of YAML.

    Parameters
    ----------
    text : str
    flow : bool
        It is to stand within brackets, where commas and brackets end a plain text.
    quote : str
        The sign it was quoted with so far, which is kept.
    """
    if quote == "'" and text.isprintable():
        return "'" + text.replace("'", "''") + "'"
    if quote != '"' and _stands_plain(text, flow):
        return text
    escaped = "".join(_ESCAPED.get(sign) or _escaped(sign) for sign in text)
    return f'"{escaped}"'


def _stands_plain(text: str, flow: bool) -> bool:
    if _WORD.fullmatch(text) or text.startswith(("---", "...")) or not text.isprintable():
        return False
    return bool(_PLAIN.fullmatch(text)) and not (flow and _NOT_IN_FLOW.search(text))


def _escaped(sign: str) -> str:
    return sign if sign.isprintable() else f"\\U{ord(sign):08x}"
