"""Suggested changes to a mooring file that correct findings of the design check.

This module has no user interface. Changes that meet a target are found by the search of
`calm size`.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from math import ceil
from pathlib import Path

from calm.case import Design, targets
from calm.case.adjustment import parse_change
from calm.case.leg_result import LegResult
from calm.case.size import NOT_MET, size
from calm.checks.finding import Finding, State
from calm.checks.strength import ANCHOR_RULES
from calm.errors import CalmError, UsageError
from calm.files import Anchor, Catalogue, Piece, Rigid
from calm.files.editing import Draft
from calm.quantities import QUANTITIES, rounded, say
from calm.solve import Status
from calm.tui.live import View, held_lines

_DIGITS = 3
_GRAVE = (State.FAIL, State.WARN)


@dataclass(frozen=True)
class Offer:
    """A suggested change, with its effect (`title`) and its name in the history (`label`).

    `make` applies the change to a draft, and may solve the line. `make` raises `CalmError` if the
    change does not help.
    """

    title: str
    label: str
    make: Callable[[Draft], Draft]


def single(view: View) -> LegResult | None:
    """Return the solution of a mooring with a single line.

    Return None for a tow, a net, or a mooring without equilibrium.
    """
    result = view.result
    return None if result is None or result.several or result.towed else result.leg


def offers(view: View, catalogue: Catalogue, catalogs: Sequence[str | Path] = ()) -> list[Offer]:
    """Suggest changes that remove failures and warnings of a line, in order of severity.

    Anchor suggestions need a solution in every environment and situation. `catalogs` are catalogue
    files of the user.
    """
    anchors = [*_anchors(view, catalogue, catalogs)] if _needs_new_anchor(view) else []
    grave = sorted((e for e in view.findings if e.state in _GRAVE), key=lambda each: each.rank)
    listed = [] if any(map(_is_of_anchor, grave)) else [*anchors]
    for finding in grave:
        if _is_of_anchor(finding):
            listed += anchors
        elif view.result is not None and single(view) is not None:
            listed += _offers_for(finding, view.result.design)
    return [*{offer.title: offer for offer in listed}.values()]


def _needs_new_anchor(view: View) -> bool:
    if (
        view.file is None
        or view.file.legs
        or view.file.tow is not None
        or "no float" in view.missing
    ):
        return False
    lifts = view.failure is not None and view.failure.status == Status.ANCHOR_LIFTS.label
    grave = any(each.state in _GRAVE and _is_of_anchor(each) for each in view.findings)
    return lifts or grave or not view.anchored


def _is_of_anchor(finding: Finding) -> bool:
    lifts = finding.rule == "equilibrium" and finding.message.startswith(Status.ANCHOR_LIFTS.label)
    return lifts or finding.rule in ANCHOR_RULES


def sized(mooring: Design, target: str, change: str) -> Offer:
    """Return an offer to change a quantity by the smallest amount that meets a target.

    The target and the change are in the syntax of `calm size`. Raise UsageError if the target or
    the change is invalid.
    """
    adjustment = parse_change(change, mooring.file)
    targets.parse_target(target, mooring.file)
    item = adjustment.parts[0].place.item
    key, unit = change.rpartition(".")[2], f" {adjustment.unit}" if adjustment.unit else ""
    clamps = (f"clamps.{part.place.clamp}" for part in adjustment.parts if part.place.is_clamp)
    if any(clamps):
        raise UsageError(
            f"{change}: clamped instruments cannot be changed here, only items of the line"
        )

    def make(draft: Draft) -> Draft:
        sizing = size(mooring, target, change)
        if sizing.status == NOT_MET:
            raise UsageError(f"{sizing.message} {sizing.advice}".strip())
        if sizing.after is None or sizing.after.value == adjustment.now:
            raise UsageError(f"{target} is met already")
        value = sizing.after.value
        if not adjustment.whole:
            value = rounded(value, _DIGITS, up=value > adjustment.now)
        return draft.put(item, key, f"{value:.10g}{unit}")

    return Offer(f"{change} so that {target}", f"{change} for {target}", make)


def _offers_for(finding: Finding, mooring: Design) -> Iterator[Offer]:
    if finding.rule == "backup" and finding.limit is not None and finding.value is not None:
        yield from _more_backup_floats(mooring, finding, finding.limit - finding.value)
    elif finding.rule in ("knockdown", "excursion", "tilt", "depth-rating") and finding.limit:
        yield from _more_buoyancy(mooring, finding)


def _anchors(view: View, catalogue: Catalogue, catalogs: Sequence[str | Path]) -> Iterator[Offer]:
    """Suggest the lightest anchor of the catalogue that holds in every environment and situation.

    If CALM's own catalogue does not define the present anchor, a weight for this anchor is also
    suggested.
    """
    loads = view.held or held_lines(view, catalogs)
    if view.file is None or not loads:
        return
    last, item = view.file.pieces[-1], len(view.items) - 1
    present = view.file.anchor

    def says(anchor: Anchor) -> str:
        worst = max(loads, key=lambda load: load.needed(anchor))
        when = f" ({worst.when})" if worst.when else ""
        return f"{say('tension', worst.needed(anchor))} needed{when}"

    holding = [
        (weight, id, anchor)
        for id, anchor in _anchors_of(catalogue)
        if all(load.weight(anchor) >= load.needed(anchor) for load in loads)
        for weight in [min(load.weight(anchor) for load in loads)]
    ]
    if holding:
        weight, id, anchor = min(holding, key=lambda each: each[:2])
        title = f"anchor: {id}, {say('tension', weight)} in water; {says(anchor)}"
        change = _put(item, "use", id) if view.anchored else _added(id)
        yield Offer(title, f"use {id}", change)
    else:
        heavy = f"No anchor in the catalogue is heavy enough: {says(present)}. Define one with `o`."
        yield Offer(
            f"anchor: none in the catalogue is heavy enough; {says(present)}", "anchor", _no(heavy)
        )
    known = catalogue.levels[-1].get(last.use)
    plain = view.anchored and present.mass is None
    if plain and (known is None or known is not catalogue.entry(last.use)):
        needed = max(load.needed(present) for load in loads)
        clamped = loads[0].weight(present) + present.net_buoyancy
        weight = rounded(needed - min(clamped, 0.0), _DIGITS, up=True)
        title = f"anchor: {last.use} with a weight of {say('tension', weight)} in water"
        yield Offer(f"{title}; {says(present)}", "a heavier anchor",
                    _put(item, "weight", f"{weight:g} N"))  # fmt: skip


def _anchors_of(catalogue: Catalogue) -> Iterator[tuple[str, Anchor]]:
    for id in catalogue.ids():
        entry = catalogue.entry(id)
        fields = {} if entry is None else entry.section.data
        # a definition with `prefer` names a better definition of the same product
        if fields.get("kind") == "anchor" and "prefer" not in fields:
            with suppress(CalmError):  # a component of the user's catalogue with a mistake
                component = catalogue.get(id)
                if isinstance(component, Anchor) and component.material_known:
                    yield id, component


def _added(id: str) -> Callable[[Draft], Draft]:
    return lambda draft: draft.insert(len(draft.items), {"use": id})


def _no(reason: str) -> Callable[[Draft], Draft]:
    def make(_: Draft) -> Draft:
        raise UsageError(reason)

    return make


def _more_backup_floats(mooring: Design, finding: Finding, lacking: float) -> Iterator[Offer]:
    file, release = mooring.file, mooring.file.release
    broken = next((p.index for p in file.pieces if p.place == finding.place), -1)
    if release is None:
        return
    below = [piece for piece in file.pieces[broken + 1 : release] if _is_float(piece)]
    for item in dict.fromkeys(piece.place.item for piece in below):
        own = [piece for piece in file.pieces if piece.place.item == item]
        count = len(own) + ceil(lacking / own[0].component.net_buoyancy)
        label = f"{count} {own[0].use}"
        title = f"back-up buoyancy: {label} instead of {len(own)}"
        yield Offer(title, label, _put(item, "count", str(count)))


def _put(item: int, key: str, value: str) -> Callable[[Draft], Draft]:
    def make(draft: Draft) -> Draft:
        made = draft.put(item, key, value)
        # the `weight` in the item is that of the previous component
        if key == "use" and "weight" in draft.items[item].values:
            made = made.put(item, "weight", None)
        return made

    return make


def _is_float(piece: Piece) -> bool:
    is_one = isinstance(piece.component, Rigid) and piece.place.part < 0
    return is_one and piece.component.role == "float" and piece.component.net_buoyancy > 0.0


def _more_buoyancy(mooring: Design, finding: Finding) -> Iterator[Offer]:
    floats = [piece for piece in mooring.file.pieces if _is_float(piece)]
    if not floats:
        return
    quantity = "depth" if finding.rule == "depth-rating" else finding.rule
    unit = "deg" if quantity == "tilt" else "m"
    label = finding.component
    part = f"({label})" if quantity in ("tilt", "depth") and label else ""
    target = f"{quantity}{part} <= {finding.limit:g} {unit}"
    yield sized(mooring, target, f"{floats[0].label}.buoyancy")


def differences(before: View, after: View) -> list[str]:
    """List the changed values and counts of findings, such as ``warnings 3 → 1``."""
    effects = []
    one, other = single(before), single(after)
    if one is not None and other is not None:
        figures = [
            ("top", "depth", one.top.depth, other.top.depth),
            ("knockdown", "knockdown", one.top.knockdown, other.top.knockdown),
            ("anchor needs", "required_weight", one.anchor_load.required_weight,
             other.anchor_load.required_weight),
            ("anchor weighs", "required_weight", one.anchor_load.weight, other.anchor_load.weight),
        ]  # fmt: skip
        for name, quantity, old, new in figures if before.anchored else figures[:-1]:
            texts = [QUANTITIES[quantity].say(value) for value in (old, new)]
            if texts[0] != texts[1]:
                effects.append(f"{name} {texts[0]} → {texts[1]}")
    elif after.failure is not None:
        effects.append(f"no equilibrium: {after.failure.message}")
    if idle := [when for when, view in (("before", before), ("now", after)) if not view.result]:
        return [*effects, f"findings: not judged {' and '.join(idle)} (no equilibrium)"]
    words = {"failures": State.FAIL, "unknown values": State.UNKNOWN, "warnings": State.WARN}
    for word, state in words.items():
        counts = [sum(each.state is state for each in view.findings) for view in (before, after)]
        if counts[0] != counts[1]:
            effects.append(f"{word} {counts[0]} → {counts[1]}")
    return effects or ["no displayed value changes"]
