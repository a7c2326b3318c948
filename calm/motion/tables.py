"""CSV tables over time whose columns are headed by a name and a unit."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from calm.errors import InputError, Problem
from calm.files.times import TimeChoiceError, parse_time
from calm.physics.line import Floats
from calm.units import QuantityError, unit_factor

_MOST_PROBLEMS = 20
_HEADED = re.compile(r"(.*?)\s*[\[(]([^\])]*)[\])]\s*")


def read_table(
    path: Path, dimensions: Sequence[str], example: str
) -> tuple[NDArray[np.datetime64], list[tuple[str, str]], Floats]:
    """A table of times and quantities, each column headed by its name and its unit.

    Parameters
    ----------
    dimensions : what the columns may be, of `calm.units.DIMENSIONS`
    example : of a heading

    Returns
    -------
    (n,) times, rising; of each column its name and what it is; (n, c) values in SI, NaN in gaps.

    Raises
    ------
    InputError
        With every mistake.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            lines = [(i, row) for i, row in enumerate(csv.reader(file), 1) if any(row)]
    except UnicodeDecodeError:
        raise InputError([Problem(str(path), 0, 0, "is not UTF-8 text")]) from None
    except (OSError, csv.Error) as error:
        raise InputError([Problem(str(path), 0, 0, f"cannot be read: {error}")]) from None
    lines = [(i, row) for i, row in lines if not row[0].lstrip().startswith("#")]
    if len(lines) < 2:
        raise InputError([Problem(str(path), 0, 0, "is empty")])
    (number, head), *body = lines
    if head[0].strip().lower() != "time" or len(head) < 2:
        message = f"is not a table over time; its heading should be `time,{example}`"
        raise InputError([Problem(str(path), number, 1, message)])
    problems: list[Problem] = []
    columns, factors = [], []
    for j, text in enumerate(head[1:], 2):
        try:
            label, dimension, factor = _column(text.strip(), dimensions, example)
        except ValueError as error:
            problems.append(Problem(str(path), number, j, str(error)))
        else:
            columns.append((label, dimension))
            factors.append(factor)
    times = np.full(len(body), np.datetime64("NaT"), "M8[ns]")
    values = np.full((len(body), len(head) - 1), np.nan)
    for i, (line, row) in enumerate(body):
        try:
            times[i] = np.datetime64(parse_time(row[0]).replace(tzinfo=None), "ns")
        except TimeChoiceError as error:
            problems.append(Problem(str(path), line, 1, str(error)))
        if len(row) != len(head):
            message = f"has {len(row)} cells under a heading of {len(head)}"
            problems.append(Problem(str(path), line, 1, message))
            continue
        for j, cell in enumerate(row[1:]):
            try:
                values[i, j] = float(cell) if cell.strip() else np.nan
            except ValueError:
                problems.append(Problem(str(path), line, j + 2, f"`{cell[:40]}` is not a number"))
    if problems:
        raise InputError(problems[:_MOST_PROBLEMS])
    order = np.argsort(times, kind="stable")
    return times[order], columns, values[order] * factors


def _column(text: str, dimensions: Sequence[str], example: str) -> tuple[str, str, float]:
    """Name of a column, what it is, and its factor to SI.

    Raises
    ------
    ValueError
        It has no unit, or that of something else.
    """
    headed = _HEADED.fullmatch(text)
    if headed is None:
        raise ValueError(f"`{text}` needs a unit, as in `{example}`")
    for dimension in dimensions:
        try:
            return headed[1], dimension, unit_factor(headed[2].strip(), dimension)
        except QuantityError:
            continue
    raise ValueError(f"`{headed[2]}` is not a unit for it; write it as in `{example}`")
