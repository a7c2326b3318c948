"""Read the rows of a list in SI, each with how it was interpreted, and make components of them."""

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from calm.exchange import model
from calm.exchange.list_cells import SheetRows, number, unit_called
from calm.exchange.list_headings import WORDS, ListColumn, ListHeadings, cell_of, decimals_of
from calm.exchange.mdd_elements import MODULI
from calm.physics.seawater import REFERENCE_DENSITY
from calm.units import KILOGRAM_FORCE

TOTAL = re.compile(
    r"^(sub-?)?(totals?|totaux|gesamt\w*|summ?[ae]?|somme|ensemble|i alt|tilsammans)\b", re.I
)
_DITTO = re.compile(r"^(ditt?o|do|idem|id|dto|[\"'\u2033\u201d\u201e\u3003]+)\.?$", re.I)
_COUNTED = re.compile(r"^\(?([2-9]|[1-9]\d)\s?[x\u00d7]\s?(?=\S)", re.I)  # 10x glass, 6 x 17 in
_ANCHOR_KINDS = re.compile(r"\banchors?\b|\bancre|\blest\b", re.I)
_ENOUGH = {"length", "buoyancy", "weight"}  # one of them makes a piece
_MOST = 1000  # of one row's count
_WIDEST, _WIDEST_LINE = 10.0, 0.5  # m of what has no unit
_FULL = 5.0  # times its diameter: a metre of line shows no larger area
_METRES = re.compile(r"/\s*(\d+)")  # kg/100 m
_SPREAD = ("buoyancy", "mass", "area", "drag_area", "tangential_area")  # along a line
_USUAL = {"cable": 1.3, "chain": 2.75, "sphere": 0.5, "cylinder": 1.2}
_ROLES = ("float", "instrument", "release", "connector")
_FITTING = 1.0  # m: a shorter link or shackle of a rope is none
_ROUND = 1.5  # times its diameter: a float no longer is a sphere
_HALF_DENSITY = 0.5 * REFERENCE_DENSITY


@dataclass(eq=False)
class ListRow:
    """Hold a row: its name, its figures, what was guessed in it, and its count.

    `metre` names the figures of a line that are per metre; `line` says whether it is a cable or
    chain, `hint` where a library says that its figures might be, and `problems` what is wrong.
    """

    place: int
    name: str
    label: str = ""
    kind: str = ""
    role: str = ""
    figures: dict[str, float] = field(default_factory=dict)
    guesses: dict[str, str] = field(default_factory=dict)
    metre: set[str] = field(default_factory=set)
    line: bool | None = None
    hint: str = ""
    count: int = 1
    problems: list[str] = field(default_factory=list)

    @property
    def where(self) -> str:
        """The name by which problems call it."""
        return f"row {self.place}, {self.name}"

    def refuse(self, problem: str) -> None:
        """Add what is wrong with it."""
        self.problems.append(f"{self.where}: {problem}")

    def figure(self, what: str) -> float:
        """Return a figure; 0 where the list has none."""
        return self.figures.get(what, 0.0)

    @property
    def is_anchor(self) -> bool:
        """Tell whether it is the anchor."""
        said = _ANCHOR_KINDS.search(f"{self.kind} {self.role}")
        return said is not None or model.is_called(self.name, "anchor")

    @property
    def sinks(self) -> bool:
        """Tell whether it is a line, an anchor, or what sinks by its name."""
        named = model.is_called(self.name, "connector", "release")
        return named or self.is_line or self.is_anchor

    @property
    def is_line(self) -> bool:
        """Tell whether it is a cable or a chain."""
        if self.line is not None:
            return self.line
        if self.role in _ROLES or model.is_called(self.kind, "rigid"):
            return False
        if model.is_called(self.name, "connector") and self.figure("length") < _FITTING:
            return self.role == "line"
        return self.role == "line" or model.is_called(f"{self.kind} {self.name}", "line")


