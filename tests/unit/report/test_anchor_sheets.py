"""The figure of the anchor drop, read back from its SVG."""

from pathlib import Path

import pytest

import calm
from calm.report.anchor_sheets import drop_figure
from tests.drawings import assert_none_overlap, curves_of, words_of

LINE = Path(__file__).resolve().parents[3] / "lines" / "fit-top-depth.yaml"


@pytest.mark.thorough
def test_the_drop_is_drawn_to_one_scale_with_every_moment_named():
    plan = calm.drop_plan(calm.load(LINE), ship_speed=1.0)
    svg = drop_figure(plan)
    assert_none_overlap(svg)
    assert {*(moment.name for moment in plan.moments), "path of the anchor"} <= set(words_of(svg))
    ((points, _),) = curves_of(svg, "#d55e00")  # the path, from where it is let go to the seabed
    across, down = points[-1] - points[0]
    path = plan.path
    assert across / down == pytest.approx(
        (path.anchor_x[-1] - path.anchor_x[0]) / (path.anchor_depth[-1] - path.anchor_depth[0]),
        abs=2e-3,
    )
    # the first moments, in which inertia limits the speed, are not drawn; nothing runs off the axis
    ((speeds, _),) = curves_of(svg, "#111111")
    assert len(speeds) > 50
    assert speeds[:, 0].max() < 502.0  # the right edge of the axes [pt]
