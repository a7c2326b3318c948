"""Import and export of MoorDyn 2 files; import of similar files of MoorDyn 1 and MoorPy."""

from calm.exchange.moordyn.reader import is_moordyn, read_moordyn
from calm.exchange.moordyn.writer import write_moordyn
from calm.exchange.registry import register_format

register_format(
    "moordyn",
    is_moordyn,
    lambda path, _: read_moordyn(path),
    write_moordyn,
    program="MoorDyn or MoorPy",
    writes_nets=True,
    suffixes=(".txt", ".dat"),
)
