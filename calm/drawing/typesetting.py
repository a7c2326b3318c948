"""Typesetting of PDF and PNG files with typst, in the fonts of this package.

System fonts are not used, so that the same input gives the same bytes on every computer.
"""

from collections.abc import Iterable, Mapping
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Literal

import numpy as np

FONTS = Path(str(files("calm.drawing") / "fonts"))
"""Folder of the fonts DejaVu Sans and Source Sans 3, unmodified, with their licences.

Typst itself contains DejaVu Sans Mono. Characters that Source Sans 3 does not have are set in
DejaVu Sans.
"""

DOTS_PER_INCH = 200.0


def typeset(
    template: bytes,
    inputs: Mapping[str, str],
    kind: Literal["pdf", "png"],
    timestamp: int | None = None,
) -> bytes:
    """Typeset a typst template; a PNG contains only the first page.

    The template reads `inputs` from `sys.inputs`, as plain text without markup. `timestamp` is the
    PDF date in seconds since 1970, or None for no date.
    """
    import typst

    fonts = typst.Fonts(include_system_fonts=False, font_paths=[FONTS])
    return typst.compile(
        template,
        font_paths=fonts,
        sys_inputs=dict(inputs),
        format=kind,
        ppi=DOTS_PER_INCH,
        pdf_tags=False,  # tags make the file ten times as large; an accessible HTML page exists
        timestamp=timestamp,
    )


def lacking(texts: Iterable[str]) -> str:
    """Return the characters that are not in the fonts, each once, in order of occurrence."""
    held, known = list(texts), signs()
    unknown = {sign for sign in set().union(*held) if sign.isprintable() and ord(sign) not in known}
    if not unknown:  # almost always, since a report has millions of characters
        return ""
    return "".join(dict.fromkeys(sign for text in held for sign in text if sign in unknown))


def legible(text: str) -> str:
    """Replace each character that is not in the fonts with �.

    Otherwise, a single missing character would make typst show the whole label of a drawing as
    boxes.
    """
    unknown = lacking([text])
    return text.translate(dict.fromkeys(map(ord, unknown), "\ufffd")) if unknown else text


@cache
def signs() -> frozenset[int]:
    """Return the code points of the characters in the regular font.

    The code points are read from the `cmap` table of the font, which has format 12. Source:
    OpenType 1.9, chapters `otff` and `cmap`.
    """
    font = (FONTS / "DejaVuSans.ttf").read_bytes()
    tables = int.from_bytes(font[4:6], "big")
    heads = np.frombuffer(
        font, [("tag", "S4"), ("", ">u4"), ("at", ">u4"), ("", ">u4")], tables, 12
    )
    start = int(heads["at"][heads["tag"] == b"cmap"][0])
    count = int.from_bytes(font[start + 2 : start + 4], "big")
    maps = np.frombuffer(font, [("", ">u2", 2), ("at", ">u4")], count, start + 4)
    places = (start + int(at) for at in maps["at"])
    whole = next(at for at in places if font[at : at + 2] == b"\0\x0c")
    groups = int.from_bytes(font[whole + 12 : whole + 16], "big")
    ranges = np.frombuffer(font, ">u4", 3 * groups, whole + 16).reshape(-1, 3)
    return frozenset(code for first, last, _ in ranges.tolist() for code in range(first, last + 1))
