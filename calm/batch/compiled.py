"""Compiling the kernel."""
from __future__ import annotations
import numba
FLAGS = {"contract", "reassoc", "nsz", "arcp"}
def compiled(function):
    return numba.njit(function, nogil=True, cache=False, error_model="numpy", fastmath=FLAGS)


def compilable(function):
    return numba.extending.register_jitable(error_model="numpy", fastmath=FLAGS)(function)
