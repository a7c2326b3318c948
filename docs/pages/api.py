"""Public Python interface of CALM, by autodoc."""

HEAD = """# Python API

The names that a program imports, from their docstrings. [CALM in Python](python.md) shows how to
use them. Quantities are in SI units, angles in degrees; arrays are NumPy's, with their shapes in
brackets.
"""
_SECTIONS = {
    "Read, solve, check": ["calm.load", "calm.check"],
    "Designs": ["calm.Design", "calm.Result", "calm.case.leg.Leg", "calm.LegResult"],
    "Parts of a result": [
        "calm.case.result_tables.Components", "calm.case.result_tables.Clamps",
        "calm.case.result_tables.Shape",
        "calm.case.result_tables.Top", "calm.case.result_tables.AnchorLoad",
        "calm.case.result_tables.TowPoint", "calm.case.result_tables.TowedBody",
        "calm.case.result_tables.EndLoad", "calm.case.result_tables.NodePlace",
        "calm.case.result_tables.Accuracy",
        "calm.case.strumming.Strumming", "calm.case.strumming.StrummingBand",
    ],
    "Many profiles": ["calm.solve_profiles", "calm.Profiles"],
    "Motion": ["calm.estimate_motion", "calm.MotionEstimate"],
    "Gridded records": ["calm.grid", "calm.GriddedRecord"],
    "Errors": [
        "calm.CalmError", "calm.InputError", "calm.UsageError", "calm.NoEquilibrium",
        "calm.errors.Problem",
    ],
}  # fmt: skip


def page() -> str:
    """The text of the page."""
    parts = [HEAD]
    for title, names in _SECTIONS.items():
        parts.append(f"## {title}\n\n```{{eval-rst}}")
        for name in names:
            kind = "class" if name.rpartition(".")[2][0].isupper() else "function"
            members = "\n   :members:" if kind == "class" else ""
            parts.append(f".. auto{kind}:: {name}{members}\n")
        parts.append("```\n")
    return "\n".join(parts)
