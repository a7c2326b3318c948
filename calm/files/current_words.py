"""What the variables of a dataset say of themselves: their frame, their quantity, their north.

A name is a custom of a program; the attributes are what the person who wrote the file says of it.
Where they name another frame or quantity than the name suggests, they are believed.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray as xr

_FRAMES = ("coord_sys", "coordinate_system", "reference_frame", "frame")
_TO_THE_EARTH = re.compile(r"earth|\benu\b|geographic|east|true")
_OTHER_FRAME = re.compile(r"beam|\binst|xyz|ship|head|vessel|body|vehicle|principal|stream|local")

_OTHER_DIRECTIONS = (
    r"\bbeam ?[1-5]?\b(?! ?(averag|mean|width))",
    r"\b(along|cross|across) ?(shore|shelf|slope|isobath|channel|stream|track|ship|axis|front)\b",
    r"\b(stream|span)wise\b|\bcross stream\b",
    r"\bprincipal\b|\b(major|minor) axis\b",
    r"\b(instrument|xyz|ship|vessel|vehicle|sensor|body|platform|glider|head) ?"
    r"(frame|coordinates?|axis|axes|reference)\b",
    r"\b(forward|starboard|portside|radial)\b",
    r"\brotated\b(?!.*\b(to|into|in) (the )?(earth|true|geograph|enu|east))",
)
_OTHER_QUANTITIES = (
    r"\b(standard|std) ?(deviation|dev|error)\b|\bstd ?(err)?\b|\bstd?dev\b|\b(rms|variance)\b",
    r"\berror velocity\b|\buncertainty\b|\bnoise\b",
    r"\banomal(y|ies)\b|\bpercent\b|\bquality\b|\bstatus\b|\bcorrelation\b|\bintensity\b",
    r"\b(winds?|ice|stokes|air)\b",
    r"\b(geostrophic|baroclinic|barotropic|ageostrophic)\b",
    r"\b(depth|vertically) ?(mean|averaged|integrated)\b",
    r"\b(transport|flux|shear|stress|acceleration|amplitude|phase|gradient|vorticity)\b",
    r"\b(ship|vessel|platform|bottom ?track|gps|drifter|buoy|glider)s? (velocity|speed|motion)\b",
    r"\bvelocity of (the )?(ship|vessel|platform|drifter|buoy|glider)\b",
)
_NOT_A_CURRENT = [re.compile(text) for text in _OTHER_DIRECTIONS + _OTHER_QUANTITIES]

_MAGNETIC = re.compile(r"\bmag(netic)?\b")
_UNCORRECTED = re.compile(
    r"\b(not|un|no|without)\b.{0,30}(correct|appl|declination|variation)|\buncorrected\b"
)
_CORRECTED = re.compile(
    r"correct|appl(y|ied)|declination|variation|deviation|\b(to|into) (the )?true\b"
)
_TOWARD = re.compile(r"\bto direction\b|\btowards?\b|\bflow(s|ing)? to\b|\bgoing to\b|\bset\b")
_FROM = re.compile(r"\bfrom direction\b|\bdirection from\b|\bcom(es|ing) from\b|\bfrom which\b")


def words_of(variable: xr.DataArray, *attributes: str) -> str:
    """Some attributes of a variable as plain lower-case words, one blank between them."""
    told = " ".join(str(variable.attrs.get(name, "")) for name in attributes)
    return re.sub(r"[\W_]+", " ", told.lower()).strip()


def not_a_current(variable: xr.DataArray) -> str | None:
    """Why a variable is no velocity of the water to the east, the north or up; None if it may be.

    Only what it says of itself counts: its long name, standard name and frame.
    """
    own = words_of(variable, "long_name", "standard_name")
    if any(pattern.search(own) for pattern in _NOT_A_CURRENT):
        said = variable.attrs.get("long_name") or variable.attrs.get("standard_name")
        return f"is `{said}`, which is no current to the east and north"
    return other_frame(variable.attrs)


def other_frame(attributes: Mapping[Any, Any]) -> str | None:
    """Why a current is not to the east and north, by its coordinate system; None if it may be.

    Parameters
    ----------
    attributes : those of a dataset or of a variable
    """
    for name in _FRAMES:
        frame = str(attributes.get(name, "")).lower()
        if _OTHER_FRAME.search(frame) and not _TO_THE_EARTH.search(frame):
            return (
                f"is in other coordinates, `{name}: {attributes[name]}`, not to the east and "
                "north; rotate it to the earth's first"
            )
    return None


def is_magnetic(variable: xr.DataArray) -> bool:
    """Whether a velocity or direction counts from magnetic north, as it says itself."""
    if _MAGNETIC.search(re.sub(r"_", " ", str(variable.name).lower())):
        return True
    own = words_of(
        variable, "long_name", "standard_name", "reference_datum", "units", "comment", "reference"
    )
    if not _MAGNETIC.search(own):
        return False
    return bool(_UNCORRECTED.search(own)) or not _CORRECTED.search(own)


def way_of(variable: xr.DataArray) -> str | None:
    """Whether a direction is where the current flows ``"to"`` or comes ``"from"``, in its words."""
    own = words_of(variable, "long_name", "standard_name", "comment")
    toward, origin = _TOWARD.search(own), _FROM.search(own)
    if bool(toward) == bool(origin):
        return None
    return "to" if toward else "from"
