"""What archives want of the result of `calm motion`: flags of depths, and who made it."""

from types import SimpleNamespace

import numpy as np

import calm
from calm.motion.correction import about, depth_flags

MOORING = """\
name: Twin
position: {latitude: 48 deg, longitude: -5 deg}
document: {author: A. Martin, institution: Institute, email: a@example.org, license: CC-BY-4.0, ship: RV Example, platform: P-1}
deployed: {date: 2027-03-02T10:40}
environment: {depth: 300 m, current: {speed: 0.5 m/s, toward: 90 deg}}
line:
  - {use: ball}
  - {use: rope, length: 250 m}
  - {use: weight}
components:
  ball: {kind: sphere, role: float, diameter: 1 m, buoyancy: 2000 N}
  rope: {kind: cable, diameter: 10 mm, weight: 0.2 N/m, stiffness: 1 MN}
  weight: {kind: anchor, weight: 9000 N}
"""  # noqa: E501


def test_a_depth_is_measured_where_a_pressure_of_its_own_counts():
    profiles = SimpleNamespace(
        clamp_depth=np.array([[60.0, 150.0], [61.0, np.nan]]),
        depth_top=np.array([[50.0], [51.0]]),
    )
    measured = SimpleNamespace(
        point=np.array([1, 2]), depth=np.array([[150.2, np.nan], [1.0, 51.0]])
    )
    flags = depth_flags(measured, profiles)
    assert flags["clamp_depth_qc"].tolist() == [[8, 1], [8, 9]]
    assert flags["depth_top_qc"].tolist() == [[8], [1]]


def test_the_document_says_who_made_it(tmp_path):
    (tmp_path / "m.yaml").write_text(MOORING)
    said = about(calm.load(tmp_path / "m.yaml"))
    assert said["creator_name"] == said["publisher_name"] == "A. Martin"
    assert said["institution"] == said["creator_institution"] == "Institute"
    assert said["license"] == "CC-BY-4.0"
    assert said["platform_code"] == "P-1"
    assert said["platform_deployment_ship_name"] == "RV Example"
    assert said["platform_deployment_date"] == "2027-03-02T10:40"
    assert said["water_depth"] == 300.0
