"""The environment section: what it may say of sea water, air and wind, and how it goes wrong."""

from collections.abc import Callable
from pathlib import Path

import pytest
from jsonschema.protocols import Validator

from calm.errors import Problem
from calm.files import DepthTable, Environment, MooringFile, SeaWater
from calm.files.environment import read_environment
from calm.files.yaml_document import SourceMapping, read_document
from tests.core_yaml import loaded

from .conftest import GOOD, Place

Read = Callable[..., MooringFile]
Towed = Callable[[str], tuple[Environment | None, list[str]]]
Mistakes = Callable[..., list[Place]]


def with_keys(*lines: str) -> str:
    """The good mooring with more lines in its environment, from line 4 on."""
    keys = "".join(f"  {line}\n" for line in lines)
    return GOOD.replace("  depth: 1100 m\n", "  depth: 1100 m\n" + keys)


@pytest.fixture
def towed(tmp_path: Path) -> Towed:
    """Reads the environment of a tow: itself, and the messages of its mistakes."""

    def read(text: str) -> tuple[Environment | None, list[str]]:
        path = tmp_path / "environment.yaml"
        path.write_text(text)
        document = read_document(path)
        problems: list[Problem] = []
        section = SourceMapping.of(document, problems)
        environment = read_environment(section, None, [], towed=True)
        return environment, [problem.message for problem in problems]

    return read


TEN_AND_35 = SeaWater(DepthTable((0.0,), (10.0,)), DepthTable((0.0,), (35.0,)))


@pytest.mark.parametrize(
    ("lines", "sea"),
    [
        (["density: {temperature: 10 degC, salinity: 35}"], TEN_AND_35),
        (["density: {temperature: 10 °C, salinity: 35 PSU}"], TEN_AND_35),
        (["density: {temperature: 10 degC, salinity: 35.16504 g/kg}"], TEN_AND_35),
        (
            ["density: {columns: [depth m, temperature degC, salinity], rows: [[0, 10, 35]]}"],
            TEN_AND_35,
        ),
        (
            [
                "density:",
                "  temperature: {columns: [depth m, temperature degC], rows: [[0, 18], [990, 4]]}",
                "  salinity: 34",
            ],
            SeaWater(DepthTable((0.0, 990.0), (18.0, 4.0)), DepthTable((0.0,), (34.0,))),
        ),
        (
            [
                "density:",
                "  temperature: 4 degC",
                "  salinity: {columns: [depth m, salinity], rows: [[5, 30], [1010, 34]]}",
            ],
            SeaWater(DepthTable((0.0,), (4.0,)), DepthTable((5.0, 1010.0), (30.0, 34.0))),
        ),
    ],
    ids=["constants", "other units", "mass fraction", "one table", "one of two", "the other"],
)
def test_sea_water(read: Read, schema: Validator, lines: list[str], sea: SeaWater) -> None:
    text = with_keys(*lines)
    mooring = read(text)
    assert mooring.environment.density == sea
    [notice] = mooring.notices
    assert notice.startswith("Without a `position`, the density is computed")
    schema.validate(loaded(text))


def test_sea_water_at_a_position(read: Read) -> None:
    place = "position: {latitude: 48.3 deg, longitude: -5.2 deg}\n"
    mooring = read(place + with_keys("density: {temperature: 10 degC, salinity: 35}"))
    assert mooring.notices == ()
    assert mooring.environment.position == mooring.position
    assert mooring.environment.density == TEN_AND_35


