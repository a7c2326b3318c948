"""Locate files installed with CALM: component catalogue, example lines, manual and templates.

In an installation the first three are inside the package; in a checkout they are next to the
package.
"""

import importlib.resources
from pathlib import Path
from typing import Literal


def shipped_folder(name: Literal["catalog", "lines", "docs"]) -> Path:
    """Return the folder of the shipped catalogue, example lines or manual.

    Raises
    ------
    FileNotFoundError
        The installation is incomplete.
    """
    package = Path(str(importlib.resources.files("calm")))
    for folder in (package / "_shipped" / name, package.parent / name):
        if folder.is_dir():
            return folder
    raise FileNotFoundError(f"CALM's folder `{name}` is missing; install CALM again")


Template = Literal["shelf", "deep", "adcp-frame", "taut-surface", "slack-surface", "tow"]

TEMPLATES: dict[Template, str] = {
    "shelf": "current meter and temperature sensors on a wire, 300 m",
    "deep": "current meters on wire and rope with glass floats, 4000 m",
    "adcp-frame": "upward-looking ADCP near the seabed, 90 m",
    "taut-surface": "buoy on wire and nylon, 2000 m",
    "slack-surface": "marker buoy on chain and floating rope, 60 m",
    "tow": "towed body; the wire length is found for a required depth",
}
"""Kinds of template moorings, with descriptions. No template accepts an unknown value, because this
decision belongs to the person who signs the design.
"""


def template(kind: Template) -> str:
    """Return the text of the template for a kind of mooring."""
    folder = importlib.resources.files("calm") / "templates"
    return (folder / f"{kind}.yaml").read_text(encoding="utf-8")