def rows_of(
    cells: SheetRows,
    headings: ListHeadings,
    problems: list[str],
    dropped: list[model.Remark],
    guessed: list[model.Remark],
    *,
    bare: Callable[[str], bool] = lambda name: False,
) -> list[ListRow]:
    """Return the rows below the headings; sums and rows without figures go to `dropped`.

    Parameters
    ----------
    guessed : to which the decimal sign is added where the file has commas
    bare : whether a name alone makes a piece, since a library has its figures
    """
    rows: list[ListRow] = []
    known = headings.columns
    decimal, said = decimals_of(cells, headings, problems)
    if said:
        guessed.append(model.Remark("numbers", said))
    for place, each in enumerate(cells[headings.row + 1 :], headings.row + 2):
        name = cell_of(each, known["name"])
        if _DITTO.match(name) and rows:
            guessed.append(model.Remark(f"row {place}", f"`{name}` read as `{rows[-1].name}`"))
            name = rows[-1].name
        if not name:
            held = [cell_of(each, column) for what, column in known.items() if what in _ENOUGH]
            if any(re.search(r"\d", cell) for cell in held):
                dropped.append(model.Remark(f"row {place}", "it has figures and no name"))
            continue
        if TOTAL.match(name):
            dropped.append(model.Remark(f"row {place}", f"`{name}`, a sum"))
            continue
        row = _row(each, ListRow(place, name), known, decimal)
        if not (bare(name) or _ENOUGH & row.figures.keys() or row.is_anchor):
            dropped.append(model.Remark(f"row {place}", f"`{name}`, without length and weight"))
            continue
        size = row.figure("diameter") or row.figure("width") or model.size_in(name)
        fixed = (
            row.is_line or row.is_anchor or row.role in _ROLES or model.is_called(row.kind, "rigid")
        )
        if not fixed and model.is_long(name, row.figure("length"), size):
            row.line = True
            guessed.append(model.Remark(row.where, "taken as a rope, since it is long and thin"))
        several = _COUNTED.match(name)
        if several and row.count == 1 and not row.is_line:
            said = f"read as one piece with the figures of its row, not as {several[1]} of them"
            guessed.append(model.Remark(row.where, said))
        rows.append(row)
    return rows


def _row(cells: list[str], row: ListRow, known: dict[str, ListColumn], decimal: str) -> ListRow:
    """Return a row with the words and figures of its cells."""
    row.label, row.kind, row.role = (
        cell_of(cells, known.get(what)).removeprefix("'") for what in ("label", "kind", "role")
    )
    for what, column in known.items():
        if what in WORDS:
            continue
        column, cell = column.of(cells, line=row.is_line)
        found = number(cell, decimal)
        if found.value is None:
            if found.wrong and what != "material":
                row.refuse(f"{column.heading}: {found.wrong}")
            continue
        try:
            unit = unit_called(found.rest, what)
        except ValueError as error:
            row.refuse(f"{column.heading}: `{cell}`: {error}")
            continue
        figure = found.value * (unit or column).factor
        if not math.isfinite(figure):
            row.refuse(f"{column.heading} is {found.value:g}")
            continue
        widest = _WIDEST_LINE if row.is_line else _WIDEST
        if what in ("diameter", "width") and not (unit or column.known) and figure > widest:
            row.refuse(f"{column.heading} is {figure:g} m; which unit is it in?")
        if unit.per_metre if unit else column.per_metre:
            row.metre.add(what)
            several = _METRES.search(f"{column.heading} {found.rest}")
            if several and not row.is_line:
                figure *= int(several[1])
                row.guesses[what] = "read as that of the whole piece, since it is not a line"
        row.figures[what] = figure
        if found.tidied:
            row.guesses[what] = f"`{cell}` read as {found.value:g} {found.rest}".rstrip()
    count = row.figures.pop("count", 1.0)
    row.count = round(count)
    if not 1 <= row.count <= _MOST:
        row.refuse(f"{count:.12g} of them")
        row.count = 1
    return row