STRATIFIED = "density: {columns: [depth m, density kg/m^3], rows: [[0, 1027], [1000, %s]]}"
SEA = "density: {columns: [depth m, temperature degC, salinity], rows: %s}"


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("density: {temperature: 10 degC, salinity: 0.035}", ["not 0.035"]),
        (SEA % "[[0, 14, 0.0351], [1100, 4, 0.0349]]", ["not 0.035"]),
        ("density: {temperature: 35 degC, salinity: 10}", ["exchanged?"]),
        (SEA % "[[0, 35.1, 4], [1100, 34.9, 14]]", ["exchanged?"]),
        (SEA % "[[0, 4, 35], [1100, 14, 35]]", ["such a stratification is unstable"]),
        (SEA % "[[0, 14, 35], [50, 12, 35.1]]", ["The temperature has no", "The salinity has no"]),
        (STRATIFIED.replace("1000", "50") % "1028", ["The density has no level below 50.0 m"]),
        (STRATIFIED % "1028", []),
        (SEA % "[[0, 31, 39], [200, 15, 36], [1100, 13.5, 38.5]]", []),
        (SEA % "[[0, 2, 6], [1100, 4, 6.5]]", []),
        ("density: {temperature: 18 degC, salinity: 0.2}", []),
    ],
)
def test_what_is_odd_about_the_water_is_said(read: Read, line: str, said: list[str]) -> None:
    place = "position: {latitude: 48.3 deg, longitude: -5.2 deg}\n"
    notices = read(place + with_keys(line)).notices
    assert len(notices) == len(said)
    for words, notice in zip(said, notices, strict=True):
        assert words in notice


def test_a_drift_is_off_unless_asked_for(read: Read) -> None:
    wind = read(with_keys("wind: {speed: 10 m/s, toward: 0 deg}")).environment.wind
    assert wind is not None
    assert (wind.surface_drift, wind.drift_depth) == (0.0, None)
    drift = "surface_drift: 2 %, drift_depth: 50 m"
    wind = read(with_keys(f"wind: {{speed: 10 m/s, toward: 0 deg, {drift}}}")).environment.wind
    assert wind is not None
    assert (wind.surface_drift, wind.drift_depth) == (0.02, 50.0)


NEEDS = "a density needs `density`, or `temperature` and `salinity`; the columns are "
WIND = "wind: {speed: 9 m/s, toward: 0, "


@pytest.mark.parametrize(
    ("lines", "mistake"),
    [
        (["density: {temperature: 10 degC}"], (4, 12, "`salinity` is missing")),
        (["density: {salinity: 35}"], (4, 12, "`temperature` is missing")),
        (
            ["density: {temprature: 10 degC, salinity: 35}"],
            (4, 13, "unknown key `temprature`; did you mean `temperature`?"),
        ),
        (
            ["density: {temperature: -10 degC, salinity: 35}"],
            (4, 26, "`temperature: -10 degC` must be at least -6 degC"),
        ),
        (
            ["density: {temperature: 283 K, salinity: 35}"],
            (4, 26, "`temperature: 283 K` is not a temperature in degC"),
        ),
        (
            ["density: {temperature: 10, salinity: 35}"],
            (4, 26, "`temperature: 10` needs a unit; did you mean `temperature: 10 degC`?"),
        ),
        (
            ["density: {temperature: 10 degC, salinity: -1}"],
            (4, 45, "`salinity: -1` must be at least 0"),
        ),
        (
            ["density: {temperature: 10 degC, salinity: 350}"],
            (4, 45, "`salinity: 350` must be at most 42"),
        ),
        (
            ["density: {temperature: 10 degC, salinity: 35 kg/m^3}"],
            (
                4,
                45,
                "`salinity: 35 kg/m^3` is a density; "
                "a salinity (practical, such as 35, or in g/kg) is needed",
            ),
        ),
        (
            ["density: {temperature: 10 degC, salinity: }"],
            (4, 35, "`salinity` has no value"),
        ),
        (
            ["density: {columns: [depth m, temperature degC], rows: [[0, 10]]}"],
            (4, 22, NEEDS + "depth, temperature"),
        ),
        (
            ["density: {columns: [depth m, temprature degC, salinity], rows: [[0, 10, 35]]}"],
            (4, 32, "no column is called `temprature`; did you mean `temperature`?"),
        ),
        (
            ["density: {columns: [depth m, temperature degC, salinity], rows: [[0, 50, 35]]}"],
            (4, 72, "`temperature: 50` must be at most 40 degC"),
        ),
        (
            [
                "density:",
                "  salinity: 35",
                "  temperature: {columns: [depth m, salinity], rows: [[0, 10]]}",
            ],
            (6, 38, "no column is called `salinity`; allowed: depth, temperature"),
        ),
        (
            [
                "density:",
                "  salinity: 35",
                "  temperature: {columns: [depth m, temperature degC], rows: [[9, 10], [3, 9]]}",
            ],
            (6, 74, "depth 3 m comes after 9 m; depths must increase"),
        ),
        (["fluid: air"], (4, 10, "`fluid: air` is only for tows; a mooring must be in water")),
        (
            ["fluid: ari"],
            (4, 10, "`fluid: ari` must be one of water"),
        ),
        (
            [WIND + "surface_drift: 2}"],
            (4, 50, "`surface_drift: 2` must be at most 0.1"),
        ),
        (
            [WIND + "surface_drift: -1 %}"],
            (4, 50, "`surface_drift: -1 %` must be at least 0"),
        ),
        (
            [WIND + "drift_depth: 50 m}"],
            (4, 9, "`drift_depth` needs `surface_drift`, a share of the wind's speed"),
        ),
        (
            [WIND + "surface_drift: 2 %, drift_depth: 0}"],
            (4, 68, "`drift_depth: 0` must be more than 0 m"),
        ),
    ],
)
def test_one_mistake(mistakes: Mistakes, lines: list[str], mistake: Place) -> None:
    assert mistakes(with_keys(*lines)) == [mistake]


