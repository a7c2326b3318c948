"""What was located, written into the mooring file that it was for."""

from __future__ import annotations

from math import hypot
from pathlib import Path

import numpy as np

from calm.errors import UsageError
from calm.files import MooringFile, read_mooring
from calm.files.editing import Draft, EditError, WorkingFile
from calm.locate.range_fit import Located
from calm.positions import Frame, read_as_minutes
from calm.quantities import bearing_of, bearing_text

FAR = 2.0
"""Times the depth of the water from the planned position: farther than an anchor is laid astray."""
NEAR = 0.5
"""Share of the distance as written, within which degrees read as degrees and minutes are meant."""
DEEPER = 0.05
"""Share by which the depth may differ from the planned one without a word of doubt."""


def located_mooring(path: Path) -> MooringFile:
    """Return the mooring file that a place is for.

    Raises
    ------
    InputError
        The file has mistakes.
    UsageError
        It is a tow.
    """
    file = read_mooring(path)
    if file.tow is not None:
        raise UsageError(f"{path} is a tow; what is deployed is a mooring")
    return file


def with_deployed(
    path: Path, before: MooringFile, located: Located, water_depth: float
) -> tuple[WorkingFile, str, tuple[str, ...], tuple[str, ...]]:
    """Return a mooring file, its text with the place in its `deployed`, how far that is from the
    plan, and what of that is in doubt.

    All else stays byte for byte: comments, and what `deployed` says besides.

    Parameters
    ----------
    before : the file as read, see `located_mooring`
    water_depth : at the anchor [m]

    Raises
    ------
    InputError
        The file has mistakes with the place in it.
    UsageError
        It is written in a way that does not allow this change, or planned to stand where
        latitude and longitude are exchanged.
    """
    said, doubts = _beside_the_plan(before, located, water_depth)
    file = WorkingFile(path)
    position = {
        "latitude": f"{located.latitude:.6f} deg",
        "longitude": f"{located.longitude:.6f} deg",
    }
    try:
        draft = Draft(file.read())
        draft = draft.put_at(("deployed", "position"), position)
        draft = draft.put_at(("deployed", "depth"), f"{water_depth:.1f} m")
    except EditError as error:
        raise UsageError(f"{path}: {error}") from None
    read_mooring(path, text=draft.text)
    return file, draft.text, said, doubts


def _beside_the_plan(
    file: MooringFile, located: Located, water_depth: float
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return where the anchor stands from its planned position, how much deeper, and the doubts."""
    planned, plan_depth = file.position, file.environment.depth
    assert plan_depth is not None  # of a mooring
    deeper = water_depth - plan_depth
    said = [f"{abs(deeper):.1f} m {'deeper' if deeper >= 0.0 else 'less deep'} than planned"]
    if abs(deeper) > DEEPER * plan_depth:
        said.append("the depth is far from the planned one: is it right?")
    if planned is None:
        return tuple(said), ()
    frame = Frame(planned.latitude, planned.longitude)

    def away(latitude: float, longitude: float) -> float:
        place = frame.place(np.array(latitude), np.array(longitude), np.array(0.0))
        return float(np.linalg.norm(place[:2]))

    there = located.latitude, located.longitude
    east, north, _ = frame.place(np.array(there[0]), np.array(there[1]), np.array(0.0)).tolist()
    distance = hypot(east, north)
    said.insert(0, f"{distance:.0f} m towards {bearing_text(bearing_of(east, north))} of the "
                "planned position")  # fmt: skip
    limit = FAR * max(water_depth, plan_depth)
    if distance <= limit:
        return tuple(said), ()
    if abs(there[1]) <= 90.0 and away(there[1], there[0]) <= limit:
        raise UsageError(
            f"{located.survey.path}: latitude and longitude are exchanged: the anchor "
            f"would stand {distance / 1000.0:.0f} km from the position in {file.path}"
        )
    doubt = f"the place is {distance / 1000.0:.1f} km from the planned position"
    if away(*map(read_as_minutes, there)) <= NEAR * distance:
        doubt += ", and near it if the positions are degrees and minutes, as 48 18 for 48.18"
    said.append("that is far from the planned position: is it this mooring's?")
    return tuple(said), (doubt,)
