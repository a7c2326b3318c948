"""What a good mooring file resolves to."""

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from calm.errors import InputError
from calm.files import Anchor, Cable, Cylinder, MooringFile, Sphere, read_mooring

from .conftest import GOOD, Place

Read = Callable[..., MooringFile]
Mistakes = Callable[..., list[Place]]

LINE = GOOD[: GOOD.index("line:")] + "line:\n"
ANCHOR = "  - {use: deadweight}\n"


def labels(mooring: MooringFile) -> list[str]:
    return [piece.label for piece in mooring.pieces]


def test_a_whole_file(read: Read) -> None:
    mooring = read(
        GOOD.replace(
            "1100 m", "1100 m\n  gravity: 9.81 m/s^2\n  wind: {speed: 12 m/s, toward: 9 deg}"
        )
        + "description: free text\n"
        + "position: {latitude: 48.3 deg, longitude: -5.2 deg}\n"
        + "solver: {angle_step: 0.5 deg, tolerance: 1e-6, buoy_drag: full}\n"
        + "checks: {safety_factor: {steel: 2.5}, minimum_tension: {rope: 20 kgf}}\n"
    )
    assert (mooring.name, mooring.description) == ("Iroise", "free text")
    assert mooring.position is not None
    assert (mooring.position.latitude, mooring.position.longitude) == (48.3, -5.2)
    assert mooring.solver.angle_step == math.radians(0.5)
    assert (mooring.solver.tolerance, mooring.solver.buoy_drag) == (1e-6, "full")
    assert mooring.checks.safety_factor.steel == 2.5
    assert mooring.checks.safety_factor.synthetic == 5.0
    assert mooring.checks.minimum_tension.rope == pytest.approx(196.133, rel=1e-15)
    assert mooring.checks.minimum_tension.wire == 500.0
    environment = mooring.environment
    assert (environment.name, environment.depth, environment.density) == (None, 1100.0, 1025.0)
    assert environment.gravity == 9.81
    assert environment.wind is not None
    assert (environment.wind.speed, environment.wind.toward) == (12.0, 9.0)
    assert mooring.notices == ()


def test_the_pieces(read: Read) -> None:
    top, rope, plate, anchor = read(GOOD).pieces
    assert [piece.index for piece in (top, rope, plate, anchor)] == [0, 1, 2, 3]
    assert (top.use, top.label, top.line, top.column) == ("ball", "top float", 10, 5)
    assert isinstance(top.component, Sphere)
    assert (top.length, top.component.length, top.component.cx) == (1.25, 1.25, None)
    assert isinstance(rope.component, Cable)
    assert (rope.length, rope.fit_top_depth) == (480.0, None)
    [clamp] = rope.clamps
    assert (clamp.use, clamp.label, clamp.at) == ("meter", "meter", 20.0)
    assert isinstance(clamp.component, Cylinder)
    assert plate.length == 0.4
    assert isinstance(anchor.component, Anchor)
    assert anchor.length == 0.4


def test_defaults(read: Read) -> None:
    mooring = read(
        "environment: {depth: 50 m}\n" + LINE[LINE.index("line:") :] + "  - {use: ball}\n" + ANCHOR
    )
    assert mooring.name == "mooring"
    assert mooring.position is None
    assert mooring.solver.angle_step == math.radians(1)
    assert (mooring.solver.tolerance, mooring.solver.buoy_drag) == (1e-7, "immersed")
    assert mooring.checks.anchor_factor == 1.5
    assert mooring.checks.maximum_knockdown is None
    assert mooring.environment.density == 1025.0
    current = mooring.environment.current
    assert (current.depth, current.u, current.v, current.w) == ((0.0,), (0.0,), (0.0,), (0.0,))


def test_sections_with_nothing_in_them(read: Read) -> None:
    text = GOOD + "components:\nenvironments:\nsolver:\nchecks:\nposition:\ndescription:\n"
    assert read(text).solver.tolerance == 1e-7


def test_repeats_are_numbered_down_the_line(read: Read) -> None:
    mooring = read(
        LINE
        + "  - {use: ball}\n"
        + "  - {use: meter, count: 2}\n"
        + "  - {use: rope-12, length: 9 m, count: 2, "
        + "clamps: [{use: plate, at: 1 m}, {use: meter, at: 9 m}]}\n"
        + "  - {use: plate, label: last}\n"
        + ANCHOR
    )
    assert labels(mooring) == [
        "ball",
        "meter 1",
        "meter 2",
        "rope-12 1",
        "rope-12 2",
        "last",
        "deadweight",
    ]
    clamps = [clamp.label for piece in mooring.pieces for clamp in piece.clamps]
    assert clamps == ["plate 1", "meter 3", "plate 2", "meter 4"]


