"""Designs of Mooring Design & Dynamics: every dialect, every trap that real files hold."""

import gzip
from math import pi

import h5py
import numpy as np
import pytest
from scipy.io import savemat

from calm.case import load
from calm.errors import InputError
from calm.exchange.importing import import_file
from calm.exchange.mat_file import read_octave_text
from calm.exchange.mdd.reader import read_mdd
from tests.unit.exchange.mat_files import (
    HEIGHT,
    NAMES,
    mooring,
    octave_text,
    tow,
    write_hdf5,
    write_matlab,
    write_octave_hdf5,
    write_version_4,
)

KILOGRAM = 9.80665

DIALECTS = {
    "matlab 5": lambda path, data: write_matlab(path, data),
    "matlab 5, cells": lambda path, data: write_matlab(path, data, names="cell"),
    "matlab 5, uint16": lambda path, data: write_matlab(path, data, names="uint16"),
    "matlab 4": lambda path, data: write_matlab(path, data, version="4"),
    "matlab 7.3": lambda path, data: write_hdf5(path, data),
    "matlab 7.3, cells": lambda path, data: write_hdf5(path, data, names="cell"),
    "matlab 4, other bytes first": lambda path, data: write_version_4(path, data),
    "octave hdf5": lambda path, data: write_octave_hdf5(path, data),
    "octave hdf5, cells": lambda path, data: write_octave_hdf5(path, data, names="cell"),
    "octave, compressed": lambda path, data: path.write_bytes(
        gzip.compress(octave_text(data).encode())
    ),
    "octave": lambda path, data: path.write_text(octave_text(data)),
    "octave, no colon": lambda path, data: path.write_text(octave_text(data, colon="")),
    "octave, wrong rows": lambda path, data: path.write_text(octave_text(data, rows=7)),
}


def read(tmp_path, data, write=write_matlab):
    path = tmp_path / "design.mat"
    write(path, data)
    return read_mdd(path)


def imported(tmp_path, data):
    path = tmp_path / "design.mat"
    write_matlab(path, data)
    return import_file(path, tmp_path / "design.yaml")


def refusal(tmp_path, data):
    with pytest.raises(InputError) as error:
        imported(tmp_path, data)
    return str(error.value)


@pytest.mark.parametrize("dialect", DIALECTS)
def test_every_dialect_says_the_same(dialect, tmp_path):
    design = read(tmp_path, mooring(), DIALECTS[dialect])
    assert [item.component.name for item in design.items] == NAMES
    ball, _, wire, meter, release, chain, anchor = (item.component for item in design.items)
    assert ball.kind == "sphere"
    assert ball.figures["buoyancy"] == pytest.approx(300 * KILOGRAM)
    assert wire.figures["stiffness"] == pytest.approx(1.38e11 * pi / 4 * 0.009**2)
    assert (meter.kind, meter.figures["diameter"], meter.figures["ct"]) == ("cylinder", 0.128, 0.0)
    assert release.figures["role"] == "release"
    assert (chain.kind, chain.figures["diameter"]) == ("chain", 0.03)
    assert "stiffness" not in chain.figures  # inf: that program does not stretch it
    assert anchor.figures["weight"] == pytest.approx(915 * KILOGRAM)
    assert design.water.depth == 120.0
    assert design.water.density == 1025.0
    assert design.water.current == ((0, 0.8, 0.0, 0), (90, 0.3, 0.1, 0), (120, 0, 0, 0))
    (clamp,) = design.items[2].clamps
    assert clamp.component.name == "SBE-16"
    assert clamp.at == pytest.approx(0.3 * 80.0)  # 0.7 up the wire
    assert not clamp.guess


def test_the_mooring_file_runs(tmp_path):
    made = imported(tmp_path, mooring())
    assert made.guessed == ()
    result = load(tmp_path / "design.yaml", text=made.text).solve()
    assert result.to_dict()["status"] == "converged"
    assert "wire rope" in made.text
    assert "buoyancy: 300 kgf" in made.text


