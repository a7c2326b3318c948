"""Write the columns of results into `docs/reference/python.md` and `docs/reference/batch.md`.

python docs/generate_columns.py            # write them
python docs/generate_columns.py --check    # exit 1 where a page is out of date
"""

import sys
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from calm.batch.profiles import Profiles
from calm.case.columns import FILES, Output, ResultColumn, columns_of
from calm.case.result_tables import ENDS, Clamps, Components, Shape

REFERENCE = Path(__file__).parent / "reference"
_OUTPUTS = {
    Output.JSON: "JSON",
    Output.CSV: "CSV",
    Output.NETCDF: "NetCDF",
    Output.BATCH: "batch",
    Output.MOORING_TABLE | Output.TOW_TABLE | Output.NET_TABLE: "table",
    Output.BUILDER: "builder",
}


def _rows(heads: str, rows: Iterable[tuple[str, ...]]) -> str:
    ruled = "|".join(" --- " for _ in heads.split("|"))
    cells = (f"| {' | '.join(row)} |" for row in rows)
    return "\n".join([f"| {heads} |", f"|{ruled}|", *cells]) + "\n"


def _outputs(column: ResultColumn) -> str:
    found = [name for outputs, name in _OUTPUTS.items() if column.outputs & outputs]
    if column.outputs & FILES == FILES:
        found[:3] = ["files"]
    return ", ".join(found)


def _of_table(columns: Iterable[ResultColumn]) -> str:
    return _rows(
        "column | unit | | appears in",
        ((f"`{one.name}`", one.unit, one.description, _outputs(one)) for one in columns),
    )


def _of_batch() -> str:
    rows: list[tuple[str, ...]] = []
    for dimension, columns in Profiles.columns().items():
        along = ", ".join(f"`{name}`" for name in ("time", dimension) if name)
        rows += ((f"`{one.variable}`", along, one.unit, one.description) for one in columns)
    return _rows("variable | dimensions | unit | ", rows)


def _of_ends() -> str:
    rows = [
        (f"`{end}.{one.name}`", one.unit, one.description)
        for end, record in ENDS.items()
        for one in columns_of(record)
    ]
    return _rows("name | unit | ", rows)


BLOCKS: dict[str, dict[str, Callable[[], str]]] = {
    "python": {
        "components": lambda: _of_table(Components.columns()),
        "clamps": lambda: _of_table(Clamps.columns()),
        "shape": lambda: _of_table(Shape.columns()),
        "ends": _of_ends,
    },
    "batch": {"batch": _of_batch},
}
"""Tables of each page, written between `<!-- columns: NAME -->` and `<!-- columns end -->`."""


def pages() -> Iterator[tuple[Path, str]]:
    """Each page, and its text with current tables."""
    for page, blocks in BLOCKS.items():
        path = REFERENCE / f"{page}.md"
        text = path.read_text(encoding="utf-8")
        for name, block in blocks.items():
            before, begin, rest = text.partition(f"<!-- columns: {name} -->\n")
            _, end, after = rest.partition("<!-- columns end -->\n")
            text = f"{before}{begin}{block()}{end}{after}"
        yield path, text


if __name__ == "__main__":
    for path, text in pages():
        if sys.argv[1:] != ["--check"]:
            path.write_text(text, encoding="utf-8")
        elif path.read_text(encoding="utf-8") != text:
            sys.exit(f"{path} is out of date; run python docs/generate_columns.py")
