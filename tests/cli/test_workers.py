"""Work that another process does."""

import os

import pytest

from calm.cli.progress import begun, mapped


@pytest.mark.parametrize("cores", [1, 2])
def test_what_is_begun_is_handed_over_every_time_it_is_called_for(monkeypatch, cores):
    monkeypatch.setattr(os, "cpu_count", lambda: cores)
    made = begun(divmod, 7, 2)
    assert made() == made() == (3, 1)


@pytest.mark.parametrize(("cores", "here"), [(1, True), (2, False)])
def test_another_process_makes_it_where_there_is_a_core_for_it(monkeypatch, cores, here):
    monkeypatch.setattr(os, "cpu_count", lambda: cores)
    assert (begun(os.getpid)() == os.getpid()) is here


def test_what_fails_there_fails_where_it_is_called_for():
    made = begun(divmod, 7, 0)
    with pytest.raises(ZeroDivisionError):
        made()


@pytest.mark.parametrize(("workers", "meantime"), [(2, ["meanwhile"]), (1, [])])
def test_something_else_is_done_while_other_processes_work(workers, meantime):
    done = []
    tasks = [-3, 1, -4, 1, -5]
    made = mapped(abs, tasks, workers, "tasks", lambda: done.append("meanwhile"))
    assert (made, done) == ([3, 1, 4, 1, 5], meantime)
