"""Commented moorings to begin with, one of each kind.

None accepts a figure that is not known: that is for whoever signs the design.
"""

from typing import Literal

Template = Literal["shelf", "deep", "adcp-frame", "taut-surface", "slack-surface", "tow"]

TEMPLATES: dict[Template, str] = {
    "shelf": "current meter and temperatures along a wire, 300 m",
    "deep": "current meters on wire and rope, glass between, 4000 m",
    "adcp-frame": "ADCP that looks up from near the seabed, 90 m",
    "taut-surface": "buoy on wire and nylon, 2000 m",
    "slack-surface": "marker buoy on chain and floating rope, 60 m",
    "tow": "body behind a ship, at the depth wanted",
}
"""What each is."""


def template(kind: Template) -> str:
    """Return the text of the file of a kind."""
    from importlib.resources import files

    return (files("calm.templates") / f"{kind}.yaml").read_text(encoding="utf-8")
