"""Every run of the tests tries the same examples and sees no catalogue but the shipped one."""

import os
from collections.abc import Iterator

import pytest
from hypothesis import settings

from calm.physics import pace

settings.register_profile("ci", derandomize=True, deadline=None, database=None)
settings.register_profile("explore", deadline=None, max_examples=2000)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "ci"))


@pytest.fixture(scope="session", autouse=True)
def without_the_users_catalogue(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Whoever runs the tests may have a catalogue of their own."""
    os.environ["CALM_CATALOG_DIR"] = str(tmp_path_factory.mktemp("catalogue") / "none")


@pytest.fixture(scope="session", autouse=True)
def march_compiled() -> None:
    """The march compiled, where numba is there: the same digits, sooner.

    `CALM_COMPILED=never` has the tests march as the laws stand.
    """
    pace.expect(pace.COLD)


@pytest.fixture(autouse=True)
def march_as_before() -> Iterator[None]:
    """A test that marches otherwise leaves the march as it was."""
    fast = pace.is_fast()
    yield
    pace.march_fast(fast)


@pytest.fixture
def march_as_it_stands() -> None:
    """The march of `calm run`."""
    pace.march_fast(False)
