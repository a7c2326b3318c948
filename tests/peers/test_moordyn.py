"""What is exported for MoorDyn stays where CALM has put it."""

import os

import numpy as np
import pytest

from calm.exchange.exporting import export_file
from calm.shipped import shipped_folder
from tests.cli.test_legs import NET

pytestmark = pytest.mark.peers

SECONDS = 10


@pytest.mark.parametrize("name", ["s1000", "cdms-1", "tidal-adcp", "net"])
def test_the_line_stays_where_it_is(name, tmp_path, monkeypatch):
    """Its points move by less than 2e-4 of the depth; its segments are some metres long."""
    moordyn = pytest.importorskip("moordyn", reason="needs the extra `peers`")
    file = shipped_folder("lines") / f"{name}.yaml"
    if name == "net":
        file = tmp_path / "net.yaml"
        file.write_text(NET)
    exported = export_file(file, "moordyn")
    (tmp_path / "mooring.txt").write_bytes(exported.content)
    for beside, content in exported.beside.items():
        (tmp_path / beside).write_bytes(content)
    monkeypatch.chdir(tmp_path)
    system = moordyn.Create(os.fspath(tmp_path / "mooring.txt"))
    try:
        points = [moordyn.GetPoint(system, i + 1) for i in range(moordyn.GetNumberPoints(system))]
        before = np.array([moordyn.GetPointPos(point) for point in points])
        moordyn.Init(system, [], [])
        for second in range(SECONDS):
            moordyn.Step(system, [], [], float(second), 1.0)
        after = np.array([moordyn.GetPointPos(point) for point in points])
    finally:
        moordyn.Close(system)
    depth = -before[:, 2].min()
    assert np.abs(after - before).max() < 2e-4 * depth
