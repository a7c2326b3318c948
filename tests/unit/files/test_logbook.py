"""What a file keeps beside the design: serial numbers, lengths at a load, what was deployed."""

from collections.abc import Callable

import pytest

from calm.files import MooringFile
from calm.files.editing import Draft

from .conftest import GOOD, Place

Read = Callable[..., MooringFile]
Mistakes = Callable[..., list[Place]]

ROPE = "  - {use: rope-12, length: 480 m, clamps: [{use: meter, at: 20 m}]}\n"
AT = "length_at: {load: 2 kN, length: 480 m}"


def with_rope(item: str) -> str:
    assert ROPE in GOOD
    return GOOD.replace(ROPE, item)


def test_nothing_given_is_nothing(read: Read) -> None:
    file = read(GOOD)
    assert (file.document, file.releases, file.deployed) == (None, (), None)
    assert {piece.serial for piece in file.pieces} == {None}
    assert file.pieces[1].measured_load == 0.0


@pytest.mark.parametrize(
    ("stretch", "strain"),
    [
        ("", 0.0),  # a cable without stiffness is rigid in length
        (", stiffness: 400 kN", 2.0 / 400.0),
        # 2 kN is the second point of the table, which the curve passes through
        (", elongation: [[0.02, 1 %], [1/15, 5 %], [0.2, 9 %]]", 0.05),
        (", elongation: [[1/15, 5 %]], permanent_elongation: 3 %", 0.08),
    ],
)
def test_a_length_at_a_load_is_that_without_load_stretched(
    read: Read, stretch: str, strain: float
) -> None:
    piece = read(with_rope(f"  - {{use: rope-12, {AT}{stretch}}}\n")).pieces[1]
    assert piece.length is not None
    assert piece.length * (1.0 + strain) == pytest.approx(480.0, rel=1e-14)
    assert piece.measured_load == 2000.0


def test_a_chain_may_be_measured_too(read: Read) -> None:
    item = f"  - {{use: chain-13, {AT}, stiffness: 100 MN}}\n"
    assert read(with_rope(item)).pieces[1].length == pytest.approx(480.0 / 1.00002, rel=1e-14)


def test_serial_numbers_of_a_count(read: Read) -> None:
    clamps = "clamps: [{use: meter, at: 0, serial: [7, 8]}, {use: meter, at: 1 m, serial: lot 3}]"
    item = f"  - {{use: rope-12, length: 5 m, count: 2, serial: [A, B], {clamps}}}\n"
    pieces = read(with_rope(item)).pieces[1:3]
    assert [piece.serial for piece in pieces] == ["A", "B"]
    assert [clamp.serial for piece in pieces for clamp in piece.clamps] == [
        "7", "lot 3", "8", "lot 3",
    ]  # fmt: skip


def test_all_that_is_kept(read: Read) -> None:
    text = (
        GOOD.replace(
            "label: top float}", "label: top float, serial: 0012, battery_until: 2027-06-30}"
        )
        + "environments: {storm: {depth: 1100 m}}\n"
        + "document: {id: M-17, revision: B, history: [{revision: A, change: first}]}\n"
        + "releases: [{serial: 5, codes: {enable: 0123, release: 4567}}, {codes: [a, b]}]\n"
        + "deployed: {date: 2026-11-22, depth: 1103 m, items: [{label: rope-12, length: 470 m}]}\n"
    )
    file = read(text)
    assert file.pieces[0].serial == "0012"
    assert file.pieces[0].equipment.battery_until == "2027-06-30"
    assert file.document is not None and file.deployed is not None
    assert file.document.to_dict() == {
        "id": "M-17",
        "revision": "B",
        "history": [{"revision": "A", "change": "first"}],
    }
    codes = [release.code_lines for release in file.releases]
    assert codes == [("enable: 0123", "release: 4567"), ("a", "b")]
    # the workers of a cluster know a mooring by it
    assert hash(file) == hash(read(text))
    assert (file.deployed.depth, file.deployed.items[0].length) == (1103.0, 470.0)


def test_a_release_that_is_not_in_the_line_is_reported(read: Read) -> None:
    line = GOOD.replace("{use: plate}", "{use: plate, role: release, serial: 5}")
    assert read(line + "releases: [{serial: 5, codes: 1}]\n").notices == ()
    (notice,) = read(line + "releases: [{serial: 6, codes: 1}]\n").notices
    assert notice == "`releases`: no release of the line has the serial number 6."


@pytest.mark.parametrize(
    ("text", "mistake"),
    [
        (
            with_rope(f"  - {{use: rope-12, length: 5 m, {AT}}}\n"),
            (11, 33, "gives both `length` and `length_at`, which exclude each other"),
        ),
        (
            with_rope("  - {use: rope-12, length_at: 480 m}\n"),
            (11, 31, "`length_at` must have the form `{load: 2 kN, length: 480 m}`"),
        ),
        (
            with_rope("  - {use: rope-12, length_at: {length: 480 m}}\n"),
            (11, 31, "`load` is missing"),
        ),
        (
            with_rope("  - {use: rope-12, length_at: {load: 31 kN, length: 480 m}}\n"),
            (11, 38, "`load` must not exceed the breaking load of 30000 N"),
        ),
        (
            with_rope(f"  - {{use: meter, {AT}}}\n"),
            (
                11,
                18,
                "`length_at` is for cables and chains; this piece has the length given in its "
                "definition",
            ),
        ),
        (
            with_rope("  - {use: rope-12, length: 5 m, count: 3, serial: [A, B]}\n"),
            (11, 51, "`serial` has 2 numbers for a count of 3"),
        ),
        (
            with_rope("  - {use: plate, clamps: [{use: meter, at: 0, serial: [1, 2]}]}\n"),
            (11, 55, "`serial` has 2 numbers for a count of 1"),
        ),
        (
            with_rope("  - {use: rope-12, length: 5 m, calibrated: spring}\n"),
            (11, 45, "`spring` is not a date; write it as 2027-06-30"),
        ),
        (
            GOOD + "document: {revison: 2}\n",
            (14, 12, "unknown key `revison`; did you mean `revision`?"),
        ),
        (
            GOOD + "deployed: {date: yesterday}\n",
            (14, 18, "`yesterday` is not a time; write 2026-03-01T06:00"),
        ),
        (
            GOOD + "deployed: {items: [{label: top flot}]}\n",
            (14, 28, "no piece or clamp is called `top flot`; did you mean `top float`?"),
        ),
        (
            GOOD + "deployed: {items: [{label: plate}, {label: plate}]}\n",
            (14, 44, "`plate` is given twice"),
        ),
        (
            GOOD + "deployed: {items: [{label: plate, length: 3 m}]}\n",
            (14, 43, "`length` of `plate`: only a cable or chain is cut to length"),
        ),
    ],
)  # fmt: skip
def test_mistakes(mistakes: Mistakes, text: str, mistake: Place) -> None:
    assert mistakes(text) == [mistake]


def test_an_edit_keeps_what_is_kept(read: Read) -> None:
    text = with_rope(f"  - {{use: rope-12, {AT}, serial: A}}  # drum 2\n")
    draft = Draft(text)
    assert draft.items[1].values["length_at"] == "480 m at 2 kN"
    shorter = draft.put(1, "length_at", {"load": "2 kN", "length": "470 m"})
    assert shorter.text == text.replace("480 m}", "470 m}")
    named = draft.put_at(("document", "id"), "M-17")
    assert named.text.startswith("name: Iroise\ndocument:\n  id: M-17\nenvironment:")
    assert [p.equipment for p in read(named.text).pieces] == [
        p.equipment for p in read(text).pieces
    ]