def test_it_leans_as_that_program_printed(tmp_path):
    """CDMS-1: the sphere 432.07 m above the seabed, 75.5 m away, the anchor pulled by 827.2 kg at
    9.1 degrees, printed in the users guide. 0.5 % of the water is 2.6 m; the figures are closer."""
    balls, size = 10, []
    size += [[1.2, 0, 1.2, 0], [10, 0.007, 0, 1]]
    for length in (98, 98, 212.9):
        size += [[2, 0.2, 0, 0], [length, 0.007, 0, 1]]
    size += [[0.51, 0, 0.51, 0]] * balls + [[2, 0.2, 0, 0], [4.8, 0.022, 0, 1], [0.55, 1, 0, 0]]
    lift = [682, -0.12, -20, -0.009, -20, -0.009, -20, -0.009, *[23] * balls, -20, -2.33, 1350]
    drag = [0.5, 1.3, 1.2, 1.3, 1.2, 1.3, 1.2, 1.3, *[0.95] * balls, 1.2, 1.3, 1.3]
    modulus = np.full(len(lift), np.inf)
    modulus[[1, -2]] = 1.38e11
    modulus[[3, 5, 7]] = 6.9e10
    water = {"U": [1.5, 0.6, 0.1], "V": [0, 0, 0], "z": [525, 325, 0], "rho": [1024, 1025, 1026]}
    line = {"H": np.array(size, float).T, "B": lift, "Cd": drag, "ME": modulus}
    made = imported(tmp_path, {name: np.array(value) for name, value in (water | line).items()})
    answer = load(tmp_path / "design.yaml", text=made.text).solve().to_dict()
    assert 525 - (answer["top"]["depth"] + 0.6) == pytest.approx(432.07, abs=0.5)
    assert answer["top"]["x"] == pytest.approx(75.5, abs=1.6)
    assert answer["anchor"]["tension"] / KILOGRAM == pytest.approx(827.2, rel=0.02)
    assert answer["anchor"]["angle"] == pytest.approx(9.1, abs=0.3)


def test_it_floats_as_that_program_printed(tmp_path):
    """CDMS-2: 52 % of the float used, whose middle is at 1999.95 m, 413.4 and 67.8 m away; the
    third meter at 1052.61 m; 1442 kg at the anchor, 263 of them sideways; from the users guide.

    Those are answers of its older law of drag, which lacks the downward part of the drag across a
    line: 2 to 3 % of the pull. Heights hardly know of it."""
    balls = 22
    size = [[2, 0, 2, 0], [5, 0.03, 0, 1], [2, 0.2, 0, 0], [450, 0.009, 0, 1]]
    size += [[0.08, 0.025, 0, 2], [500, 0.008, 0, 1], [2, 0.2, 0, 0], [958.8, 0.019, 0, 1]]
    size += [[0.51, 0, 0.51, 0]] * balls + [[2, 0.2, 0, 0], [10, 0.019, 0, 1]]
    size += [[0.08, 0.025, 0, 2], [5, 0.03, 0, 1], [0.15, 1, 0, 0]]
    lift = [2470, -4.12, -20, -0.33, -0.3, -0.19, -20, -0.03, *[23] * balls, -20, -0.03, -0.3]
    drag = [0.5, 1.3, 1.2, 1.3, 1.3, 1.3, 1.2, 1.3, *[0.95] * balls, 1.2, 1.3, 1.3, 1.3, 1.3]
    modulus = np.full(len(size), np.inf)
    modulus[[1, 3, 5, -2]] = 1.38e11
    modulus[[7, -4]] = 3.45e8
    water = {"U": [1.0, 0.8, 0.5, 0.25, 0.1], "V": [0.2, 0.1, 0.05, 0.05, 0.0]}
    water |= {"W": [0.0, 0.1, 0.1, 0.05, 0.0], "z": [2000, 1900, 1800, 1000, 0]}
    line = {"H": np.array(size, float).T, "B": [*lift, -4.12, 454.55], "Cd": drag, "ME": modulus}
    made = imported(tmp_path, {name: np.array(value) for name, value in (water | line).items()})
    answer = load(tmp_path / "design.yaml", text=made.text).solve().to_dict()
    assert answer["type"] == "surface"
    assert answer["top"]["used_buoyancy"] == pytest.approx(0.52, abs=0.01)
    assert 2000 - (answer["top"]["depth"] + 1.0) == pytest.approx(1999.95, abs=0.05)
    assert answer["top"]["x"] == pytest.approx(413.4, rel=0.02)
    assert answer["top"]["y"] == pytest.approx(67.8, rel=0.03)
    assert 2000 - (answer["components"][6]["depth_top"] + 1.0) == pytest.approx(1052.61, abs=0.6)
    assert answer["anchor"]["tension"] / KILOGRAM == pytest.approx(1442, rel=0.015)
    assert answer["anchor"]["horizontal"] / KILOGRAM == pytest.approx(263, rel=0.035)


