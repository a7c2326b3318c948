"""Schematic of a line for a terminal, with a row of text for each part and without colour."""

import textwrap
from collections.abc import Iterator
from dataclasses import dataclass, replace

from rich.cells import cell_len, set_cell_size
from rich.console import Console, ConsoleOptions, RenderResult
from rich.text import Text

from calm.case.design import AnyResult
from calm.drawing.picture import encodable
from calm.drawing.schematic.pen import ELLIPSIS
from calm.drawing.schematic.shown_parts import HEADINGS, Schematic, TextRow, schematic_of
from calm.drawing.schematic.symbols import BALLS, LINES, Sign, Symbol
from calm.files import MooringFile
from calm.quantities import QUANTITIES

_SYMBOLS = {
    Symbol.SPHERE: "(   )", Symbol.BALL: "(o)", Symbol.GLASS: "(o)", Symbol.FOAM: "[===]",
    Symbol.STREAMLINED: "<===<", Symbol.BUOY: r"\___/", Symbol.CURRENT_METER: " [|]>",
    Symbol.ADCP: "[:]", Symbol.CTD: "[#]", Symbol.TRAP: r"\_/", Symbol.INSTRUMENT: "[ ]",
    Symbol.RELEASE: "[R]", Symbol.RELEASE_PAIR: "[R|R]", Symbol.SHACKLE: "U", Symbol.SWIVEL: "8",
    Symbol.LINK: "O", Symbol.CHAIN: "§", Symbol.WIRE: "│", Symbol.ROPE: "┊",
    Symbol.WHEELS: "[#####]", Symbol.BLOCK: "/###\\", Symbol.BODY: "[x]",
}  # fmt: skip
_PACK = "(ooo)"
_LOOKS = {(False, False): ":", (True, False): "^", (False, True): "v", (True, True): "X"}
_SHIP, _HELICOPTER = r"\__|__/", "---+---"
_CLAMP, _SEA, _SEABED = "├─", "~", "▒"
# replacements for characters of the picture that not all terminals have
_ASCII = str.maketrans("│┊├─▒§×–·°…", "|:|-#%x-, .")
_SIGNS = "".join(map(chr, _ASCII))

_LINE_AT = 3
_PICTURE = 10
_ART = _PICTURE + 1
_INDENT = "  "
_LEAST_LABEL, _LEAST_NAME = 12, 14


def schematic_text(
    file: MooringFile,
    result: AnyResult | None = None,
    width: int = 80,
    *,
    ascii_only: bool = False,
) -> str:
    """Draw the schematic of a line as text, with the columns of `schematic_svg`.

    `width` is at least about 55 cells. Labels and names are cut to fit. If `ascii_only` is true,
    all symbols are ASCII characters, but letters in labels are not replaced.
    """
    schematic = schematic_of(file, result)
    lines = [
        _cut(schematic.title, width),
        _cut(schematic.subtitle, width),
        "",
        *_table_lines(schematic, width),
        "",
        *textwrap.wrap(schematic.note, width),
    ]
    text = "\n".join(line.rstrip() for line in lines)
    return text.translate(_ASCII) if ascii_only else text


def can_carry(encoding: str | None) -> bool:
    """Return whether an output encoding can represent all characters of the schematic."""
    return encodable(encoding, _SIGNS)


@dataclass(frozen=True)
class TerminalSchematic:
    """Schematic for a rich console, as wide as the console."""

    file: MooringFile
    result: AnyResult | None
    ascii_only: bool

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        text = schematic_text(self.file, self.result, options.max_width, ascii_only=self.ascii_only)
        yield Text(text, no_wrap=True, overflow="ignore")


def _table_lines(schematic: Schematic, width: int) -> Iterator[str]:
    drawn = list(_lines_of_drawing(schematic))
    rows = [row for _, row in drawn if row is not None]
    figures = []
    for number, quantity in enumerate(schematic.columns):
        words = (*HEADINGS[quantity], *(row.cells[number] for row in rows))
        figures.append(max(map(cell_len, words)))
    room = width - _ART - sum(figures) - 2 * len(figures) - 1
    # labels first, since they identify the parts
    label, name = (max(cell_len(getattr(row, of)) for row in rows) for of in ("label", "name"))
    label = min(label, max(room - min(name, _LEAST_NAME), _LEAST_LABEL))
    name = max(min(name, room - label), 0)

    def line(art: str, row: TextRow) -> str:
        texts = f"{_padded(row.label, label)} {_padded(row.name, name)}"
        cells = zip(row.cells, figures, strict=True)
        return f"{art:{_ART}}{texts}" + "".join(f"  {cell:>{wide}}" for cell, wide in cells)

    heads = [(*HEADINGS[name], QUANTITIES[name].display_unit) for name in schematic.columns]
    for words in zip(*heads, strict=True):
        yield line("", TextRow("", "", words))
    for art, drawn_row in drawn:
        yield art if drawn_row is None else line(art, drawn_row)


def _lines_of_drawing(schematic: Schematic) -> Iterator[tuple[str, TextRow | None]]:
    if schematic.towed_by is not None:
        yield (_SHIP if schematic.sea else _HELICOPTER), schematic.towed_by
        if schematic.sea is not None:
            yield _at_sea(_SYMBOLS[Symbol.WIRE]), schematic.sea
    elif not schematic.surface and schematic.sea is not None:
        yield _at_sea(_SEA), schematic.sea
        yield "", None
    for number, part in enumerate(schematic.parts):
        if part.clamped:
            row = replace(part.rows[0], label=_INDENT + part.rows[0].label)
            yield " " * _LINE_AT + _CLAMP + _symbol_art(part.sign).strip(), row
            continue
        afloat = schematic.surface and number == 0
        art = _symbol_art(part.sign)
        art = _at_sea(art) if afloat else art.center(2 * _LINE_AT + 1)
        yield art, part.rows[0]
        for row in part.rows[1:]:
            yield "", row
        following = schematic.parts[number + 1 : number + 2]
        if part.sign.symbol in LINES and not any(each.clamped for each in following):
            yield art, None
    if schematic.seabed is not None:
        if schematic.towed_by is not None:
            yield "", None
        yield _SEABED * _PICTURE, schematic.seabed


def _symbol_art(sign: Sign) -> str:
    art = _PACK if sign.symbol in BALLS and sign.count > 1 else _SYMBOLS[sign.symbol]
    if not sign.sounding:
        return art
    middle = len(art) // 2
    return f"{art[:middle]}{_LOOKS[sign.up, sign.down]}{art[middle + 1 :]}"


def _at_sea(art: str) -> str:
    return art.center(2 * _LINE_AT + 1, _SEA).ljust(_PICTURE, _SEA)


def _padded(text: str, width: int) -> str:
    return set_cell_size(_cut(text, width), width)


def _cut(text: str, width: int) -> str:
    if cell_len(text) <= width:
        return text
    return set_cell_size(text, width - 1).rstrip() + ELLIPSIS
