"""Suggest changes to the file that correct findings of the design check.

This module does not depend on the screen. Targets are met by the search of `calm size`.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from math import ceil

from calm.case import Design, targets
from calm.case.adjustment import parse_change
from calm.case.leg_result import LegResult
from calm.case.size import NOT_MET, size
from calm.checks.finding import Finding, State
from calm.errors import CalmError, UsageError
from calm.files import Anchor, Catalogue, Piece, Rigid
from calm.files.editing import Draft
from calm.quantities import QUANTITIES, rounded, say
from calm.solve import Status
from calm.tui.live import View, judge

_DIGITS = 3
_ANCHOR = ("anchor-weight", "anchor-uplift", "anchor-sliding")
_GRAVE = (State.FAIL, State.WARN)


@dataclass(frozen=True)
class Offer:
    """A suggested change.

    Attributes
    ----------
    title : purpose and effect
    label : name in the history
    make : returns the changed file; may solve for a value, and raise `CalmError` without a remedy
    """

    title: str
    label: str
    make: Callable[[Draft], Draft]


def single(view: View) -> LegResult | None:
    """Return the solved line of a mooring; None for a tow, several legs, or no equilibrium."""
    result = view.result
    return None if result is None or result.several or result.towed else result.leg


def offers(view: View, catalogue: Catalogue | None) -> list[Offer]:
    """Return suggested changes for the failures and warnings of a line, the most severe first."""
    result = single(view)
    if view.result is None or result is None:
        return [*_against_lifting(view, catalogue)]
    mooring = view.result.design
    grave = sorted((e for e in view.findings if e.state in _GRAVE), key=lambda each: each.rank)
    found: dict[str, Offer] = {}
    for finding in grave:
        for offer in _for(finding, mooring, result, grave, catalogue):
            found.setdefault(offer.title, offer)
    return [*found.values()]


def _against_lifting(view: View, catalogue: Catalogue | None) -> Iterator[Offer]:
    """Suggest a heavier anchor for a line that lifts its anchor.

    The weight is found with an anchor that holds any load.
    """
    if view.failure is None or view.failure.status != Status.ANCHOR_LIFTS.label:
        return
    draft = Draft(view.text)
    held = judge(draft.delete([len(draft.items) - 1]).text, view.path, view.environment)
    if view.file is not None and (result := single(held)) is not None:
        needed = result.anchor_load.required_weight
        yield from _anchors(view.file.pieces[-1], needed, catalogue)


def sized(mooring: Design, target: str, change: str) -> Offer:
    """Suggest the smallest change of a quantity that meets a target; both are in the syntax of
    `calm size`.

    Raises
    ------
    UsageError
        The target or the change is invalid.
    """
    adjustment = parse_change(change, mooring.file)
    targets.parse_target(target, mooring.file)
    item = adjustment.parts[0].place.item
    key, unit = change.rpartition(".")[2], f" {adjustment.unit}" if adjustment.unit else ""
    clamps = (f"clamps.{part.place.clamp}" for part in adjustment.parts if part.place.is_clamp)
    if any(clamps):
        raise UsageError(f"{change}: only items of the line can be changed here")

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


def _for(
    finding: Finding,
    mooring: Design,
    result: LegResult,
    grave: Sequence[Finding],
    catalogue: Catalogue | None,
) -> Iterator[Offer]:
    if finding.rule in _ANCHOR:
        yield from _anchors(mooring.file.pieces[-1], _needed_weight(result, grave), catalogue)
    elif finding.rule == "backup" and finding.limit is not None and finding.value is not None:
        yield from _floats(mooring, finding, finding.limit - finding.value)
    elif finding.rule in ("knockdown", "excursion", "tilt", "depth-rating") and finding.limit:
        yield from _buoyancy(mooring, finding)


def _needed_weight(result: LegResult, grave: Sequence[Finding]) -> float:
    """Return the anchor weight in water [N] that satisfies all findings on the anchor."""
    factor = result.file.checks.anchor_factor
    needed = [result.anchor_load.required_weight]
    for finding in grave:
        if finding.rule == "anchor-weight" and finding.limit is not None:
            needed.append(finding.limit)
        if finding.rule == "anchor-uplift" and finding.value is not None:
            needed.append(factor * finding.value)
        if finding.rule == "anchor-sliding" and finding.value is not None:
            vertical = result.anchor_load.vertical
            needed.append(factor * (vertical + finding.value / result.anchor_load.friction))
    return max(needed)


def _anchors(last: Piece, needed: float, catalogue: Catalogue | None) -> Iterator[Offer]:
    """Suggest the lightest sufficient anchor in the catalogue, and a heavier version of the present
    anchor.
    """
    item = last.place.item
    heavy = [] if catalogue is None else [*_heavy_enough(catalogue, needed)]
    if heavy:
        weight, id = min(heavy)
        title = f"anchor: {id}, {say('tension', weight)} in water; {say('tension', needed)} needed"
        yield Offer(title, f"use {id}", _put(item, "use", id))
    weight = rounded(needed, _DIGITS, up=True)
    title = f"anchor: {last.use} with a weight of {say('tension', weight)} in water"
    yield Offer(title, "a heavier anchor", _put(item, "weight", f"{weight:g} N"))


def _heavy_enough(catalogue: Catalogue, needed: float) -> Iterator[tuple[float, str]]:
    for id in catalogue.ids():
        entry = catalogue.entry(id)
        if entry is not None and entry.section.data.get("kind") == "anchor":
            with suppress(CalmError):  # a component of the user's catalogue with a mistake
                component = catalogue.get(id)
                if isinstance(component, Anchor) and -component.net_buoyancy >= needed:
                    yield -component.net_buoyancy, id


def _floats(mooring: Design, finding: Finding, lacking: float) -> Iterator[Offer]:
    """Offer more floats between a break and the release."""
    file, release = mooring.file, mooring.file.release
    broken = next((p.index for p in file.pieces if p.place == finding.place), -1)
    if release is None:
        return
    below = [piece for piece in file.pieces[broken + 1 : release] if _is_float(piece)]
    for item in dict.fromkeys(piece.place.item for piece in below):
        own = [piece for piece in file.pieces if piece.place.item == item]
        count = len(own) + ceil(lacking / own[0].component.net_buoyancy)
        label = f"{count} {own[0].use}"
        title = f"back-up: {label} instead of {len(own)}"
        yield Offer(title, label, _put(item, "count", str(count)))


def _put(item: int, key: str, value: str) -> Callable[[Draft], Draft]:
    """Return a change that writes a value; with a new component, the `weight` of the row is
    deleted.
    """

    def make(draft: Draft) -> Draft:
        made = draft.put(item, key, value)
        if key == "use" and "weight" in draft.items[item].values:
            made = made.put(item, "weight", None)
        return made

    return make


def _is_float(piece: Piece) -> bool:
    is_one = isinstance(piece.component, Rigid) and piece.place.part < 0
    return is_one and piece.component.role == "float" and piece.component.net_buoyancy > 0.0


def _buoyancy(mooring: Design, finding: Finding) -> Iterator[Offer]:
    """Offer more buoyancy of the highest float to reduce a knockdown, an excursion or a tilt."""
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
    """Return the effects of a change on values and findings, each as ``from → to``."""
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
        for name, quantity, old, new in figures:
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
    return effects or ["none of the displayed values changes"]
