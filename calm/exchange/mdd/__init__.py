"""Read and write files of Mooring Design & Dynamics: matrices of elements in a `.mat` file."""

from calm.exchange.mat_file import is_mat
from calm.exchange.mdd.reader import read_mdd
from calm.exchange.mdd.writer import write_mdd
from calm.exchange.registry import register_format

register_format(
    "mdd",
    is_mat,
    lambda path, _: read_mdd(path),
    write_mdd,
    program="Mooring Design & Dynamics",
    suffixes=(".mat",),
)
