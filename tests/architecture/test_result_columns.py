"""A column is entered in one place: one on trial is found in every output, computed where due."""

import csv
import importlib.util
import io
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
import pytest
import xarray

import calm
from calm.batch.profiles import Profiles
from calm.case.columns import FILES, LINE_TABLES, Output, column, columns_of
from calm.case.result_tables import (
    ENDS,
    MOORED_ENDS,
    NET_ENDS,
    OF_ROWS,
    TOWED_ENDS,
    ClampRow,
    Clamps,
    ComponentRow,
    Components,
    NodePlace,
    Shape,
    table_columns,
)
from calm.cli.main import main
from calm.quantities import Quantity
from calm.report.result_files import header, to_csv
from calm.report.sheet import net_part, table_of_line
from calm.shipped import shipped_folder
from calm.tui.line_rows import table_rows
from calm.tui.line_table import layout_for
from calm.tui.live import judge

EVERYWHERE = FILES | LINE_TABLES | Output.BATCH | Output.BUILDER
DOCS = Path(__file__).resolve().parents[2] / "docs"
GAIN = Quantity("gain", "gain", "N", "Upper less lower tension.", 1)

NET = """
name: pennant
environment: {depth: 100 m, current: {speed: 0.2 m/s, toward: 90 deg}}
legs:
  one:
    line:
      - {use: ball}
      - {use: rope, length: 50 m, clamps: [{use: logger, at: 10 m}]}
    bottom: {join: ring}
  two: {line: [{use: rope, length: 30 m}, {use: block}], top: {join: ring}}
components:
  ball: {kind: sphere, diameter: 1 m, buoyancy: 3 kN, role: float}
  rope: {kind: cable, diameter: 10 mm, weight: 0.2 N/m, stiffness: 100 kN}
  logger: {kind: cylinder, diameter: 40 mm, length: 0.3 m, buoyancy: -5 N}
  block: {kind: anchor, weight: 5 kN}
"""


