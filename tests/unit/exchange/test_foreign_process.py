"""Readers of foreign files end a process of their own, never that of the program."""

import os
import signal
import sys
import time

import numpy as np
import pytest

from calm.errors import InputError
from calm.exchange import foreign_process, mat_file
from calm.exchange.foreign_process import read_apart
from calm.exchange.mat_file import read_variables
from calm.exchange.table import cells
from calm.exchange.table.cells import read_sheets


class Panic(BaseException):
    """Stands for a panic of Rust, which is no `Exception`."""


def crash(*given):
    os.kill(os.getpid(), signal.SIGKILL)


def panic(*given):
    os.write(2, b"thread panicked")
    raise Panic("called `Option::unwrap()` on a `None` value")


def devour(*given):
    return [np.ones(100_000_000) for _ in range(20)]


def sleep(*given):
    time.sleep(60.0)


def test_what_a_reader_finds_is_handed_over(capfd):
    assert read_apart(sorted, [3, 1, 2], reverse=True) == [3, 2, 1]


@pytest.mark.skipif(sys.platform != "linux", reason="signals, and a limit of memory")
@pytest.mark.parametrize(
    ("reader", "message"),
    [
        (crash, "ended with exit code -9"),
        (panic, "called `Option::unwrap()` on a `None` value"),
        (devour, "reading needs more than 0.5 GB"),
        (sleep, "reading takes longer than 0.5 s"),
    ],
)
def test_a_reader_that_fails_is_told(reader, message, tmp_path, monkeypatch, capfd):
    monkeypatch.setattr(foreign_process, "MOST_MEMORY", 500_000_000)
    monkeypatch.setattr(foreign_process, "MOST_SECONDS", 0.5)
    monkeypatch.setattr(mat_file, "_matlab", reader)
    monkeypatch.setattr(cells, "_sheets", reader)
    mat = tmp_path / "design.mat"
    mat.write_bytes(b"MATLAB 5.0 MAT-file" + bytes(200))
    book = tmp_path / "list.xlsx"
    book.write_bytes(b"PK\x03\x04" + bytes(200))
    for path, read in ((mat, lambda path: read_variables(path, ["H"])), (book, read_sheets)):
        if path is book:
            pytest.importorskip("python_calamine", reason="needs the extra `sheets`")
        with pytest.raises(InputError) as error:
            read(path)
        assert message in str(error.value)
    assert capfd.readouterr().err == ""
