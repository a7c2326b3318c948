"""Which profile of a record: the one nearest to the time a person asks for."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime

ZONES_OF_UTC = ("UTC", "GMT", "Z", "ZULU", "UTC+0", "UTC+00:00", "+00:00", "ETC/UTC")
"""What a zone is called that is no other than UTC, in capitals."""


class TimeChoiceError(ValueError):
    """The time asked for is none, is not in the record, or is needed and not given."""


def parse_time(text: str) -> datetime:
    """Return an ISO 8601 time, in UTC where it names no zone.

    Raises
    ------
    TimeChoiceError
        The text is no such time.
    """
    try:
        time = datetime.fromisoformat(text.strip())
    except ValueError:
        raise TimeChoiceError(f"`{text[:40]}` is not a time; write 2026-03-01T06:00") from None
    return time.replace(tzinfo=UTC) if time.tzinfo is None else time.astimezone(UTC)


def choose_time(times: Sequence[datetime], wanted: str | None) -> tuple[int, str | None]:
    """Return the index of the time nearest to the one wanted, and a notice where it is not that
    very time.

    Raises
    ------
    TimeChoiceError
        There is no time to choose from, several and none is wanted, or all lie to one side.
    """
    if not times:
        raise TimeChoiceError("the file has no times")
    first, last = min(times), max(times)
    span = f"{_short(first)} to {_short(last)}"
    if wanted is None:
        if len(times) == 1:
            return 0, None
        raise TimeChoiceError(f"the file has {len(times)} times, {span}; give `time:`")
    moment = parse_time(wanted)
    if not first.replace(microsecond=0) <= moment <= last:
        raise TimeChoiceError(f"{_short(moment)} is outside the record, {span}")
    index = min(range(len(times)), key=lambda i: abs(times[i] - moment))
    if times[index] == moment:
        return index, None
    return index, f"the current is that of {_short(times[index])}, nearest to {_short(moment)}"


def _short(time: datetime) -> str:
    text = time.strftime("%Y-%m-%dT%H:%M:%S")
    return text.removesuffix(":00")
