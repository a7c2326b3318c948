"""Parts of a line that may be instruments: neither floats on a chain nor other pieces."""

import calm
from calm.motion.line_response import instruments_of, labels_of

MOORING = """
name: m
environment: {depth: 300 m, current: {speed: 0.2 m/s, toward: 90 deg}}
line:
  - {use: sphere-steel-1250, label: top}
  - {use: wire-jacketed-8, length: 100 m, clamps: [{use: sbe37, at: 20 m, label: logger}]}
  - {use: glass-cluster-4, label: glass}
  - {use: rcm11, label: meter}
  - {use: release-ar861}
  - {use: anchor-wheels-4}
"""


def test_glass_balls_are_no_instruments(tmp_path):
    (tmp_path / "m.yaml").write_text(MOORING)
    mooring = calm.load(tmp_path / "m.yaml")
    labels = labels_of(mooring)
    assert sum("ball" in one for one in labels) == 4
    assert [labels[at] for at in instruments_of(mooring)] == ["logger", "meter"]