@pytest.mark.parametrize("sign", [1, -1])
def test_an_anchor_weighs_whatever_its_sign(sign, tmp_path):
    lift = mooring()["B"].copy()
    lift[0, -1] = sign * 915.0
    design = read(tmp_path, mooring(B=lift))
    assert design.items[-1].component.figures["weight"] == pytest.approx(915 * KILOGRAM)


def test_an_anchor_that_would_be_lifted_is_made_heavy_enough(tmp_path):
    lift = mooring()["B"].copy()
    lift[0, -1] = 50.0
    made = imported(tmp_path, mooring(B=lift))
    (guess,) = made.guessed
    assert "exceeds the weight of 490.33 N" in guess.what
    result = load(tmp_path / "design.yaml", text=made.text).solve().to_dict()
    assert result["anchor"]["weight"] >= result["anchor"]["required_weight"]
    assert result["anchor"]["weight"] <= 1.1 * result["anchor"]["required_weight"]


@pytest.mark.parametrize("shape", [(1, 3), (3, 1)])
def test_a_profile_lies_or_stands(shape, tmp_path):
    data = mooring()
    changed = {name: np.reshape(data[name], shape) for name in ("U", "V", "W", "z", "rho")}
    assert read(tmp_path, data | changed).water.current == read(tmp_path, data).water.current


@pytest.mark.parametrize("turned", [False, True])
def test_a_record_stands_beside_the_mooring(turned, tmp_path):
    times = 730486.0 + np.arange(4) / 24  # from the first of January 2000, counted from year 0
    u = np.outer([0.8, 0.3, 0.0], [1.0, 0.5, 0.0, -0.5])
    data = mooring(U=u.T if turned else u, V=0 * u, W=0 * u, time=times)
    design = read(tmp_path, data)
    assert design.water.current[0] == (0.0, 0.8, 0.0, 0.0)
    assert design.record.depth.tolist() == [0.0, 90.0, 120.0]
    assert design.record.u[:, 1] == pytest.approx([0.3, 0.15, 0.0, -0.15])
    assert design.record.epoch == "1970-01-01"
    assert design.record.days[0] == 10957.0  # from 1970 to 2000
    assert design.guessed == []


def test_times_that_are_no_dates_are_guessed(tmp_path):
    u = np.ones((3, 4))
    design = read(tmp_path, mooring(U=u, V=u, W=u, time=np.arange(4.0)))
    assert "days since 2000-01-01" in str(design.guessed[0])


def test_a_modulus_counts_on_lines_alone(tmp_path):
    """After edits the moduli may be those of other elements: on a shackle one means nothing."""
    modulus = np.array([[1.38e11, 3.45e8, np.inf, 6.9e10, np.inf, 1.38e11, np.inf]])
    design = read(tmp_path, mooring(ME=modulus))
    stiff = [item.component.name for item in design.items if "stiffness" in item.component.figures]
    assert stiff == ["1/2 chain"]


def test_the_modulus_of_a_rope_on_a_wire_is_pointed_out(tmp_path):
    modulus = np.array([[np.inf, np.inf, 3.45e8, np.inf, np.inf, np.inf, np.inf]])
    made = imported(tmp_path, mooring(ME=modulus))
    assert [each.where for each in made.guessed] == ["components.3-8-wire-rope.stiffness"]


