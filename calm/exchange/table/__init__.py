"""Import of a list of pieces from CSV or a workbook (`table`), and export to CSV (`csv`)."""

from calm.exchange.registry import register_format
from calm.exchange.table.cells import is_table
from calm.exchange.table.reader import read_list
from calm.exchange.table.writer import write_list

register_format(
    "table", is_table, read_list, program="a list in CSV or a spreadsheet", takes_elements=True
)
register_format("csv", write=write_list, suffixes=(".csv",))