def test_all_mistakes_of_sea_water_at_once(mistakes: Mistakes) -> None:
    text = with_keys(
        "density:",
        "  temperature: {columns: [depth m, temperature degC], rows: [[0, -10], [0, 9]]}",
        "  salinity: -3",
        "gravity: 9.81",
    )
    assert mistakes(text) == [
        (5, 68, "`temperature: -10` must be at least -6 degC"),
        (5, 75, "depth 0 m repeats 0 m; depths must increase"),
        (6, 15, "`salinity: -3` must be at least 0"),
        (7, 12, "`gravity: 9.81` needs a unit; did you mean `gravity: 9.81 m/s^2`?"),
    ]


def test_mistakes_of_a_variant_are_told_where_they_are(mistakes: Mistakes) -> None:
    text = GOOD + "environments: {summer: {density: {temperature: 20 degC}}}\n"
    assert mistakes(text) == [(14, 34, "`salinity` is missing")]


def test_a_tow_needs_no_depth(towed: Towed) -> None:
    environment, problems = towed("gravity: 9.81 m/s^2\n")
    assert problems == []
    assert environment is not None
    assert (environment.fluid, environment.depth, environment.density) == ("water", None, 1025.0)


def test_a_tow_may_be_in_air(towed: Towed) -> None:
    environment, _ = towed("fluid: air\n")
    assert environment is not None
    assert (environment.fluid, environment.density) == ("air", 1.225)
    thin, _ = towed("{fluid: air, density: 0.9 kg/m^3}\n")
    assert thin is not None
    assert thin.density == 0.9


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "{fluid: air, density: {temperature: 10 degC, salinity: 35}}",
            "temperature and salinity are for sea water; remove them for a tow in air",
        ),
        (
            "{fluid: air, wind: {speed: 5 m/s, toward: 0}}",
            "a tow in air must not have a `wind`; set its wind as the `current`",
        ),
        (
            "wind: {speed: 5 m/s, toward: 0, surface_drift: 2 %}",
            "`surface_drift` needs `drift_depth`, as `depth` is not given",
        ),
        ("depth:", "`depth` has no value"),
        ("fluid: ari", "`fluid: ari` must be one of water, air; did you mean `fluid: air`?"),
    ],
)
def test_mistakes_of_a_tow(towed: Towed, text: str, message: str) -> None:
    assert towed(text + "\n") == (None, [message])


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("depth_range: 1104 m", "must be two depths, at low and at high water: [98 m, 104 m]"),
        ("depth_range: [1098 m, 1100 m, 1104 m]", "must be two depths"),
        (
            "depth_range: [1098, 1104 m]",
            "`depth_range: 1098` needs a unit; did you mean `depth_range: 1098 m`?",
        ),
        ("depth_range: [1104 m, 1098 m]", "with `depth`, 1100 m, between them"),
        ("depth_range: [98 m, 104 m]", "with `depth`, 1100 m, between them"),
        ("fouling: {depth: 50 m}", "`thickness` is missing"),
        ("fouling: {depth: 50 m, thickness: 20}", "did you mean `thickness: 20 mm`?"),
        ("fouling: {depth: 50 m, thickness: 0 mm}", "must be more than 0"),
    ],
)
def test_mistakes_of_tide_and_growth(mistakes: Mistakes, line: str, message: str) -> None:
    ((_, _, found),) = mistakes(with_keys(line))
    assert message in found