def test_assemblies_are_expanded(read: Read) -> None:
    mooring = read(
        LINE
        + "  - {use: ball}\n"
        + "  - {use: pair, count: 2}\n"
        + "  - {use: frame, label: lower}\n"
        + ANCHOR
        + "components:\n"
        + "  frame: {kind: assembly, parts: [{use: pair}, {use: rope-12, length: 2 m, count: 2}]}\n"
    )
    assert labels(mooring) == [
        "ball",
        "upper 1",
        "meter 1",
        "upper 2",
        "meter 2",
        "lower upper",
        "lower meter",
        "lower rope-12 1",
        "lower rope-12 2",
        "deadweight",
    ]
    assert [piece.line for piece in mooring.pieces] == [10, 11, 11, 11, 11, 12, 12, 12, 12, 13]
    at = [(p.place.item, p.place.repeat, p.place.part) for p in mooring.pieces]
    pairs = [(1, 0, 0), (1, 0, 1), (1, 1, 0), (1, 1, 1)]
    assert at == [(0, 0, -1), *pairs, *((2, 0, part) for part in range(4)), (3, 0, -1)]


def test_every_part_of_the_line_has_a_place_of_its_own(read: Read) -> None:
    hung = "clamps: [{use: meter, at: 1 m}, {use: meter, at: 2 m}]"
    pack = f"  pack: {{kind: assembly, parts: [{{use: rope-12, length: 3 m, {hung}}}]}}\n"
    rope = f"  - {{use: rope-12, length: 9 m, count: 2, {hung}}}\n"
    text = f"{LINE}  - {{use: ball}}\n{rope}  - {{use: pack}}\n{ANCHOR}components:\n{pack}"
    pieces = read(text).pieces
    places = [part.place for piece in pieces for part in (piece, *piece.clamps)]
    assert len(set(places)) == len(places) == 11
    first, second = pieces[2].clamps
    assert (first.place.item, first.place.repeat, first.place.clamp) == (1, 1, 0)
    assert second.place > first.place > pieces[2].place and second.place.is_clamp
    rows = [place.row for place in places]
    assert [(row.item, row.clamp) for row in rows] == [
        (0, -1), (1, -1), (1, 0), (1, 1), (1, -1), (1, 0), (1, 1),
        (2, -1), (2, -1), (2, -1), (3, -1),
    ]  # fmt: skip


def test_a_piece_cut_to_fit(read: Read) -> None:
    mooring = read(GOOD.replace("length: 480 m", "length: fit, top_depth: 105 m"))
    rope = mooring.pieces[1]
    assert (rope.length, rope.fit_top_depth) == (None, 105.0)
    assert rope.clamps[0].at == 20.0


def test_both_ends_of_a_piece_take_clamps(read: Read) -> None:
    ends = "[{use: meter, at: 0}, {use: meter, at: 480 m}]"
    mooring = read(GOOD.replace("[{use: meter, at: 20 m}]", ends))
    assert [clamp.at for clamp in mooring.pieces[1].clamps] == [0.0, 480.0]


def test_overrides_are_for_that_piece_alone(read: Read) -> None:
    mooring = read(
        LINE
        + "  - {use: ball, cx: 0.9, length: 2 m}\n"
        + "  - {use: ball}\n"
        + "  - {use: rope-12, length: 9 m, finish: rough, clamps: [{use: meter, at: 0, cn: 1}]}\n"
        + ANCHOR
    )
    changed, plain, rope, _ = mooring.pieces
    assert isinstance(changed.component, Sphere)
    assert (changed.component.cx, changed.length) == (0.9, 2.0)
    assert isinstance(plain.component, Sphere)
    assert (plain.component.cx, plain.length) == (None, 1.25)
    assert isinstance(rope.component, Cable)
    assert rope.component.finish == "rough"
    assert isinstance(rope.clamps[0].component, Cylinder)
    assert rope.clamps[0].component.cn == 1.0


