import numpy as np
import pytest

from calm.errors import UsageError
from calm.records.record import parse_period, parse_place


@pytest.mark.parametrize(
    ("text", "first", "last"),
    [
        ("2026-03-01T06:00/2026-03-02T18:30:15", "2026-03-01T06:00", "2026-03-02T18:30:15"),
        ("2026-03-01T06:00+02:00/..", "2026-03-01T04:00", None),
        ("/2026-03-31", None, "2026-03-31T23:59:59.999999999"),
        ("2026-02/2026-02", "2026-02-01", "2026-02-28T23:59:59.999999999"),
        ("2025/2026", "2025-01-01", "2026-12-31T23:59:59.999999999"),
        ("/", None, None),
        # beyond the times of any record, and of numbers of nanoseconds
        ("9999/", "2261-12-31T23:59:59.999999", None),
        ("1500/2500", "1678-01-01", "2261-12-31T23:59:59.999998999"),
    ],
)
def test_periods(text: str, first: str | None, last: str | None) -> None:
    expected = tuple(end if end is None else np.datetime64(end, "ns") for end in (first, last))
    assert parse_period(text) == expected


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("2026-03-01", "`2026-03-01` is not a period; write 2026-03-01/2026-03-31T12:00"),
        ("2026-03-02/2026-03-01", "ends before it begins"),
        ("2026-13/", "`2026-13` is not a date"),
        ("noon/", "`noon` is not a time"),
    ],
)
def test_no_periods(text: str, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        parse_period(text)


def test_places() -> None:
    assert parse_place("48.3,-5.2") == (48.3, -5.2)
    assert parse_place(" -33, 354.8") == (-33.0, 354.8)


@pytest.mark.parametrize("text", ["48.3", "48.3 -5.2", "48.3,-5.2,0", "95,0", "nan,0", "0,400"])
def test_no_places(text: str) -> None:
    with pytest.raises(UsageError, match="is not a position"):
        parse_place(text)
