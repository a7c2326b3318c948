"""An environment file as the lines of a mooring file."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from calm.exchange.design import one_line
from calm.exchange.refusal import refused
from calm.exchange.writing import quoted
from calm.files.document import read_document


def environment_lines(path: Path, output: Path) -> list[str]:
    """The `environment` of a file, its paths relative to the folder of the mooring file.

    Raises
    ------
    InputError
        The file cannot be read, or has no `environment`.
    """
    found = read_document(path).data.get("environment")
    if not isinstance(found, dict) or not found:
        raise refused(path, "has no `environment`")
    current = found.get("current")
    if isinstance(current, dict) and isinstance(current.get("file"), str):
        target = os.path.join(path.parent, current["file"])
        found["current"] = {**current, "file": os.path.relpath(target, str(output.parent))}
    return [f"environment:  # that of {one_line(path.name)}", *_lines(found, "  ")]


def _lines(value: dict[str, Any], indent: str) -> list[str]:
    lines: list[str] = []
    for key, each in value.items():
        if isinstance(each, dict) and each:
            lines += [f"{indent}{key}:", *_lines(each, indent + "  ")]
        elif isinstance(each, list) and any(isinstance(row, (list, dict)) for row in each):
            lines.append(f"{indent}{key}:")
            lines += [f"{indent}  - {_flow(row)}" for row in each]
        else:
            lines.append(f"{indent}{key}: {_flow(each)}")
    return lines


def _flow(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(_flow(each) for each in value)}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key}: {_flow(each)}' for key, each in value.items())}}}"
    return "null" if value is None else _scalar(str(value))


def _scalar(text: str) -> str:
    """A text as it stands where it is a figure or a word, with quotes elsewhere."""
    safe = text and all(sign.isalnum() or sign in " .+-/^_*()%" for sign in text)
    return text if safe and text == text.strip() and text[0] not in "-*%" else _signed(text)


def _signed(text: str) -> str:
    negative = text[:1] == "-" and text[1:2].isdigit() and ":" not in text and "#" not in text
    return text if negative and "," not in text else quoted(text)