def test_a_modulus_may_be_the_number_of_a_material(tmp_path):
    modulus = np.array([[1, 1, 6, 1, 1, 1, 1]], np.uint8)
    wire = read(tmp_path, mooring(ME=modulus)).items[2].component
    assert wire.figures["stiffness"] == pytest.approx(6.9e10 * pi / 4 * 0.009**2)


def test_a_missing_modulus_is_no_error(tmp_path):
    wire = read(tmp_path, mooring(ME=None)).items[2].component
    assert "stiffness" not in wire.figures


def test_a_placeholder_size_is_kept_and_pointed_out(tmp_path):
    size = np.array(HEIGHT)
    size[:, 0] = (1.5, 0.01, 0.01, 2.0)
    made = imported(tmp_path, mooring(H=size))
    assert "diameter: 10 mm  # guessed: value of the file, but too small" in made.text
    assert len(made.guessed) == 1


def test_a_piece_without_size_has_no_drag(tmp_path):
    size = np.array(HEIGHT)
    size[:, 3] = (0.55, 0.0, 0.0, 0.0)
    made = imported(tmp_path, mooring(H=size))
    assert "drag_area: 0 m^2" in made.text
    assert load(tmp_path / "design.yaml", text=made.text).solve()


def test_clamps_sit_on_rigid_pieces_too(tmp_path):
    data = mooring(Jobj=np.array([[5]]), Pobj=np.array([[0.25]]), ZCO=None)
    made = imported(tmp_path, data)
    assert "at: 0.705 m" in made.text  # of 0.94 m, a quarter of it up
    assert load(tmp_path / "design.yaml", text=made.text).solve()


def test_a_clamp_known_by_its_height_alone_is_guessed(tmp_path):
    made = imported(tmp_path, mooring(Jobj=None, Pobj=None))
    assert [each.what for each in made.guessed] == [
        "the position is computed from the height `ZCO` alone"
    ]
    assert "at: 24 m" in made.text


def test_a_clamp_in_two_places_is_pointed_out(tmp_path):
    made = imported(tmp_path, mooring(ZCO=np.array([[20.0]])))
    assert "`ZCO` disagrees (20 m)" in made.guessed[0].what


def test_a_chain_that_floats_is_a_cable(tmp_path):
    """As from the other programs: a chain of CALM has a weight."""
    lifts = mooring()["B"].copy()
    lifts[0, 5] = 4.0
    chain = read(tmp_path, mooring(B=lifts)).items[5].component
    assert (chain.name, chain.kind) == ("1/2 chain", "cable")
    assert chain.figures["buoyancy"] == pytest.approx(4.0 * KILOGRAM)
    assert "weight" not in chain.figures


def test_a_tow_leads_from_the_ship_to_the_body(tmp_path):
    made = imported(tmp_path, tow())
    assert "tow: {speed: 1 m/s, toward: 36.8698976 deg}" in made.text
    assert [each.where for each in made.dropped] == ["afh"]
    read_back = load(tmp_path / "design.yaml", text=made.text)
    assert [piece.use for piece in read_back.file.pieces] == ["1-4-kevlar", "heavy-sphere"]
    assert read_back.solve().to_dict()["status"] == "converged"


def test_names_that_are_missing_are_numbers(tmp_path):
    design = read(tmp_path, mooring(moorele=NAMES[:2]))
    assert [item.component.name for item in design.items][1:4] == [
        "1/2 shackle", "element 3", "element 4",
    ]  # fmt: skip


