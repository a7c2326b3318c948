"""Import and export of problem files of WHOI Cable."""

from calm.exchange.cbl.reader import is_cbl, read_cbl
from calm.exchange.cbl.writer import write_cbl
from calm.exchange.registry import register_format

register_format("cbl", is_cbl, read_cbl, write_cbl, program="WHOI Cable", suffixes=(".cbl",))
