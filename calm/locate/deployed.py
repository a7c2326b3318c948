"""What was located, written into the mooring file that it was for."""

from __future__ import annotations

from pathlib import Path

from calm.errors import UsageError
from calm.files import read_mooring
from calm.files.editing import Draft, EditError, WorkingFile
from calm.locate.fit import Located


def with_deployed(path: Path, located: Located, water_depth: float) -> tuple[WorkingFile, str]:
    """A mooring file, and its text with the place in its `deployed`.

    All else stays byte for byte: comments, and what `deployed` says besides.

    Parameters
    ----------
    water_depth : at the anchor [m]

    Raises
    ------
    InputError
        The file has mistakes.
    UsageError
        It is a tow, or written in a way that does not allow this change.
    """
    before = read_mooring(path)
    if before.tow is not None:
        raise UsageError(f"{path} is a tow; what is deployed is a mooring")
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
    return file, draft.text