REFUSED = {
    "no mooring": (mooring(H=None), "contains neither a mooring"),
    "no water": (mooring(U=None, V=None, z=None, rho=None), "--environment FILE"),
    "all at the seabed": (mooring(z=np.zeros((1, 3))), "--environment FILE"),
    "too few buoyancies": (mooring(B=np.array([[1.0, 2.0]])), "`B` has 2 values for 7 elements"),
    "current of other levels": (
        mooring(U=np.ones((1, 2))),
        "`U` has the size 1×2, which does not match the 3 values of `z`",
    ),
    "a line for an anchor": (
        mooring(H=np.array(HEIGHT)[:, [0, 1, 2, 3, 4, 6, 5]]),
        "not an anchor",
    ),
    "a negative length": (mooring(H=-np.array(HEIGHT)), "its length is -0.94"),
    "a clamp off the line": (
        mooring(Jobj=np.array([[40]])),
        "clamped on element 40, which does not exist",
    ),
    "a ship at rest": (tow(Usp=0.0, Vsp=0.0), "must move"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_makes_no_sense_is_refused_by_name(case, tmp_path):
    data, message = REFUSED[case]
    assert message in refusal(tmp_path, data)


@pytest.mark.parametrize(
    ("dialect", "share"),
    [(name, share) for name in ("matlab 5", "matlab 7.3") for share in (0.1, 0.5, 0.9)]
    + [("octave", 0.1), ("octave", 0.5)],
)
def test_a_truncated_file_is_refused(dialect, share, tmp_path):
    path = tmp_path / "design.mat"
    DIALECTS[dialect](path, mooring())
    content = path.read_bytes()
    path.write_bytes(content[: int(share * len(content))])
    with pytest.raises(InputError):
        import_file(path, tmp_path / "design.yaml")


@pytest.mark.parametrize("content", [b"", b"\x00" * 4000, b"\x93NUMPY", bytes(range(256)) * 40])
def test_binary_files_are_refused(content, tmp_path):
    path = tmp_path / "design.mat"
    path.write_bytes(content)
    for format in (None, "mdd"):
        with pytest.raises(InputError):
            import_file(path, tmp_path / "design.yaml", format=format)


def test_nothing_in_a_file_is_unpickled(tmp_path):
    """A pickle in place of a file, and one hidden as bytes in a variable, do nothing."""
    import pickle

    class Trap:
        def __reduce__(self):
            return (open, (str(tmp_path / "sprung"), "w"))

    path = tmp_path / "design.mat"
    path.write_bytes(pickle.dumps(Trap()))
    with pytest.raises(InputError):
        import_file(path, tmp_path / "design.yaml", format="mdd")
    data = mooring(moorele=np.frombuffer(pickle.dumps(Trap()), np.uint8).reshape(1, -1))
    savemat(path, data)
    read_mdd(path)
    assert not (tmp_path / "sprung").exists()


def test_a_file_that_links_to_another_is_refused(tmp_path):
    write_hdf5(tmp_path / "other.mat", mooring())
    path = tmp_path / "design.mat"
    write_hdf5(path, mooring())
    with h5py.File(path, "r+") as file:
        del file["H"]
        file["H"] = h5py.ExternalLink(str(tmp_path / "other.mat"), "/H")
    with pytest.raises(InputError, match="neither a mooring"):
        read_mdd(path)


def test_octave_cells_and_ranges_are_read():
    text = (
        "# Created by Octave\n# name: moorele\n# type: cell\n# rows: 2\n# columns: 1\n"
        "# name: <cell-element>\n# type: string\n# elements: 1\n# length: 4\nball\n\n"
        "# name: <cell-element>\n# type: string\n# elements: 1\n# length: 4\nrope\n\n"
        "# name: z\n# type: range\n# base, limit, increment\n0 10 5\n\n"
        "# name: n\n# type: uint8 matrix\n# ndims: 2\n 1 3\n  1\n  2\n  3\n"
    )
    found = read_octave_text(text)
    assert found["moorele"] == [["ball"], ["rope"]]
    assert found["z"].tolist() == [0.0, 5.0, 10.0]
    assert found["n"].tolist() == [[1.0, 2.0, 3.0]]


def test_octave_ranges_are_read_in_both_its_formats(tmp_path):
    text = "# name: z\n# type: double_range\n# base, limit, increment\n120 0 -60\n"
    assert read_octave_text(text)["z"].tolist() == [120.0, 60.0, 0.0]
    path = tmp_path / "design.mat"
    write_octave_hdf5(path, mooring())
    with h5py.File(path, "r+") as file:
        del file["z/value"]
        kinds = [(name, "f8") for name in ("base", "limit", "increment")]
        file["z"]["value"] = np.array((120.0, 0.0, -60.0), kinds)
    assert [row[0] for row in read_mdd(path).water.current] == [0.0, 60.0, 120.0]


def test_an_endless_range_is_refused():
    with pytest.raises(ValueError, match="the range `z` has"):
        read_octave_text("# name: z\n# type: range\n# base, limit, increment\n0 1e300 1e-9\n")


def test_octaves_own_format_and_bombs_are_refused_by_name(tmp_path, monkeypatch):
    path = tmp_path / "design.mat"
    path.write_bytes(b"Octave-1-L" + bytes(400))
    with pytest.raises(InputError, match="Octave's binary format"):
        import_file(path, tmp_path / "design.yaml")
    monkeypatch.setattr("calm.exchange.mat_file.LARGEST", 1_000_000)
    path.write_bytes(gzip.compress(b"# name: z\n# type: matrix\n" + bytes(2_000_000)))
    with pytest.raises(InputError, match="more than 1 MB once it is decompressed"):
        import_file(path, tmp_path / "design.yaml", format="mdd")


@pytest.mark.parametrize("size", [1e12, np.nan, -np.inf])
def test_sizes_of_no_piece_are_refused(size, tmp_path):
    height = np.array(HEIGHT)
    height[0, 2] = size
    assert "element 3, 3/8 wire rope: its length is" in refusal(tmp_path, mooring(H=height))


def test_a_million_elements_are_refused_at_once(tmp_path):
    many = np.ones((1, 1_000_000))
    data = mooring(H=np.ones((4, 1_000_000)), B=many, Cd=many, ME=many)
    assert "`H` has 1000000 elements; more than 2000 cannot be read" in refusal(tmp_path, data)
    water = {name: np.linspace(100.0, 0.0, 5000) for name in ("z", "U", "V", "W", "rho")}
    assert "has 5000 levels of current" in refusal(tmp_path, mooring(**water))


def test_a_float_without_a_height_rides_by_its_buoyancy(tmp_path):
    """At the surface that program lets it drag in proportion, however high it is."""
    height = np.array(HEIGHT)
    height[0, 2], height[0, 0] = 130.0, 0.0
    design = read(tmp_path, mooring(H=height))
    (low, high) = design.items[0].component.hull
    assert low == (0.0, 0.0, 0.0)
    assert high[1] == pytest.approx(300 / 1025, rel=1e-5)


@pytest.mark.parametrize(("wire", "kind"), [(98.0, "subsurface"), (130.0, "surface")])
def test_a_float_is_at_the_surface_where_the_solved_line_reaches_it(wire, kind, tmp_path):
    """The first is long enough if it stretched by a fifth, but wire does not."""
    height = np.array(HEIGHT)
    height[0, 2] = wire
    made = imported(tmp_path, mooring(H=height))
    result = load(tmp_path / "design.yaml", text=made.text).solve()
    assert result.type == kind
    assert ("hull" in made.text) == (kind == "surface")


NASTY = ['"]\n  - {use: x}', "a: b # c", "- [1, 2]", "{use: x}", "\x1b[31mred", "null", "é↑ 🐟"]


def test_names_of_all_kinds_are_texts_in_the_file(tmp_path):
    """Whatever a name holds, it stands as a name in a file that reads."""
    names = [*NASTY[:6], NAMES[6]]
    path = tmp_path / "design.mat"
    write_matlab(path, mooring(moorele=names), names="cell")
    made = import_file(path, tmp_path / "design.yaml")
    pieces = load(tmp_path / "design.yaml", text=made.text).file.pieces
    assert [piece.component.name or piece.use for piece in pieces[1:4]] == [
        "a: b # c", "- [1, 2]", "{use: x}",
    ]  # fmt: skip
    assert pieces[0].component.name == '"] - {use: x}'
    assert "\x1b" not in made.text


def test_clamps_of_a_tow_count_from_the_lower_end(tmp_path):
    """The file leads from the body up: the second element is the wire."""
    hung = mooring()
    clamps = {name: hung[name] for name in ("HCO", "BCO", "CdCO", "mooreleCO")}
    data = tow(**clamps, Jobj=np.array([[2]]), Pobj=np.array([[0.25]]))
    design = read(tmp_path, data)
    (clamp,) = design.items[0].clamps
    assert clamp.at == pytest.approx(75.0)
