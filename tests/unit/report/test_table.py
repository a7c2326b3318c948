import io
from pathlib import Path

import pytest
from rich.console import Console

from calm.case.strumming import Strumming, StrummingBand
from calm.checks.finding import State
from calm.report.sheet import result_part, safety_state, tilt_state
from calm.report.terminal import shown

GOLDEN = Path(__file__).parent / "golden"


def text(result, width, verbose=False, **console):
    stream = io.StringIO()
    part = result_part(result, verbose=verbose)
    Console(file=stream, width=width, **console).print(shown(part))
    return "\n".join(line.rstrip() for line in stream.getvalue().splitlines()) + "\n"


@pytest.mark.parametrize("width", [80, 100])
def test_table_is_as_it_was(result, width):
    # the narrow one says how it was reached, too
    assert text(result, width, verbose=width == 80) == (GOLDEN / f"table-{width}.txt").read_text(
        encoding="utf-8"
    )


def test_no_line_is_wider_than_the_terminal(make_result):
    result = make_result()
    result.components[0].label = "a label that is much too long for any terminal of the world"
    assert max(map(len, text(result, 80).splitlines())) <= 80


def test_label_is_shown_as_it_is_written(make_result):
    result = make_result()
    result.components[0].label = "[red]top[/red] :anchor:"
    assert "[red]top[/red] :anchor:" in text(result, 100)


def test_marks_do_not_hang_on_colour(result):
    plain = text(result, 80)
    assert "28.4!" in plain
    assert "16.0~" in plain
    assert "10300 N required (106 %) !" in plain


def test_colour_only_on_a_terminal_that_wants_it(result):
    assert "\x1b[" not in text(result, 80)
    coloured = text(result, 80, force_terminal=True, color_system="standard", no_color=False)
    assert "\x1b[1;31m28.4!" in coloured
    colourless = text(result, 80, force_terminal=True, no_color=True)
    assert "\x1b[1;31m" not in colourless


def test_surface_mooring_tells_its_reserve(make_result):
    result = make_result(type="surface")
    result.top.used_buoyancy, result.top.reserve, result.top.knockdown = 0.6544, 2410.0, None
    shown = text(result, 100)
    assert "surface mooring" in shown
    assert "65.4 % of its buoyancy in use, reserve buoyancy 2410 N" in shown


def test_unknown_knockdown_is_told(make_result):
    result = make_result()
    result.top.knockdown = None
    assert "knockdown unknown" in text(result, 100)


def test_tilt_marks(result):
    meter = result.design.file.pieces[3].component
    assert tilt_state(meter, 27.0) is None
    assert tilt_state(meter, 27.1) is State.FAIL


@pytest.mark.parametrize(
    ("index", "mooring_type", "factor", "utilisation", "mark"),
    [
        (1, "subsurface", 2.9, None, State.FAIL),  # steel: 3
        (1, "subsurface", 3.1, None, None),
        (6, "subsurface", 4.9, None, State.FAIL),  # polyester: 5
        (6, "subsurface", 5.1, None, None),
        (1, "surface", 4.9, None, State.FAIL),  # surface: 5
        (1, "subsurface", 2.9, 0.9, State.FAIL),  # either load may be too much
        (1, "subsurface", 3.1, 0.9, None),
        (1, "subsurface", 9.0, 1.1, State.FAIL),
        (6, "subsurface", 5.1, 1.1, None),  # of a rope only the breaking load counts
        (1, "subsurface", None, None, None),
    ],
)
def test_safety_marks(make_result, index, mooring_type, factor, utilisation, mark):
    result = make_result(type=mooring_type)
    record = result.components[index]
    record.safety_factor = float("nan") if factor is None else factor
    record.utilisation = float("nan") if utilisation is None else utilisation
    assert safety_state(result, record) is mark


def test_draft_where_the_hull_is_known(make_result):
    result = make_result(type="surface")
    result.top.used_buoyancy, result.top.draft, result.top.freeboard = 0.5, 0.614, 0.386
    assert " draft 0.61 m, freeboard 0.39 m\n" in text(result, 100)


@pytest.mark.parametrize(
    ("kind", "band", "told"),
    [
        ("subsurface", ("converged", 118.0, 13.05, 5333.3), "knockdown 13.1 m"),
        ("surface", ("converged", 0.0, 0.0, 5333.3), "top at the surface"),
        ("surface", ("converged", -0.4, 0.0, 5333.3), "top at the surface"),
        ("surface", ("converged", 2.0, 2.0, 5333.3), "knockdown 2.0 m"),
        ("surface", ("converged", 2.0, None, 5333.3), "top 2.0 m deep"),
        ("subsurface", ("no-equilibrium",), "no-equilibrium"),
    ],
)
def test_what_strumming_would_do(make_result, kind, band, told):
    result = make_result(type=kind, strumming_band=StrummingBand(1.5, *band))
    assert f"with strumming (normal drag of the cables × 1.5): {told}\n" in text(result, 100)


def test_what_strumming_does(make_result):
    result = make_result(strumming=Strumming(frequency=12.3, cn_min=1.95, cn_max=1.95))
    assert "strumming at up to 12.30 Hz, Cn from 1.950 to 1.950\n" in text(result, 100)
    assert "with strumming" not in text(result, 100)


def test_the_legend_is_that_of_the_marks_that_occur(make_result):
    result = make_result()
    legend = text(result, 100).splitlines()[-1]
    assert legend == "~ close to a limit. ! limit exceeded."
    for row in result.components:
        row.safety_factor, row.utilisation, row.tilt = 20.0, 0.1, 1.0
    for clamp in result.clamps:
        clamp.tilt = 1.0
    assert text(result, 100).splitlines()[-1] == "part."


def test_the_error_of_the_figures_is_said_where_it_is_asked_for(result):
    assert "Good to" not in text(result, 100)
    assert "Numerical error: 0.003 m in depth, 0.8 N in tension." in text(result, 100, verbose=True)
