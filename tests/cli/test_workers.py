"""Work that another process does."""

import pytest

from calm.cli.progress import mapped


@pytest.mark.parametrize(("workers", "meantime"), [(2, ["meanwhile"]), (1, [])])
def test_something_else_is_done_while_other_processes_work(workers, meantime):
    done = []
    tasks = [-3, 1, -4, 1, -5]
    made = mapped(abs, tasks, workers, "tasks", lambda: done.append("meanwhile"))
    assert (made, done) == ([3, 1, 4, 1, 5], meantime)