def weights_as_buoyancy(rows: Iterable[ListRow], guessed: list[model.Remark]) -> None:
    """Give every row its net force as buoyancy, positive up.

    Weights are positive down; where they are negative for what sinks by its name, positive up.
    Where what sinks has a positive buoyancy and all else a negative one, they are weights.
    """
    rows = list(rows)
    sinking = [row.figures["weight"] for row in rows if row.sinks and row.figures.get("weight")]
    upward = 2 * sum(weight < 0.0 for weight in sinking) > len(sinking)
    lifts = [row for row in rows if row.figures.get("buoyancy")]
    turned = all(row.sinks == (row.figures["buoyancy"] > 0.0) for row in lifts)
    if turned and 0 < sum(row.sinks for row in lifts) < len(lifts):
        guessed.append(model.Remark("buoyancy", "positive for parts that sink: read as weight"))
        for row in lifts:
            row.figures["buoyancy"] *= -1.0
    if upward:
        guessed.append(model.Remark("weights", "negative for parts that sink: read as buoyancy"))
    for row in rows:
        if "weight" not in row.figures:
            continue
        weight, guess = row.figures.pop("weight"), row.guesses.pop("weight", "")
        if row.figures.get("buoyancy"):
            continue
        row.figures["buoyancy"] = weight if upward else 0.0 - weight
        if "weight" in row.metre:
            row.metre.add("buoyancy")
        if guess:
            row.guesses["buoyancy"] = guess


def count_lines(rows: Iterable[ListRow], known: dict[str, ListColumn]) -> None:
    """Make figures of lines per metre, where the list gives them of the whole length."""
    lines = [row for row in rows if row.is_line and row.figure("length") > 0.0]
    for what in _SPREAD:
        column = known.get(what) or (known.get("weight") if what == "buoyancy" else None)
        listed = [row for row in lines if what in row.figures and what not in row.metre]
        if column is None or not listed:
            continue
        per_metre = not column.whole and (
            all(row.figures[what] <= _FULL * row.figure("diameter") for row in listed)
            if "area" in what
            else _same_for_all(listed, what)
        )
        for row in listed:
            if not per_metre:
                row.figures[what] /= row.figures["length"]
            row.metre.add(what)
            if what == "buoyancy" and not column.whole:
                row.guesses.setdefault(
                    what,
                    "read as that of a metre: it is the same at different lengths"
                    if per_metre
                    else "the weight in the list is read as that of the whole length",
                )


def _same_for_all(lines: list[ListRow], what: str) -> bool:
    """Return whether lines of one name have one weight, per metre then, at different lengths."""
    seen: dict[str, tuple[float, float]] = {}
    for row in lines:
        length, value = seen.setdefault(row.name, (row.figures["length"], row.figures[what]))
        if abs(length - row.figures["length"]) > 0.05 * length and value:
            return abs(value - row.figures[what]) < 0.01 * abs(value)
    return False


def component_of(row: ListRow, *, anchor: bool) -> model.ImportedComponent:
    """Return the definition of a row in SI, which may be the anchor; its `problems` are added."""
    for what in ("length", "diameter", "width", "cd", "area", "drag_area", "mass", "stiffness"):
        if row.figure(what) < 0.0:
            row.refuse(f"its {what.replace('_', ' ')} is negative")
    kind, kept = (_anchor if anchor else _line if row.is_line else _rigid)(row)
    guesses = {key: text for key, text in row.guesses.items() if key in kept and text}
    return model.ImportedComponent(row.name, kind, kept, guesses)


_Definition = tuple[str, dict[str, model.FigureOrWord]]
"""The kind of a component, and its figures."""


def _anchor(row: ListRow) -> _Definition:
    kept: dict[str, model.FigureOrWord] = {}
    if row.figure("buoyancy"):
        kept["weight"] = abs(row.figure("buoyancy"))
    elif row.figure("mass"):
        kept["mass"] = row.figure("mass")
        row.guesses["mass"] = "taken as steel: the list gives no weight in water"
    return "anchor", kept | {"length": row.figure("length")}


