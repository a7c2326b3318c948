"""Rule `serials-and-dates`: contradictions between labels, serial numbers, release codes and dates.

No result depends on these values, but they are printed on deck sheets and labels.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from itertools import pairwise

from calm.checks.assessment import Handling
from calm.checks.finding import State, Verdict, rule, verdict_on
from calm.files import Clamp, MooringFile, Piece
from calm.files.logbook import DocumentKeys
from calm.files.mooring_file import unknown_releases
from calm.files.pieces import parts_of

Part = Piece | Clamp


@rule("serials-and-dates", once=True)
def serials_and_dates(handling: Handling) -> Iterator[Verdict]:
    """Warn about repeated or unmatched identifiers, and about dates in the wrong order.

    Identifiers are labels, serial numbers and release codes. A release code is unmatched if the
    line has no such release.
    """
    file = handling.leg.file
    parts = parts_of(file.pieces)
    yield from _repeated_labels(parts)
    yield from _repeated_serials(parts)
    yield from _releases(file)
    yield from _date_contradictions(parts, file)
    if file.document is not None:
        for message in _document_contradictions(file.document):
            yield _warning(None, message, "Check the `document` and its `history`.")


def _repeated_labels(parts: Sequence[Part]) -> Iterator[Verdict]:
    rows: dict[str, dict[tuple[int, int], Part]] = defaultdict(dict)
    for part in parts:
        if part.place.part >= 0 and part.place.is_clamp:
            continue  # labels inside an assembly are those of the catalogue
        if part.named and part.component.role not in ("connector", "anchor"):
            rows[part.named].setdefault((part.place.item, part.place.clamp), part)
    for label, found in rows.items():
        if len(found) > 1:
            first = next(iter(found.values()))
            yield _warning(
                first,
                f"{len(found)} rows of the line have the label `{label}`; one may be a copy.",
                "Rename or remove the extra row.",
            )


def _repeated_serials(parts: Sequence[Part]) -> Iterator[Verdict]:
    items: dict[tuple[str, str], list[Part]] = defaultdict(list)
    for part in parts:
        for serial in part.serials:
            items[part.use, serial].append(part)
    for (use, serial), found in items.items():
        # items of a count and parts of an assembly share their serial number
        alone = {(one.place.item, one.place.clamp) for one in found}
        if len(alone) > 1:
            names = " and ".join(one.label for one in found[:2])
            yield _warning(
                found[0],
                f"{names} are both {use} and have the same serial number, {serial}.",
                "Check both serial numbers.",
            )


def _releases(file: MooringFile) -> Iterator[Verdict]:
    for message in unknown_releases(file.releases, file.pieces, file.deployed):
        yield _warning(None, message, "Check the serial numbers of the releases.")
    serials = [one.serial for one in file.releases if one.serial is not None]
    for serial in dict.fromkeys(one for one in serials if serials.count(one) > 1):
        message = f"`releases` gives codes for serial number {serial} twice."
        yield _warning(None, message, "Keep only the row with the correct codes.")
    codes = [one.code_lines for one in file.releases if one.code_lines]
    if len(set(codes)) < len(codes):
        message = "Two releases have the same codes, so both would answer and open."
        yield _warning(None, message, "Check the codes of the releases.")


def _date_contradictions(parts: Sequence[Part], file: MooringFile) -> Iterator[Verdict]:
    deployed = file.deployed.date[:10] if file.deployed and file.deployed.date else None
    for part in parts:
        battery, calibrated = part.equipment.battery_until, part.equipment.calibrated
        if battery and deployed and battery <= deployed:
            message = f"The battery of {part.label} runs out on {battery}; the deployment is on "
            message += f"{deployed}."
            yield _warning(part, message, "Check both dates, or replace the battery.")
        if battery and calibrated and battery <= calibrated:
            message = (
                f"The battery of {part.label} runs out on {battery}, but the part was calibrated "
                f"on {calibrated}."
            )
            yield _warning(part, message, "Check both dates.")
        if calibrated and deployed and calibrated > deployed:
            message = (
                f"The calibration date of {part.label}, {calibrated}, is after the deployment on "
            )
            message += f"{deployed}."
            remedy = "Check both dates: this may be the calibration after recovery."
            yield _warning(part, message, remedy)


def _document_contradictions(document: DocumentKeys) -> Iterator[str]:
    history = document.history
    dated = [one for one in history if one.date is not None]
    for earlier, later in pairwise(dated):
        if (later.date or "") < (earlier.date or ""):
            yield (
                f"Revision {later.revision} is dated {later.date}, but the preceding revision "
                f"{earlier.revision} has a later date, {earlier.date}."
            )
    names = [one.revision for one in history]
    for name in dict.fromkeys(one for one in names if names.count(one) > 1):
        yield f"Revision {name} occurs {names.count(name)} times in the `history`."
    if not history:
        return
    if document.revision is not None and document.revision != names[-1]:
        yield (
            f"The document is revision {document.revision}, but its `history` ends with revision "
            f"{names[-1]}."
        )
    elif document.date and dated and document.date < (dated[-1].date or ""):
        yield (
            f"The document is dated {document.date}, but its revision {dated[-1].revision} has a "
            f"later date, {dated[-1].date}."
        )


def _warning(part: Part | None, message: str, remedy: str) -> Verdict:
    return verdict_on(part, State.WARN, message, remedy)
