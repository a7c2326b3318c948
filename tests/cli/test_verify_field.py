"""`calm verify --field`: a real mooring again."""

import json

import pytest

pytestmark = pytest.mark.thorough


def test_the_hidden_depths_of_a_real_mooring(calm):
    done = calm("verify", "--field", "--json", "-")
    said = json.loads(done.out)
    assert done.code == 0 and said["within"] is True
    assert said["ratio"] <= 0.55 and len(said["held_out"]) == 5
    assert calm("verify", "word", "--field").code == 2