def test_an_outline_is_used_with_the_figures_that_it_lacks(read: Read, mistakes: Mistakes) -> None:
    ends = "[{use: meter, at: 0, label: up}, {use: meter, at: 480 m, label: down}, PROFILER]"
    text = GOOD.replace("[{use: meter, at: 20 m}]", ends)
    rider = "{use: mmp, between: [up, down]}"
    [(row, _, said)] = mistakes(text.replace("PROFILER", rider))
    assert (row, said[:48]) == (11, "no source gives `length`, `drag_area` of `mmp`: ")
    assert said.endswith("(the rest is from: a manual)")
    [(_, _, said)] = mistakes(text.replace("PROFILER", rider[:-1] + ", length: 1.3 m}"))
    assert said.startswith("no source gives `drag_area` of `mmp`")
    given = rider[:-1] + ", length: 1.3 m, kn: 80 N/(m/s)^2, kt: 9 N/(m/s)^2, mass: 72 kg}"
    profiler = read(text.replace("PROFILER", given)).pieces[1].clamps[2].component
    assert (profiler.mass, profiler.length, profiler.net_buoyancy) == (72.0, 1.3, 0.0)


def test_mistake_of_an_overridden_definition_is_told_at_the_item(mistakes: Mistakes) -> None:
    text = GOOD.replace("{use: plate}", "{use: plate, kn: 3 N/(m/s)^2}")
    assert mistakes(text) == [(12, 5, "`kn` needs `kt`, or `inclination: insensitive`")]


def test_mass_overridden_alone_is_noticed(read: Read) -> None:
    mooring = read(GOOD.replace("label: top float", "mass: 350 kg"))
    assert mooring.pieces[0].component.net_buoyancy == 7000.0
    [notice] = mooring.notices
    assert notice.startswith(
        "line 10: `mass` of ball is overridden, but not its net force in water"
    )


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        # 1000 kg of steel weigh 9807 N in air and 8526 N in water
        ("{use: block}", "{use: block, weight: 9807 N}", "equals its weight in air"),
        ("{use: block}", "{use: block, weight: 9000 N}", ""),
        ("use: rope-12", "use: rope-12, material: steel", "steel` replaces the nylon of rope-12"),
        ("use: rope-12", "use: rope-12, material: polyester", ""),
    ],
)  # fmt: skip
def test_what_an_override_makes_odd_is_said(read: Read, old: str, new: str, said: str) -> None:
    own = """
environment: {depth: 100 m, current: {speed: 0.1 m/s, toward: 90 deg}}
line:
  - {use: ball}
  - {use: rope-12, length: 9 m}
  - {use: block}
components:
  ball: {kind: sphere, diameter: 1 m, buoyancy: 3 kN}
  rope-12: {kind: cable, diameter: 12 mm, weight: 0.1 N/m, material: nylon}
  block: {kind: anchor, mass: 1000 kg, material: steel}
"""
    notices = " ".join(read(own.replace(old, new)).notices)
    assert said in notices and bool(said) == (
        "of block" in notices or "rope-12; the part" in notices
    )


def test_a_nearer_definition_wins_and_says_so(read: Read, tmp_path: Path) -> None:
    mooring = read(GOOD + "components:\n  ball: {kind: sphere, diameter: 2 m, buoyancy: 9 kN}\n")
    assert mooring.pieces[0].length == 2.0
    [notice] = mooring.notices
    assert notice == (
        f"ball: the definition in {tmp_path}/mooring.yaml:15 overrides that in "
        f"{tmp_path}/mine.yaml:2"
    )


VARIANTS = (
    GOOD
    + """\
environments:
  storm: {current: {speed: 1 m/s, toward: 90 deg}}
  shallow: {depth: 600 m}
"""
)


def test_a_named_environment_overrides_keys(read: Read) -> None:
    environment = read(VARIANTS, "storm").environment
    assert (environment.name, environment.depth) == ("storm", 1100.0)
    assert environment.current.u == pytest.approx((1.0,), rel=1e-15)
    # cos 90° is 6e-17 in floating point.
    assert environment.current.v == pytest.approx((0.0,), abs=1e-15)
    environment = read(VARIANTS, "shallow").environment
    assert (environment.name, environment.depth) == ("shallow", 600.0)
    assert environment.current.depth == (0.0, 200.0)


def test_an_environment_that_is_not_there(mistakes: Mistakes) -> None:
    assert mistakes(VARIANTS, "strom") == [
        (14, 1, "no environment is called `strom`; did you mean `storm`?")
    ]
    assert mistakes(VARIANTS, "calm") == [
        (14, 1, "no environment is called `calm`; allowed: shallow, storm")
    ]
    (without,) = mistakes(GOOD, "storm")
    assert without[:2] == (0, 0)
    assert without[2].startswith("the file has no named environments, so there is no `storm`: add")


