"""What was located, written into the mooring file that it was for."""

from __future__ import annotations

from math import hypot
from pathlib import Path

import numpy as np

from calm.errors import UsageError
from calm.files import MooringFile, read_mooring
from calm.files.editing import Draft, EditError, WorkingFile
from calm.locate.range_fit import Located
from calm.physics.ellipsoid import Frame
from calm.physics.line import Floats
from calm.quantities import bearing_of, bearing_text

FAR = 2.0
"""Times the depth of the water from the planned position: farther than an anchor is laid astray."""
DEEPER = 0.05
"""Share by which the depth may differ from the planned one without a word of doubt."""


def with_deployed(
    path: Path, located: Located, water_depth: float
) -> tuple[WorkingFile, str, tuple[str, ...]]:
    """Return a mooring file, its text with the place in its `deployed`, and how far that is from
    the plan.

    All else stays byte for byte: comments, and what `deployed` says besides.

    Parameters
    ----------
    water_depth : at the anchor [m]

    Raises
    ------
    InputError
        The file has mistakes.
    UsageError
        It is a tow, written in a way that does not allow this change, or planned to stand where
        latitude and longitude are exchanged.
    """
    before = read_mooring(path)
    if before.tow is not None:
        raise UsageError(f"{path} is a tow; what is deployed is a mooring")
    said = _beside_the_plan(before, located, water_depth)
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
    return file, draft.text, said


def _beside_the_plan(file: MooringFile, located: Located, water_depth: float) -> tuple[str, ...]:
    """Return where the anchor stands from its planned position, and how much deeper."""
    planned, plan_depth = file.position, file.environment.depth
    assert plan_depth is not None  # of a mooring
    deeper = water_depth - plan_depth
    said = [f"{abs(deeper):.1f} m {'deeper' if deeper >= 0.0 else 'less deep'} than planned"]
    if abs(deeper) > DEEPER * plan_depth:
        said.append("the depth is far from the planned one: is it right?")
    if planned is not None:
        frame = Frame(planned.latitude, planned.longitude)

        def away(latitude: float, longitude: float) -> Floats:
            place: Floats = frame.place(np.array(latitude), np.array(longitude), np.array(0.0))
            return place

        east, north, _ = away(located.latitude, located.longitude).tolist()
        distance = hypot(east, north)
        limit = FAR * max(water_depth, plan_depth)
        if distance > limit and abs(located.longitude) <= 90.0:
            exchanged = away(located.longitude, located.latitude)
            if float(np.linalg.norm(exchanged[:2])) <= limit:
                raise UsageError(
                    f"{located.survey.path}: latitude and longitude are exchanged: the anchor "
                    f"would stand {distance / 1000.0:.0f} km from the position in {file.path}"
                )
        toward = bearing_of(east, north)
        said.insert(0, f"{distance:.0f} m towards {bearing_text(toward)} of the planned position")
        if distance > limit:
            said.append("that is far from the planned position: is it this mooring's?")
    return tuple(said)
