"""What follows from the figures of a component, against closed forms."""

from math import pi

import pytest

from calm.assemble.component_forces import datasheet
from calm.files import Anchor, Assembly, Cable, Catalogue, Cylinder


def test_a_cylinder_by_its_coefficients():
    given = {"kind": "cylinder", "diameter": "0.2 m", "length": "2 m", "buoyancy": "-50 N"}
    sheet = datasheet(Cylinder.model_validate(given | {"cn": 1.2, "ct": 0.9}))
    assert sheet.net_buoyancy == -50.0
    assert sheet.kn == pytest.approx(0.5 * 1025 * 1.2 * 0.4)
    assert sheet.kt == pytest.approx(0.5 * 1025 * 0.9 * pi / 4 * 0.04)
    assert sheet.cd_area == pytest.approx(0.48)
    insensitive = {"cn": 1.2, "ct": 0.9, "inclination": "insensitive"}
    upright = datasheet(Cylinder.model_validate(given | insensitive))
    assert upright.kt == upright.kn


def test_a_cable_by_the_metre():
    cable = Cable.model_validate(
        {"kind": "cable", "diameter": "10 mm", "weight": "2 N/m", "cn": 1.3, "ct": 0.005}
    )
    sheet = datasheet(cable)
    assert (sheet.net_buoyancy, sheet.cd_area) == (-2.0, pytest.approx(0.013))
    assert sheet.kn == pytest.approx(0.5 * 1025 * 1.3 * 0.01)
    assert sheet.kt == pytest.approx(0.5 * 1025 * 0.005 * pi * 0.01)


def test_an_anchor_has_no_drag_but_in_the_fall():
    sheet = datasheet(Anchor.model_validate({"kind": "anchor", "weight": "9 kN"}))
    assert (sheet.net_buoyancy, sheet.kn, sheet.cd_area) == (-9000.0, None, None)


def test_an_assembly_is_the_sum_of_its_parts():
    catalogue = Catalogue.shipped()
    cluster = datasheet(catalogue.get("glass-cluster-3"), catalogue)
    ball, chain, shackle = (
        datasheet(catalogue.get(id)) for id in ("glass-17in", "chain-buoy-13", "shackle-13")
    )
    for name in ("net_buoyancy", "kn", "kt", "cd_area"):
        parts = [getattr(each, name) for each in (ball, chain, shackle)]
        expected = 3 * parts[0] + 3 * parts[1] + 2 * parts[2]
        assert getattr(cluster, name) == pytest.approx(expected)


@pytest.mark.parametrize(
    "part",
    [
        {"use": "nonesuch"},
        {"use": "shackle-13", "buoyancy": "-9 N"},
        {"use": "glass-cluster-3"},
        {"use": "chain-buoy-13", "length": "long"},
    ],
)
def test_an_assembly_that_cannot_be_summed_has_no_sheet(part):
    assembly = Assembly.model_validate({"kind": "assembly", "parts": [part]})
    assert datasheet(assembly, Catalogue.shipped()) is None
    assert datasheet(assembly) is None
