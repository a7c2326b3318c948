"""Arguments of Python functions, in SI or as texts with a unit."""

import pytest

from calm.errors import UsageError
from calm.files.definition import in_si


def test_an_argument_is_a_number_in_si_or_a_text_with_its_unit():
    assert in_si("ship_speed", 1.5, "speed") == 1.5
    assert in_si("ship_speed", "2 knot", "speed") == pytest.approx(1.02889, rel=1e-5)
    with pytest.raises(UsageError, match="`ship_speed: 2 m`"):
        in_si("ship_speed", "2 m", "speed")
