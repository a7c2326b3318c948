"""Every run of the tests tries the same examples and sees no catalogue but the shipped one."""

import gc
import os
from collections.abc import Iterator
from functools import partial, wraps

import pytest
from hypothesis import settings

from calm.case.memory import Memory
from calm.drop import launch, plan
from calm.quantities import show_in
from calm.solve import net

settings.register_profile("ci", derandomize=True, deadline=None, database=None)
settings.register_profile("explore", deadline=None, max_examples=2000)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "ci"))

# the default of 700 is for less memory: looking for garbage took a third of the time of the builder
gc.set_threshold(50_000, 20, 20)
gc.disable()


def pytest_collection_finish() -> None:
    """What the collection of thousands of tests has made stays, and is never looked through."""
    gc.freeze()
    gc.enable()


@pytest.fixture(scope="session", autouse=True)
def without_the_users_catalogue(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Whoever runs the tests may have a catalogue of their own."""
    os.environ["CALM_CATALOG_DIR"] = str(tmp_path_factory.mktemp("catalogue") / "none")


@pytest.fixture(scope="session", autouse=True)
def solve_compiled() -> None:
    """Compile the solver where LLVM is installed: it gives the same digits, sooner.

    `CALM_COMPILED=never` makes the tests use the interpreted solver.
    """
    os.environ.setdefault("CALM_COMPILED", "always")


@pytest.fixture(scope="session", autouse=True)
def computed_once() -> Iterator[None]:
    """A line under tow, its fall and its rest, and the start of a net, are computed for the first
    test that asks.
    """
    shared = Memory()
    with pytest.MonkeyPatch.context() as patch:
        for where, names in (
            (launch, ("towed", "fall")), (plan, ("towed", "fall", "settle")), (net, ("start_of",)),
        ):  # fmt: skip
            for name in names:
                law = getattr(where, name)
                patch.setattr(where, name, wraps(law)(partial(shared.of, law)))
        yield


@pytest.fixture(autouse=True)
def usual_units() -> Iterator[None]:
    """Units that a command has chosen are those of its process."""
    yield
    show_in({})


@pytest.fixture
def march_as_it_stands(monkeypatch: pytest.MonkeyPatch) -> None:
    """The solver of `calm run`."""
    monkeypatch.setenv("CALM_COMPILED", "never")