def test_tide_and_growth(read: Read) -> None:
    file = read(
        with_keys("depth_range: [1098 m, 1104 m]", "fouling: {depth: 50 m, thickness: 2 cm}")
    )
    assert file.environment.depth_range == (1098.0, 1104.0)
    assert file.environment.fouling is not None
    assert (file.environment.fouling.depth, file.environment.fouling.thickness) == (50.0, 0.02)


@pytest.mark.parametrize(("below", "warned"), [("1026.95", False), ("1026.8", True)])
def test_density_that_falls_with_depth_is_a_warning(
    read: Callable[..., MooringFile], below: str, warned: bool
) -> None:
    notices = read(with_keys(STRATIFIED % below)).notices
    assert [f"falls from 1027 kg/m^3 at 0 m to {below} kg/m^3" in one for one in notices] == (
        [True] if warned else []
    )


@pytest.mark.parametrize(
    ("lines", "mistake"),
    [
        (["density: 90 kg/m^3"], (4, 12, "`density: 90 kg/m^3` must be at least 900 kg/m^3")),
        ([STRATIFIED % "1400"], (4, 74, "`density: 1400` must be at most 1350 kg/m^3")),
        (["maximum_speed: 0 m/s"], (4, 18, "`maximum_speed: 0 m/s` must be more than 0 m/s")),
        (
            ["waves: {significant_height: 4 mm, peak_period: 9 s}"],
            (4, 31, "`significant_height: 4 mm` must be at least 0.05 m"),
        ),
        (
            ["fouling: {depth: 50 m, thickness: 20 m}"],
            (4, 37, "`thickness: 20 m` must be at most 1 m"),
        ),
        (
            ["maximum_speed: 0.5 m/s"],
            (
                8,
                13,
                "0.8 m/s is faster than `maximum_speed`, 0.5 m/s; is it a fill value, "
                "or in another unit? If it is correct, raise `maximum_speed` of the environment",
            ),
        ),
        (
            ["wind: {speed: 9 m/s, toward: 400 deg}"],
            (4, 32, "`toward: 400 deg` must be at most 360 deg"),
        ),
    ],
)
def test_figures_that_no_sea_has(mistakes: Mistakes, lines: list[str], mistake: Place) -> None:
    assert mistakes(with_keys(*lines)) == [mistake]


def test_no_sea_is_so_deep(mistakes: Mistakes) -> None:
    [mistake] = mistakes(GOOD.replace("depth: 1100 m", "depth: 11001 m"))
    assert mistake == (3, 10, "`depth: 11001 m` must be at most 11000 m")


def test_towing_and_air_have_no_greatest_speed(towed: Towed) -> None:
    environment, problems = towed("current: {speed: 9 m/s, toward: 90 deg}\n")
    assert (problems, environment is not None) == ([], True)
    _, problems = towed("fluid: air\ndensity: 1.2 kg/m^3\nmaximum_speed: 5 m/s\n")
    assert problems[0].startswith("unknown key `maximum_speed`")