def _rigid(row: ListRow) -> _Definition:
    figures, guesses = row.figures, row.guesses
    if "buoyancy" not in figures:
        row.refuse(f"its weight in water or its buoyancy is missing{row.hint}")
    lift, length = row.figure("buoyancy"), row.figure("length")
    kind, across = _shape(row)
    kept: dict[str, model.FigureOrWord] = {"length": length}
    if "drag_area" in figures and "tangential_area" in figures:
        kind, guesses["kn"] = "body", guesses.get("drag_area", "")
        kept["kn"] = _HALF_DENSITY * figures["drag_area"]
        kept["kt"] = _HALF_DENSITY * figures["tangential_area"]
    elif "drag_area" in figures or "area" in figures:
        of = "drag_area" if "drag_area" in figures else "area"
        coefficient = 1.0 if of == "drag_area" else figures.get("cd", 1.0)
        kind, guesses["drag_area"] = "body", guesses.get(of, "")
        kept |= {"drag_area": figures[of], "cd": coefficient}
        if of == "area" and "cd" not in figures:
            guesses["cd"] = "the list gives an area and no coefficient"
    elif kind == "body":
        kept |= {"drag_area": 0.0, "cd": 1.0}
        guesses["drag_area"] = "the list gives no size: it has no drag"
    else:
        kept = {"diameter": across, "length": length or across, **_coefficient(row, kind)}
    kept["buoyancy"] = lift
    kept |= _further(row, lift, "breaking_load")
    kept["role"] = row.role if row.role in _ROLES else model.role_of(row.name, lift)
    return kind, kept


def _shape(row: ListRow) -> tuple[str, float]:
    """Return the kind of a rigid piece by its size, and its diameter [m].

    Where a list has widths and diameters, a diameter is that of a sphere. Elsewhere a float that is
    hardly longer than wide is a sphere.
    """
    width, diameter, length, lift = map(row.figure, ("width", "diameter", "length", "buoyancy"))
    if {"width", "diameter"} <= row.figures.keys():
        round_, across = diameter > 0.0, diameter or width
    else:
        across = diameter or width
        round_ = (lift > 0.0 or row.kind == "sphere") and length <= _ROUND * across
    if across <= 0.0 or (not round_ and length <= 0.0):
        return "body", 0.0
    return "sphere" if round_ else "cylinder", across


def _line(row: ListRow) -> _Definition:
    if row.figure("length") <= 0.0:
        row.refuse("a line needs its length")
    if "buoyancy" not in row.figures:
        row.refuse(f"its weight in water is missing{row.hint}")
    across, lift = row.figure("diameter") or row.figure("width"), row.figure("buoyancy")
    kind = (
        "chain" if lift <= 0.0 and model.is_called(f"{row.name} {row.kind}", "chain") else "cable"
    )
    if across <= 0.0:
        across = model.size_in(row.name)
        if across <= 0.0:
            row.refuse("its diameter is missing")
            across = 0.01
        row.guesses["diameter"] = "from its name"
    kept: dict[str, model.FigureOrWord] = {"diameter": across}
    if "drag_area" in row.figures:
        kept["cn"] = row.figure("drag_area") / across
        kept["ct"] = row.figure("tangential_area") / (math.pi * across)
    else:
        kept |= _coefficient(row, kind)
        if "area" in row.figures:
            kept["cn"] = float(kept["cn"]) * row.figure("area") / across
    if lift > 0.0:
        kept["buoyancy"] = lift
    else:
        kept["weight"] = 0.0 - lift
        row.guesses["weight"] = row.guesses.get("buoyancy", row.guesses.get("weight", ""))
    kept |= _further(row, lift, "stiffness", "breaking_load")
    material = row.figure("material")
    if "stiffness" not in kept and material in range(1, len(MODULI) + 1):
        kept["stiffness"] = MODULI[round(material) - 1] * math.pi / 4.0 * across**2
    return kind, kept


def _coefficient(row: ListRow, kind: str) -> dict[str, model.FigureOrWord]:
    """Return the drag coefficient of the list, or the usual one of the kind as a guess."""
    key, guess = "cx" if kind == "sphere" else "cn", f"the usual one of a {kind}"
    row.guesses[key] = row.guesses.get("cd", "") if "cd" in row.figures else guess
    return {key: row.figures.get("cd", _USUAL[kind])}


def _further(row: ListRow, lift: float, *names: str) -> dict[str, model.FigureOrWord]:
    """Return further figures; a mass lighter than the piece is in water is left out."""
    mass = row.figure("mass")
    heavy = mass > 0.0 and mass * KILOGRAM_FORCE >= max(-lift, 0.0)
    named = {name: row.figure(name) for name in names if row.figure(name) > 0.0}
    return {"mass": mass, **named} if heavy else {**named}
