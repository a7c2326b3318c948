"""Friction and strumming as files write them: what they are read as, and every mistake in them."""

from collections.abc import Callable
from typing import get_args

import pytest

from calm.files import MooringFile, Strumming, StrummingFactor
from calm.files.strumming_keys import (
    AmplitudeModel,
    AmplitudeName,
    BourgetMarichalKeys,
    ConstantCn,
)
from calm.physics.drag import Friction
from calm.physics.strumming import AMPLIFICATIONS

from .conftest import GOOD, TOW, Place

Read = Callable[..., MooringFile]
Mistakes = Callable[..., list[Place]]


@pytest.mark.parametrize("law", [law.value for law in Friction])
def test_friction(read: Read, law: str) -> None:
    assert read(GOOD + f"solver: {{friction: {law}}}\n").solver.friction == law
    assert read(GOOD).solver.friction == "berteaux"


@pytest.mark.parametrize(
    ("written", "strumming"),
    [
        ("none", None),
        ("{factor: 1.5}", StrummingFactor(factor=1.5)),
        ("{factor: 130 %}", StrummingFactor(factor=1.3)),
        ("{cn: 1.85}", ConstantCn(cn=1.85)),
        ("vandiver", AmplitudeModel("vandiver")),
        ("blevins", AmplitudeModel("blevins")),
        ("skop-griffin", AmplitudeModel("skop-griffin")),
    ],
)
@pytest.mark.parametrize("file", [GOOD, TOW])
def test_strumming(read: Read, file: str, written: str, strumming: Strumming) -> None:
    assert read(file + f"solver: {{strumming: {written}}}\n").solver.strumming == strumming


def test_strumming_is_off_by_default(read: Read) -> None:
    assert read(GOOD).solver.strumming is None


@pytest.mark.parametrize("written", ["bourget-marichal", "{model: bourget-marichal}"])
def test_bourget_and_marichal(read: Read, written: str) -> None:
    strumming = read(TOW + f"solver: {{strumming: {written}}}\n").solver.strumming
    assert isinstance(strumming, BourgetMarichalKeys)
    amplitude = (strumming.a1, strumming.b1, strumming.c1)
    assert amplitude == (1.60185, -0.0231225, 1.20885e-4)
    assert (strumming.c0, strumming.strouhal) == (1.2, 0.166)


def test_bourget_and_marichal_with_other_figures(read: Read) -> None:
    figures = "{model: bourget-marichal, a1: 2, b1: -0.03, c1: 1e-4, c0: 1.1, strouhal: 0.2}"
    strumming = read(TOW + f"solver: {{strumming: {figures}}}\n").solver.strumming
    assert strumming == BourgetMarichalKeys(a1=2, b1=-0.03, c1=1e-4, c0=1.1, strouhal=0.2)


def test_files_and_physics_have_the_same_amplitude_models() -> None:
    assert set(get_args(AmplitudeName)) == set(AMPLIFICATIONS)


NAMES = "none, bourget-marichal, vandiver, blevins, skop-griffin"


@pytest.mark.parametrize(
    ("written", "column", "message"),
    [
        (
            "vandivr",
            21,
            f"`strumming: vandivr` must be one of {NAMES}; did you mean `strumming: vandiver`?",
        ),
        (
            "1.5",
            21,
            f"`strumming: 1.5` must be one of {NAMES}; did you mean `strumming: {{factor: 1.5}}`?",
        ),
        ("-1.5", 21, f"`strumming: -1.5` must be one of {NAMES}"),
        ("[1.5]", 21, f"`strumming: …` must be one of {NAMES}"),
        ("", 10, "`strumming` has no value"),
        ("{}", 21, "`strumming` needs `factor`, `cn`, or `model: bourget-marichal`"),
        ("{a1: 1.6}", 21, "`strumming` needs `factor`, `cn`, or `model: bourget-marichal`"),
        (
            "{factor: 1.5, cn: 2}",
            21,
            "`strumming` has `factor` and `cn`, which exclude each other",
        ),
        ("{factor: 0}", 30, "`factor: 0` must be at least 1"),
        ("{factor: -1}", 30, "`factor: -1` must be at least 1"),
        ("{factor: 1.5 m}", 30, "`factor: 1.5 m` is a length; a plain number is needed"),
        ("{factor: }", 22, "`factor` has no value"),
        ("{facter: 1.5}", 22, "unknown key `facter`; did you mean `factor`?"),
        ("{cn: -1}", 26, "`cn: -1` must be at least 0"),
        ("{cn: 1,85}", 28, "`85` is not a key; is there a decimal comma? Write 0.8, not 0,8"),
        ("{factor: 1.5, a1: 2}", 35, "unknown key `a1`; allowed: factor"),
        (
            "{model: vandiver}",
            21,
            "`vandiver` takes no values; write `strumming: vandiver`",
        ),
        (
            "{model: bourget}",
            29,
            "`model: bourget` must be one of bourget-marichal; "
            "did you mean `model: bourget-marichal`?",
        ),
        ("{model: bourget-marichal, c0: 0}", 51, "`c0: 0` must be more than 0"),
        ("{model: bourget-marichal, c0: 3.1}", 51, "`c0: 3.1` must be at most 3"),
        ("{model: bourget-marichal, strouhal: 0}", 57, "`strouhal: 0` must be more than 0"),
        (
            "{model: bourget-marichal, struhal: 0.2}",
            47,
            "unknown key `struhal`; did you mean `strouhal`?",
        ),
    ],
)
def test_strumming_mistakes(mistakes: Mistakes, written: str, column: int, message: str) -> None:
    line = TOW.count("\n") + 1
    found = mistakes(TOW + f"solver: {{strumming: {written}}}\n")
    assert found == [(line, column, message)]


KNOWN_TO_THE_SCHEMA = [
    "vandivr", "1.5", "[1.5]", "", "{}", "{a1: 1.6}", "{factor: 1.5, cn: 2}", "{facter: 1.5}",
    "{factor: 1.5 m}", "{factor: 1.5, a1: 2}", "{model: vandiver}", "{model: bourget}",
]  # fmt: skip


@pytest.mark.parametrize("written", ["bourget-marichal", "{model: bourget-marichal, c0: 1.1}"])
def test_bourget_and_marichal_moored(mistakes: Mistakes, written: str) -> None:
    assert mistakes(GOOD + f"solver: {{strumming: {written}}}\n") == [
        (
            14,
            21,
            "`bourget-marichal` is only for towed cables; "
            "for a mooring, use one of vandiver, blevins, skop-griffin",
        )
    ]
