from math import inf, sqrt

import pytest

from calm.solve.least_change import LeastChange


def test_a_root_is_found_on_the_side_where_the_condition_holds():
    search = LeastChange(lambda x: 2.0 - x * x, 0.0, 100.0)
    found = search.find(0.5)
    # rounded to six digits, away from the start
    assert sqrt(2.0) <= found <= sqrt(2.0) + 1e-5
    assert search.at(found) <= 0.0
    assert search.steady


def test_downwards_too():
    found = LeastChange(lambda x: x * x - 2.0, 0.0, 100.0).find(50.0)
    assert sqrt(2.0) - 1e-5 <= found <= sqrt(2.0)


def test_nothing_left_is_an_answer_too():
    assert LeastChange(lambda x: x, 0.0, 100.0).find(50.0) == 0.0


def test_an_exact_root_is_not_rounded():
    found = LeastChange(lambda x: x**3 - 5.0, 0.0, 100.0, exact=True, small=1e-9).find(50.0)
    assert found == pytest.approx(5.0 ** (1 / 3), abs=1e-9)


def test_nothing_changes_where_the_condition_holds():
    search = LeastChange(lambda x: x - 10.0, 0.0, 100.0)
    assert search.find(7.0) == 7.0
    assert len(search.tried) == 1


def test_the_nearer_of_two_answers_is_taken():
    search = LeastChange(lambda x: 4.0 - (x - 10.0) ** 2, 0.0, 100.0)
    assert search.find(10.5) == pytest.approx(12.0, abs=1e-4)  # not 8
    assert search.find(9.5) == pytest.approx(8.0, abs=1e-4)
    assert not search.steady


def test_a_dip_between_two_steps_is_found():
    search = LeastChange(lambda x: abs(x - 37.1) - 0.5, 0.0, 100.0)
    assert search.find(0.0) == pytest.approx(36.6, abs=1e-4)


def test_answers_that_begin_only_later():
    # none below 5, where the condition fails; it holds from 9 on
    search = LeastChange(lambda x: 9.0 - x if x > 5.0 else None, 0.0, 100.0)
    assert search.find(1.0) == pytest.approx(9.0, abs=1e-4)


def test_a_condition_that_holds_as_soon_as_there_is_an_answer():
    search = LeastChange(lambda x: -1.0 if x > 5.0 else None, 0.0, 100.0)
    # to 1e-7 of the last step, some 6 wide
    assert search.find(1.0) == pytest.approx(5.0, abs=1e-6)


def test_the_least_excess_before_answers_end():
    search = LeastChange(lambda x: 20.0 - x if x <= 12.3 else None, 0.0, 100.0)
    assert search.find(1.0) is None
    assert search.least == pytest.approx(12.3, abs=1e-4)
    assert search.tried[search.neighbours(search.least)[1]] == inf


def test_no_answer_at_all():
    search = LeastChange(lambda x: None, 0.0, 100.0)
    assert search.find(1.0) is None
    assert search.least is None


@pytest.mark.parametrize(
    ("limit", "start", "expected"), [(17.0, 3, 17), (17.2, 3, 18), (2.5, 1, 3)]
)
def test_whole_numbers_upwards(limit, start, expected):
    search = LeastChange(lambda n: limit - n, 1.0, 1000.0, whole=True)
    assert search.find(start) == expected
    assert all(n == int(n) for n in search.tried)


def test_whole_numbers_downwards_and_to_the_end():
    assert LeastChange(lambda n: n - 7.5, 1.0, 1000.0, whole=True).find(40.0) == 7
    assert LeastChange(lambda n: n - 1.0, 1.0, 1000.0, whole=True).find(40.0) == 1
    assert LeastChange(lambda n: 1000.0 - n, 1.0, 1000.0, whole=True).find(40.0) == 1000


def test_a_start_outside_the_range_is_brought_into_it():
    assert LeastChange(lambda x: x - 10.0, 0.0, 5.0).find(50.0) == 5.0
