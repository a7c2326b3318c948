"""Provenance of a report: title block, inputs, versions, date and a hash."""

import hashlib
import json
import os
import platform
from collections.abc import Iterable, Sequence
from dataclasses import fields, is_dataclass
from datetime import UTC, datetime
from importlib.metadata import version
from importlib.util import find_spec
from math import hypot
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import BaseModel

from calm.checks.finding import State
from calm.errors import InputError, UsageError
from calm.files import MooringFile, Position
from calm.files.environment import Environment
from calm.physics.line import Water
from calm.quantities import bearing_of, say
from calm.report import blocks
from calm.report.blocks import Listing, Prose, Report, ReportPart, number, quantity, table_of, words
from calm.version import __version__
from calm.whole_file import read_text

_LIBRARIES = ("numpy", "pydantic", "jinja2", "typst")


def made_by() -> str:
    """List the versions of CALM, of Python, and of the libraries for computation and drawing."""
    there = (name for name in _LIBRARIES if find_spec(name))  # a web page has no typst
    libraries = (f"{name} {version(name)}" for name in there)
    return ", ".join((f"calm {__version__}", f"python {platform.python_version()}", *libraries))


_LATEST = 253_402_300_799  # the last second of the year 9999


def moment() -> datetime | None:
    """Return the time given by SOURCE_DATE_EPOCH, in UTC; None if the variable is not set.

    Reports contain no other date. Raise UsageError if the value is not a valid number of seconds.
    """
    text = os.environ.get("SOURCE_DATE_EPOCH")
    if not text:
        return None
    if not text.isascii() or not text.isdigit() or int(text) > _LATEST:
        raise UsageError(f"SOURCE_DATE_EPOCH, `{text}`, is not a number of seconds")
    return datetime.fromtimestamp(int(text), UTC)


def date() -> str | None:
    """Return the date of `moment`, such as 2026-11-21; None if `moment` returns None."""
    when = moment()
    return None if when is None else when.date().isoformat()


def report_of(title: str, subtitle: str, *parts: ReportPart, name: str = "") -> Report:
    """Create a report with a single section and the date from `date`.

    The section is called `name` or, if `name` is empty, `title`.
    """
    return Report(title, subtitle, (), (blocks.Section(name or title, parts),), date())


def source_text(file: MooringFile) -> str | None:
    """Return the text of the mooring file; None if the file can no longer be read."""
    try:
        return read_text(Path(file.path))
    except InputError:
        return None


def file_name(file: MooringFile) -> str:
    """Return the name of the mooring file without its folder."""
    return Path(file.path).name


def input_hash(files: Sequence[MooringFile]) -> str:
    """Return the SHA-256 hash of the inputs for all environments, in hexadecimal digits.

    The hash covers the text of the file, component values, settings, environments and currents, but
    not file locations.
    """
    digest = hashlib.sha256((source_text(files[0]) or "").encode("utf-8", "replace"))
    first = canonical(files[0].pieces)
    for file in files:
        line = first if file.pieces == files[0].pieces else canonical(file.pieces)
        others = map(canonical, (file.tow, file.environment, file.solver, file.checks))
        resolved = ",".join([canonical(file.name), line, *others])
        digest.update(f"[{resolved}]".encode("utf-8", "replace"))
    return digest.hexdigest()


