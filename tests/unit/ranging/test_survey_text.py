"""Surveys as ships write them down: the place that was put in comes out of each form."""

from pathlib import Path

import numpy as np
import pytest

from calm.errors import InputError
from calm.positions import Frame
from calm.ranging import locate, read_ranges

LATITUDE, LONGITUDE, DEPTH, TRANSDUCER = 57.5, -27.8, 1200.0, 5.0
FRAME = Frame(LATITUDE, LONGITUDE)
SHIPS = ((800, 0), (-700, 500), (0, -900), (300, 700), (-400, -600), (100, 50))  # [m]


def rows(transducer: float) -> list[tuple[float, float, float]]:
    """Latitude, longitude and range [m] about the place."""
    found = []
    for east, north in SHIPS:
        latitude, longitude, _ = FRAME.position(np.array([east, north, 0.0]))
        found.append(
            (latitude, longitude, float(np.hypot(np.hypot(east, north), DEPTH - transducer)))
        )
    return found


def minutes(degrees: float) -> tuple[int, str]:
    size = abs(degrees)
    whole = int(size)
    return (whole if degrees >= 0.0 else -whole), f"{60.0 * (size - whole):.5f}"


def whoi() -> str:
    lines = []
    for latitude, longitude, reach in rows(0.0):
        parts = [*minutes(latitude), *minutes(longitude), f"{reach / 1500.0:.6f}"]
        lines.append(" ".join(map(str, parts)))
    return "\n".join(lines)


def noc() -> str:
    head = f"0 {LATITUDE} {LONGITUDE}\n1210 10 {TRANSDUCER}\n0 57.501 -27.801\n"
    return head + "".join(f"{r:.2f} {a:.7f} {b:.7f}\n" for a, b, r in rows(TRANSDUCER))


def noc_without_target() -> str:
    """As typed at sea: tabs in some rows, blanks of any number in others."""
    head = f"1210\t10\t{TRANSDUCER}  \n-999 57.501 -27.801    \n"
    return head + "".join(f"{r:.2f}\t {a:.7f}  {b:.7f} \n" for a, b, r in rows(TRANSDUCER))


def event_log() -> str:
    lines = ["Time,Lat deg,Lat min,Lat hem,Lon deg,Lon min,Lon hem,Slant Range (m),Event"]
    for i, (latitude, longitude, reach) in enumerate(rows(0.0)):
        (north, north_minutes), (west, west_minutes) = minutes(latitude), minutes(longitude)
        place = f"{north},{north_minutes},N,{-west},{west_minutes},W"
        lines.append(f"12:0{i},{place},{reach:.2f},ping")
    return "\n".join(lines)


def deck_box() -> str:
    lines = ["Latitude;Longitude;TWT (ms)"]
    for latitude, longitude, reach in rows(0.0):
        (north, north_minutes), (west, west_minutes) = minutes(latitude), minutes(longitude)
        time = f"{2000.0 * reach / 1500.0:.4f}"
        lines.append(f"{north} {north_minutes} N;{-west} {west_minutes} W;{time}")
    return "\n".join(lines)


@pytest.mark.parametrize("written", [whoi, noc, noc_without_target, event_log, deck_box])
def test_the_place_comes_out_of_every_form(tmp_path: Path, written) -> None:
    path = tmp_path / "survey.txt"
    path.write_text(written())
    survey = read_ranges(path)
    assert len(survey.line) == len(SHIPS)
    assert survey.transducer == (TRANSDUCER if written in (noc, noc_without_target) else 0.0)
    found = locate(survey, 1500.0)
    # positions are written to 2e-7 and 1e-7 degrees, ranges to 0.01 m: a few centimetres
    assert found.latitude == pytest.approx(LATITUDE, abs=2e-6)
    assert found.longitude == pytest.approx(LONGITUDE, abs=3e-6)
    # of a transducer at the surface, DEPTH below it is DEPTH below the surface
    assert found.depth == pytest.approx(DEPTH, abs=0.2)


def test_what_is_understood_of_a_form_without_a_heading_is_said(tmp_path: Path) -> None:
    path = tmp_path / "survey.dat"
    path.write_text(whoi())
    (said,) = read_ranges(path).notices
    assert "one-way time in seconds" in said and "south and west are negative" in said
    path.write_text(noc_without_target())
    (said,) = read_ranges(path).notices
    assert "1210 m" in said and "10 m above the seabed" in said
    path.write_text(event_log())
    assert read_ranges(path).notices == ("not read: `clock Time`, `Event`",)


def test_mistakes_keep_their_lines(tmp_path: Path) -> None:
    path = tmp_path / "survey.csv"
    path.write_text(event_log().replace("12:03,57", "12:03,97"))
    with pytest.raises(InputError) as refused:
        read_ranges(path)
    assert [(one.line, one.column) for one in refused.value.problems] == [(5, 7)]
    path.write_text("57.5 -27.8 1200\n57.6 -27.9 1300\n")  # three columns that say nothing
    with pytest.raises(InputError, match="no header"):
        read_ranges(path)