def test_an_environment_file(read: Read, tmp_path: Path) -> None:
    path = tmp_path / "winter.yaml"
    path.write_text("name: Winter\nenvironment: {current: {speed: 0.5 m/s, toward: 0}}\n")
    environment = read(GOOD, path).environment
    assert (environment.name, environment.depth) == ("Winter", 1100.0)
    assert environment.current.v == (0.5,)
    assert read(GOOD, str(path)).environment == environment


def test_a_mooring_without_environment_takes_that_of_a_file(read: Read, tmp_path: Path) -> None:
    path = tmp_path / "winter.yaml"
    path.write_text("environment: {depth: 900 m}\n")
    environment = read("name: bare\n" + GOOD[GOOD.index("line:") :], path).environment
    assert (environment.name, environment.depth) == ("winter", 900.0)


def test_mistakes_of_an_environment_file(read: Read, tmp_path: Path) -> None:
    path = tmp_path / "winter.yaml"
    path.write_text("environment:\n  depth: 900\n  curent: {}\n")
    with pytest.raises(InputError) as caught:
        read(GOOD, path)
    assert [str(problem) for problem in caught.value.problems] == [
        f"{path}:2:10: `depth: 900` needs a unit; did you mean `depth: 900 m`?",
        f"{path}:3:3: unknown key `curent`; did you mean `current`?",
    ]
    with pytest.raises(InputError, match=r"none.yaml: no such file"):
        read(GOOD, tmp_path / "none.yaml")


def test_variants_are_checked_though_not_chosen(mistakes: Mistakes) -> None:
    text = VARIANTS.replace("600 m", "-600 m")
    expected = [(16, 20, "`depth: -600 m` must be more than 0 m")]
    assert mistakes(text) == mistakes(text, "storm") == expected


def test_density_table(read: Read) -> None:
    table = "{columns: [density kg/m^3, depth m], rows: [[1024, 0], [1.028 g/cm^3, 1 km]]}"
    density = read(GOOD.replace("1100 m\n", f"1100 m\n  density: {table}\n")).environment.density
    assert not isinstance(density, float)
    assert density.depth == (0.0, 1000.0)
    assert density.value == pytest.approx((1024.0, 1028.0), rel=1e-15)


def test_paths_are_shown_as_given(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("m.yaml").write_text("name: m\n")
    with pytest.raises(InputError, match=r"(?m)^m.yaml:1:1: `line` is missing$"):
        read_mooring("m.yaml")


COMPLETED = """\
environment: {depth: 300 m}
line:
  - {use: sphere-steel-1250}
  - {use: wire-jacketed-8, length: 80 m}
  - {use: sbe37}
  - {use: anchor-wheels-4}
components:
  sbe37: {KEYS}
"""


def test_a_component_without_a_kind_completes_that_of_the_catalogue(tmp_path):
    text = COMPLETED.replace("KEYS", "working_load: 40 kN, depth_rating: ")
    plain = read_mooring(tmp_path / "m.yaml", text=text.partition("components")[0])
    file = read_mooring(tmp_path / "m.yaml", text=text)
    before, after = (each.pieces[2].component for each in (plain, file))
    assert before.working_load is None and after.working_load == 40e3
    assert after.depth_rating == before.depth_rating is not None
    assert after == before.model_copy(update={"working_load": 40e3})
    assert file.notices == plain.notices


def test_a_figure_in_place_of_that_of_the_catalogue_is_noticed(tmp_path):
    text = COMPLETED.replace("KEYS", "depth_rating: 9 km")
    (notice,) = read_mooring(tmp_path / "m.yaml", text=text).notices
    assert notice.startswith("sbe37: ")
    assert "overrides `depth_rating` of the definition in " in notice


@pytest.mark.parametrize(
    ("id", "keys", "says"),
    [
        ("sbe37", "depht_rating: 9 km", "did you mean `depth_rating`"),
        ("sbe99x", "depth_rating: 9 km", "`kind` is missing"),
    ],
)
def test_what_completes_nothing_is_refused(tmp_path, id, keys, says):
    text = COMPLETED.replace("  sbe37: {KEYS}", f"  {id}: {{{keys}}}")
    with pytest.raises(InputError) as error:
        read_mooring(tmp_path / "m.yaml", text=text)
    assert any(says in each.message for each in error.value.problems)