def canonical(value: Any) -> str:
    """Serialise a value as JSON with sorted keys and no blanks; a model becomes a JSON object."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), default=_object)


def _object(one: Any) -> dict[str, Any]:
    known: dict[str, Any]
    if isinstance(one, BaseModel):
        known = one.model_dump()
    elif is_dataclass(one):
        # a field that a comparison omits, such as the path of a record, is no input
        known = {each.name: getattr(one, each.name) for each in fields(one) if each.compare}
    else:
        known = vars(one)
    return known


_ALSO_EXCLUDED = (
    "obstructions in ADCP beams, such as the line or its floats",
    "biofouling unless `fouling` is set", "soil strength", "trawls, ice and ships",
    "terminations and splices", "batteries and memory", "magnetic steel near compasses",
)  # fmt: skip

UNSEEN = (
    "Not covered by a static calculation: waves and the tensions they cause; snap loads; fatigue "
    "due to waves and vortices; creep, corrosion and wear; transients at the end of the anchor "
    "launch; hauling and lifting during recovery.",
    "No margin in this report includes these effects. In harsh weather, these effects determine "
    "the life of a surface mooring. A safety factor on static tension does not replace their "
    "analysis.",
    f"Also excluded: {'; '.join(_ALSO_EXCLUDED)}.",
)
"""Statements on excluded effects that every report contains."""

BY_WAVES = ("waves", "fatigue due to waves")
"""Effects that are excluded unless environments have `waves:`."""
WAVES_IN_TIDE = "waves at high and low water"
"""Effect that is excluded in tidal water, even with `waves:`."""

UNJUDGED = (
    *BY_WAVES, "snap loads", "fatigue due to vortices", "creep, corrosion and wear",
    "transients of the launch", "hauling and lifting during recovery", *_ALSO_EXCLUDED,
)  # fmt: skip
"""Effects that no rule checks."""


def unjudged(environments: Iterable[Environment]) -> list[str]:
    """Return the effects that the design check does not cover in the given environments."""
    waters = [*environments]
    if not all(one.waves for one in waters):
        return [*UNJUDGED]
    tide = any(one.depth_range is not None for one in waters)
    seen = [one for one in UNJUDGED if one not in BY_WAVES]
    return [WAVES_IN_TIDE, *seen] if tide else seen


NOT_JUDGED = ReportPart("Not covered by this check", (Prose(UNSEEN, State.UNKNOWN),))
"""Report part with the excluded effects."""


_MOST_LEVELS = 40


def environments_table(waters: Iterable[tuple[str, Water]]) -> blocks.Table:
    """Tabulate water depth, density, and maximum current with its depth, for each environment."""
    rows = []
    for name, water in waters:
        speed = np.hypot(water.u, water.v)
        fastest = int(speed.argmax())
        densities = sorted({f"{density:.0f}" for density in water.density})
        density = "–".join(dict.fromkeys((densities[0], densities[-1])))
        depth = water.depth if np.isfinite(water.depth) else None
        current = float(speed[fastest]), float(water.level[fastest])
        rows.append((name, depth, density, *current, len(water.level)))
    return table_of(
        "Environments",
        rows,
        words("environment", 0),
        quantity("depth", 1, "water depth"),
        number("density", 2, "kg/m³"),
        quantity("speed", 3, "strongest current"),
        quantity("depth", 4, "at depth"),
        number("levels", 5),
    )


def current_listing(name: str, water: Water) -> Listing:
    """List the current that the computation used.

    At most `_MOST_LEVELS` levels of the current are listed.
    """
    count = len(water.level)
    chosen = np.unique(np.linspace(0, count - 1, min(count, _MOST_LEVELS)).round().astype(int))
    lines = [f"{'depth m':>10} {'speed m/s':>10} {'toward °':>10} {'upward m/s':>11}"]
    for level in chosen:
        u, v, w = water.u[level], water.v[level], water.w[level]
        toward = bearing_of(u, v)
        lines.append(f"{water.level[level]:10.1f} {hypot(u, v):10.3f} {toward:10.1f} {w:11.3f}")
    if len(chosen) < count:
        lines.append(f"{len(chosen)} of {count} levels")
    return Listing(f"Current, {name}", "\n".join(lines))


def document_part(file: MooringFile) -> tuple[ReportPart, ...]:
    """Create the title block and the revision history, if the file has a `document`."""
    if file.document is None:
        return ()
    return (ReportPart("Document", (blocks.Pairs(tuple(title_pairs(file))),)), *history_part(file))


def history_part(file: MooringFile) -> tuple[ReportPart, ...]:
    """Create the revision history, if the file has any revisions."""
    if file.document is None or not file.document.history:
        return ()
    first = words("revision", share=0.0), words("date", share=0.0)
    fields = (*first, words("by"), words("change", share=3.0))
    return (ReportPart("History", (table_of("", file.document.history, *fields),)),)


def title_pairs(file: MooringFile) -> list[tuple[str, str]]:
    """Return pairs of name and value for the title block: document, position and water depth."""
    document = file.document
    names = ("revision", "date", "project", "ship", "cruise", "author", "checked", "approved")
    pairs = [("mooring", file.name)]
    if document is not None:
        given = [("document", document.id), *((name, getattr(document, name)) for name in names)]
        pairs += [(title, text) for title, text in given if text is not None]
    if file.position is not None:
        pairs.append(("position", position_text(file.position)))
    if file.environment.depth is not None:
        pairs.append(("water depth", say("depth", file.environment.depth)))
    return pairs


def position_text(position: Position) -> str:
    """Format a position in degrees and minutes to a thousandth of a minute (2 m)."""
    latitude = degrees_text(position.latitude, "NS", 2)
    return f"{latitude}, {degrees_text((position.longitude + 180.0) % 360.0 - 180.0, 'EW', 3)}"


def degrees_text(degrees: float, sides: str, digits: int) -> str:
    """Format a latitude or longitude in whole degrees and in minutes to a thousandth.

    `sides` are the letters for positive and negative angles. The degrees have at least `digits`
    digits.
    """
    whole, minutes = divmod(round(abs(degrees) * 60_000), 60_000)
    return f"{whole:0{digits}d}° {minutes / 1000:06.3f}′ {sides[degrees < 0.0]}"


def inputs_part(inputs: Sequence[tuple[str, MooringFile, Water]]) -> ReportPart:
    """Report the inputs: environments, mooring file, currents, hash and versions.

    `inputs` has one tuple for each environment: name, mooring file, and water.
    """
    files = [file for _, file, _ in inputs]
    waters = list({name: water for name, _, water in reversed(inputs)}.items())[::-1]
    text = source_text(files[0])
    content = "The file can no longer be read." if text is None else text.rstrip()
    origin = (f"SHA-256 of the inputs: {input_hash(files)}", f"Computed with {made_by()}")
    listed = (Listing("Mooring file", content), *(current_listing(*each) for each in waters))
    return ReportPart("Inputs", (environments_table(waters), *listed, Prose(origin)))
