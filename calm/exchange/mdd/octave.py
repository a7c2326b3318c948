"""Variables in Octave's text format, whose headers people edit by hand."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from calm.exchange.mdd.value import MOST, MatValue

_CELL = "<cell-element>"


def is_octave_text(content: bytes) -> bool:
    """Whether a file begins as Octave writes its text files."""
    start = content[:4096]
    return b"\0" not in start and start.lstrip().startswith(b"#") and b"# name:" in content[:65536]


def read_octave_text(text: str) -> dict[str, MatValue]:
    """Every variable that can be read; the others are left out.

    Raises
    ------
    ValueError
        A matrix has fewer numbers than its header says, or a header cannot be read.
    """
    variables: dict[str, MatValue] = {}
    cell: list[MatValue] | None = None
    for name, header, rows in _blocks(text.splitlines()):
        kind = header.get("type", "").removeprefix("global ").strip()
        value = _value(name, kind, header, rows)
        if name == _CELL:
            if cell is not None and value is not None:
                cell.append(value)
        elif kind == "cell":
            cell = variables[name] = []
        else:
            cell = None
            if value is not None:
                variables[name] = value
    return variables


def _blocks(lines: list[str]) -> Iterator[tuple[str, dict[str, str], list[str]]]:
    """Each variable: name, header and the lines below the header."""
    name, header, rows = "", dict[str, str](), list[str]()
    for line in lines:
        key, value = _header(line)
        if key == "name":
            if name:
                yield name, header, rows
            name, header, rows = value, {}, []
        elif key and key not in ("length", "base, limit, increment"):
            header.setdefault(key, value)
        elif name:
            rows.append(line)
    if name:
        yield name, header, rows


def _header(line: str) -> tuple[str, str]:
    """Key and value of a line such as ``# rows: 3``, with or without its colon."""
    if not line.lstrip().startswith("#"):
        return "", ""
    body = line.lstrip()[1:].strip()
    key, colon, value = body.partition(":")
    if not colon:
        key, _, value = body.partition(" ")
    return key.strip().lower(), value.strip()


def _value(name: str, kind: str, header: dict[str, str], rows: list[str]) -> MatValue | None:
    if kind in ("string", "sq_string"):
        return _texts(rows)
    if kind == "cell" or not kind:
        return None
    try:
        numbers = [float(word) for row in rows if not row.lstrip().startswith("#")
                   for word in row.replace(",", " ").split()]  # fmt: skip
    except ValueError:
        return None  # a structure, or complex numbers: none of those that matter here
    if kind.endswith("range") and len(numbers) == 3:
        return spread(name, *numbers)
    if "scalar" in kind or kind == "bool":
        return np.array(numbers[:1]).reshape(1, -1)
    if "ndims" in header:
        dims, values = int(float(header["ndims"])), numbers
        shape = [int(size) for size in values[:dims]]
        return _shaped(name, np.array(values[dims:]), shape, order="F")
    lines = [row for row in rows if row.strip() and not row.lstrip().startswith("#")]
    stated = [_whole(header.get(key, "")) for key in ("rows", "columns")]
    array = np.array(numbers)
    if None not in stated:
        shape = [size for size in stated if size is not None]
        if shape[0] * shape[1] == array.size:
            return array.reshape(shape)
    if lines and array.size % len(lines) == 0:  # the header was edited: the lines count
        return array.reshape(len(lines), -1)
    return _shaped(name, array, [size or 0 for size in stated], order="C")


def spread(name: str, first: float, last: float, step: float) -> MatValue:
    """The numbers of a range, the last included where a step ends at it.

    Raises
    ------
    ValueError
        The range does not end.
    """
    count = (last - first) / step * (1 + 1e-12) + 1 if step else 0.0
    if not 0.0 <= count <= MOST:
        raise ValueError(f"the range `{name}` has {count:g} numbers")
    return first + step * np.arange(int(count))


def _whole(text: str) -> int | None:
    return int(text) if text.isdigit() else None


def _shaped(name: str, array: MatValue, shape: list[int], *, order: str) -> MatValue:
    assert isinstance(array, np.ndarray)
    if int(np.prod(shape)) != array.size:
        size = "×".join(str(length) for length in shape)
        raise ValueError(f"`{name}` should be {size} but has {array.size} numbers")
    return array.reshape(shape, order="F" if order == "F" else "C")


def _texts(rows: list[str]) -> list[MatValue]:
    """The rows of a character matrix: each line after its length."""
    texts: list[MatValue] = []
    for i, row in enumerate(rows):
        if _header(row)[0] == "length":
            behind = rows[i + 1] if i + 1 < len(rows) else ""
            texts.append("" if _header(behind)[0] == "length" else behind.rstrip())
    return texts