@dataclass(frozen=True, slots=True)
class TrialRow(ComponentRow):
    """A piece with one column more: this entry is all that is written for it."""

    gain: float = column(
        "tension at the upper end less that at the lower", EVERYWHERE,
        title="gain", unit="N", place=8,
        derived=lambda rows: rows.tension_top - rows.tension_bottom,
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class TrialClamp(ClampRow):
    """The same of a clamp, found from the arrays of the solved line."""

    gain: float = column(
        "twice the tension", EVERYWHERE & ~Output.BATCH, title="gain", unit="N",
        found=lambda held: 2.0 * held.tension, at_anchor=lambda on: 0.0,
    )  # fmt: skip


@pytest.fixture
def trial(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Components, "record", TrialRow)
    monkeypatch.setattr(Clamps, "record", TrialClamp)


@pytest.fixture
def lines(tmp_path: Path) -> dict[str, Path]:
    shipped = shipped_folder("lines")
    net = tmp_path / "net.yaml"
    net.write_text(NET, encoding="utf-8")
    return {
        "mooring": shipped / "thermistor-string.yaml",
        "tow": shipped / "helicopter-bird.yaml",
        "net": net,
    }


@pytest.mark.usefixtures("trial")
@pytest.mark.parametrize("kind", ["mooring", "tow", "net"])
def test_a_result_has_a_column_that_is_entered(lines: dict[str, Path], kind: str) -> None:
    result = calm.load(lines[kind]).solve()
    pieces, clamps = result.components, result.clamps
    assert pieces.gain.tolist() == (pieces.tension_top - pieces.tension_bottom).tolist()
    assert any(pieces.gain)
    assert clamps.gain.tolist() == (2.0 * clamps.tension).tolist()
    told = result.to_dict()
    for name, table in (("components", pieces), ("clamps", clamps)):
        assert [row["gain"] for row in told[name]] == table.gain.tolist()
    rows = [*csv.DictReader(io.StringIO(to_csv([result])))]
    of_pieces = [float(row["gain[N]"]) for row in rows if row["part"] == "component"]
    assert of_pieces == pytest.approx(pieces.gain.tolist(), rel=1e-11)
    dataset = result.to_xarray()
    assert dataset["gain"].values.tolist() == pieces.gain.tolist()
    assert dataset["gain"].attrs["units"] == "N"
    assert dataset["gain"].attrs["long_name"].startswith("tension at the upper end less")
    if len(clamps):
        assert dataset["clamp_gain"].values.tolist() == clamps.gain.tolist()
    assert pieces.to_xarray()["gain"].attrs["units"] == "N"
    assert pieces.to_pandas()["gain"].tolist() == pieces.gain.tolist()
    table = table_of_line(result)
    at = [one.heading for one in table.columns].index("gain")
    whole = [row[at].text for row in table.rows if len(row) > 1]
    assert GAIN.format(float(pieces.gain[0])) == whole[0]


@dataclass(frozen=True)
class TrialNode(NodePlace):
    """A node with one column more."""

    gain: float = column("twice the depth", Output.JSON | Output.NET_TABLE, title="gain", unit="N")


def test_a_node_has_a_column_that_is_entered(lines: dict[str, Path]) -> None:
    result = calm.load(lines["net"]).solve()
    nodes = tuple(TrialNode(**asdict(one), gain=2.0 * one.depth) for one in result.nodes)
    result = replace(result, nodes=nodes)
    assert result.to_dict()["nodes"][0]["gain"] == 2.0 * nodes[0].depth
    (table,) = (one for one in net_part(result).blocks if getattr(one, "title", "") == "Nodes")
    assert [one.heading for one in table.columns] == ["", "depth", "east", "north", "gain"]
    assert table.rows[0][-1].text == GAIN.format(2.0 * nodes[0].depth)


@pytest.mark.usefixtures("trial")
@pytest.mark.parametrize("kind", ["mooring", "net"])
def test_a_batch_has_it(lines: dict[str, Path], tmp_path: Path, kind: str) -> None:
    record = tmp_path / "record.csv"
    record.write_text(
        "time,depth[m],u[m/s],v[m/s]\n2020-01-01T00:00,0,0.2,0\n2020-01-01T01:00,0,0.1,0.1\n",
        encoding="utf-8",
    )
    out = tmp_path / "out.nc"
    words = ["batch", str(lines[kind]), "--currents", str(record), "-o", str(out)]
    assert main([*words, "--no-statistics"]) == 0
    with xarray.open_dataset(out, engine="h5netcdf") as result:
        gain = result["gain"]
        assert gain.dims == ("time", "component") and gain.attrs["units"] == "N"
        expected = result["tension_top"].values - result["tension_bottom"].values
        np.testing.assert_allclose(gain.values, expected, atol=1e-3)
        assert np.abs(gain.values).max() > 1.0
    profiles = calm.solve_profiles(calm.load(lines[kind]), [[0.2]], [[0.0]], [0.0])
    assert profiles.gain.shape == profiles.tilt.shape
    assert profiles.to_xarray()["gain"].dims == ("profile", "component")
    assert "gain" in profiles.to_pandas().columns.get_level_values(0)


@pytest.mark.usefixtures("trial")
def test_the_builder_has_it(lines: dict[str, Path]) -> None:
    from calm.files.editing import Draft

    text = lines["net"].read_text(encoding="utf-8")
    view = judge(text, lines["net"])
    rows = table_rows(Draft(text), view, None)
    assert rows[0].texts["gain"] == GAIN.format(float(view.result.components.gain[0]))
    assert "gain N" in [one.heading for one in layout_for(200)]
    assert "gain" not in [one.name for one in layout_for(60)]


@pytest.mark.usefixtures("trial")
def test_the_manual_has_it() -> None:
    spec = importlib.util.spec_from_file_location("columns_page", DOCS / "generate_columns.py")
    assert spec is not None and spec.loader is not None
    page = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(page)
    written = {path.stem: text for path, text in page.pages()}
    row = "| `gain` | N | tension at the upper end less that at the lower | files, batch, table, "
    assert row in written["python"]
    assert "| `gain` | `time`, `component` | N |" in written["batch"]


def test_every_column_says_what_it_is_and_how_it_is_found() -> None:
    tables = [*Components.columns(), *Clamps.columns(), *Shape.columns()]
    for one in (*tables, *OF_ROWS, *MOORED_ENDS, *TOWED_ENDS):
        assert one.description, one.name
        ways = (one.of_part, one.found, one.derived, one.of_row)
        assert sum(way is not None for way in ways) == 1, one.name
    for one in tables[: -len(Shape.columns())]:
        assert one.found is None or one.at_anchor is not None, one.name
    for record in (*ENDS.values(), *NET_ENDS.values()):
        for one in columns_of(record):
            assert one.description and Output.JSON in one.outputs, one.name
            assert one.quantity is not None or one.name in ("leg", "name"), one.name


def test_columns_are_named_as_files_of_others_know_them() -> None:
    """The contract: names may be added, none may go or change its meaning."""
    assert [one.name for one in Components.columns(Output.JSON)] == [
        "index", "use", "label", "length", "cut_length", "depth_top", "depth_bottom",
        "planned_depth", "x_top", "y_top", "x_bottom", "y_bottom", "tension_top", "tension_bottom",
        "tilt", "knockdown", "safety_factor", "utilisation", "reynolds",
    ]  # fmt: skip
    assert [one.name for one in Clamps.columns(Output.JSON)] == [
        "index", "use", "label", "depth", "planned_depth", "x", "y", "tension", "tilt",
        "knockdown",
    ]  # fmt: skip
    assert [one.variable for part in Profiles.columns().values() for one in part] == [
        "depth_top", "x_top", "y_top", "tension_top", "tension_bottom", "tilt", "knockdown",
        "clamp_depth", "clamp_x", "clamp_y", "clamp_tension", "clamp_tilt", "clamp_knockdown",
        "top_depth", "anchor_vertical", "anchor_horizontal", "used_buoyancy",
        "other_used_buoyancy",
    ]  # fmt: skip
    assert header() == (
        "mooring", "part", "index", "use", "label", "length[m]", "cut_length[m]",
        "depth_top[m]", "depth_bottom[m]", "planned_depth[m]", "x_top[m]", "y_top[m]",
        "x_bottom[m]", "y_bottom[m]", "tension_top[N]", "tension_bottom[N]",
        "tilt[deg]", "knockdown[m]",
        "safety_factor", "utilisation",
    )  # fmt: skip
    assert [one.name for one in table_columns(Output.MOORING_TABLE)] == [
        "length", "depth", "planned_depth", "height", "knockdown", "offset", "tilt", "tension",
        "safety_factor",
    ]  # fmt: skip
    assert [one.name for one in table_columns(Output.TOW_TABLE)] == [
        "length", "depth", "layback", "tilt", "tension", "safety_factor",
    ]  # fmt: skip
    assert [one.name for one in table_columns(Output.NET_TABLE)] == [
        "length", "depth", "planned_depth", "x", "y", "knockdown", "tilt", "tension",
        "safety_factor",
    ]  # fmt: skip
    assert [one.name for one in table_columns(Output.BUILDER)] == [
        "depth", "planned_depth", "tension", "tilt",
    ]  # fmt: skip
