"""What an override makes void in the definition below it."""

import pytest

from calm.files.components import contradicted

DRAG = {"kn", "kt", "drag_area", "cd", "drag_measurements", "made_of"}


@pytest.mark.parametrize(
    ("kind", "base", "override", "void"),
    [
        # The net force of a rigid piece.
        ("sphere", {"buoyancy", "mass"}, {"buoyancy"}, {"volume"}),
        ("sphere", {"buoyancy", "mass"}, {"mass"}, set()),
        ("sphere", {"buoyancy", "mass", "volume"}, {"mass"}, {"buoyancy"}),
        ("cylinder", {"mass", "volume"}, {"volume"}, {"buoyancy"}),
        ("cylinder", {"buoyancy", "mass"}, {"volume"}, {"buoyancy"}),
        ("cylinder", {"buoyancy"}, {"volume"}, set()),
        ("cylinder", {"buoyancy"}, {"mass", "volume"}, {"buoyancy"}),
        ("cylinder", {"buoyancy"}, {"diameter", "cn"}, set()),
        # That of lines and anchors.
        ("cable", {"weight", "mass"}, {"buoyancy"}, {"weight"}),
        ("cable", {"buoyancy"}, {"weight"}, {"buoyancy"}),
        ("cable", {"weight", "mass"}, {"mass"}, set()),
        ("cable", {"weight", "mass"}, {"density"}, {"weight", "buoyancy"}),
        ("cable", {"weight", "density"}, {"mass"}, {"weight", "buoyancy"}),
        ("cable", {"weight"}, {"finish"}, set()),
        ("cable", {"stiffness"}, {"elongation"}, {"stiffness"}),
        (
            "cable",
            {"elongation", "breaking_load"},
            {"stiffness"},
            {"elongation", "permanent_elongation"},
        ),
        ("cable", {"elongation"}, {"permanent_elongation"}, set()),
        ("chain", {"weight"}, {"mass"}, {"weight"}),
        ("chain", {"weight"}, {"weight"}, set()),
        ("anchor", {"weight", "mass"}, {"mass"}, {"weight"}),
        ("anchor", {"weight", "mass"}, {"length"}, set()),
        # The drag of a body.
        ("body", {"kn", "kt"}, {"drag_area", "cd"}, DRAG - {"drag_area", "cd"}),
        ("body", {"drag_area", "cd"}, {"cd"}, set()),
        ("body", {"drag_area", "cd"}, {"kn", "kt"}, DRAG - {"kn", "kt"}),
        ("body", {"drag_area", "cd"}, {"kt"}, set()),
        ("body", {"drag_measurements", "kt"}, {"made_of"}, DRAG - {"made_of"}),
    ],
)
def test_void(kind: str, base: set[str], override: set[str], void: set[str]) -> None:
    assert contradicted(kind, base, override) == void
