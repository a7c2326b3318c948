"""What is asked about the very thing that hangs at a row: serial number, dates, sampling."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from calm.files.editing import Value
from calm.tui.checking import Reading, anything, day
from calm.tui.dialogs import Asked, Sheet

_SEVERAL = "For a count, give one number for each, separated by commas."


def equipment_sheet(label: str, values: Mapping[str, Any], *, is_clamp: bool) -> Sheet:
    """The fields of a row as the file has them.

    Parameters
    ----------
    label : of the row
    values : what the file says of it
    """
    asked = [
        Asked("serial", "Serial number", _said(values, "serial"), _serial_of_equipment, "4711"),
        Asked("calibrated", "Calibrated", _said(values, "calibrated"), day, "2027-06-30"),
        Asked("sampling", "Sampling", _said(values, "sampling"), anything, "every 10 min"),
        Asked("battery_until", "Battery until", _said(values, "battery_until"), day, "2028-06-30"),
    ]
    if not is_clamp:
        made = _said(values, "termination")
        asked.append(Asked("termination", "Termination", made, anything, "swaged, thimbles"))
    return Sheet(label, _SEVERAL, asked)


def equipment_changes(
    values: Mapping[str, Any], texts: Mapping[str, str]
) -> dict[str, Value | None]:
    """What of the texts differs from what the file says; None takes a key away."""
    changed: dict[str, Value | None] = {}
    for key, new in texts.items():
        if new != _said(values, key):
            several = key == "serial" and "," in new and "count" in values
            changed[key] = [one.strip() for one in new.split(",")] if several else new or None
    return changed


def _said(values: Mapping[str, Any], key: str) -> str:
    value = values.get(key)
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value or "")


def _serial_of_equipment(text: str) -> Reading:
    numbers = [" ".join(one.split()) for one in text.split(",")]
    if len(numbers) > 1 and not all(numbers):
        return Reading("", "a number is blank")
    return Reading(", ".join(numbers))
