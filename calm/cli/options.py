"""Options that several commands have, and parsing of options with units."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from calm.cli.outputs import narrate
from calm.errors import UsageError

if TYPE_CHECKING:
    import numpy as np

    from calm.files import MooringFile

CatalogFiles = Annotated[
    list[Path] | None,
    Parameter(
        help="Additional catalogue file; its components replace those with the same id. Repeatable."
    ),
]
MooringPath = Annotated[Path, Parameter(help="Mooring file.")]
MooringPaths = Annotated[list[Path], Parameter(help="Mooring files.")]
EnvironmentName = Annotated[
    str | None,
    Parameter(help="Use this environment: a name from the mooring file, or an environment file."),
]
Samples = Annotated[int, Parameter(help="Number of samples, which must be a power of two.")]
Threads = Annotated[
    int | None, Parameter(help="Number of threads; by default one for each processor.")
]
Declination = Annotated[
    str | None,
    Parameter(
        help="Magnetic declination, such as 12.5 deg, positive to the east. It is applied "
        "to currents that the record marks as relative to magnetic north.",
        allow_leading_hyphen=True,
    ),
]
OutputFile = Annotated[Path, Parameter(alias="-o")]
JsonAnswer = Annotated[
    Path | None,
    Parameter(help="Write the result as JSON (- for standard output).", allow_leading_hyphen=True),
]
Signed = Annotated[str | None, Parameter(allow_leading_hyphen=True)]
"""Option whose value may be a negative quantity; the minus sign does not start another option."""
Units = Annotated[
    str | None,
    Parameter(
        help="Units for tables and reports, such as force=kgf,length=ft,speed=kn,mass=lb; by "
        "default, the units set in the file. JSON, CSV and NetCDF are always in SI."
    ),
]


def option(name: str) -> str:
    """Return the command-line spelling of a parameter."""
    return f"--{name.replace('_', '-')}"


def show_units(given: str | None, files: Iterable[MooringFile] = ()) -> None:
    """Set the units of tables and reports from an option or, without the option, from the files.

    Files with different units give SI. Raises UsageError if a dimension or unit is unknown.
    """
    from calm.errors import nearest
    from calm.files.logbook import nearest_unit
    from calm.quantities import SHOWN_UNITS, show_in

    if given is None:
        systems = [file.units for file in files]
        all_equal = all(one == systems[0] for one in systems)
        if not all_equal:
            narrate("the files set different units; results are in SI (use --units to choose)")
        show_in(systems[0] if systems and all_equal else {})
        return
    chosen: dict[str, str] = {}
    for part in given.split(","):
        name, _, unit = (text.strip() for text in part.partition("="))
        if unit not in (known := SHOWN_UNITS.get(name, {})):
            near = nearest(unit, known)
            if suggestion := (name, near) if near else nearest_unit(unit or name):
                name, unit = suggestion
                raise UsageError(f"--units: for `{part.strip()}` write `{name}={unit}`")
            forms = (f"{each}={'|'.join(units)}" for each, units in SHOWN_UNITS.items())
            raise UsageError(f"--units: `{part.strip()}` must be one of {', '.join(forms)}")
        chosen[name] = unit
    show_in(chosen)


def quantities(**given: tuple[str | None, str]) -> dict[str, float]:
    """Convert quantities given as options to SI units and degrees.

    Each keyword gives the text of one option and the dimension of its quantity. The text is None if
    the option is absent. The result has the values by keyword. Raises UsageError; its message lists
    all invalid texts.
    """
    from calm.units import QuantityError, parse_quantity

    values: dict[str, float] = {}
    complaints: list[str] = []
    for name, (text, dimension) in given.items():
        if text is None:
            continue
        try:
            values[name] = parse_quantity(text, dimension)
        except QuantityError as error:
            complaints.append(f"{option(name)}: `{text}` {error}")
    if complaints:
        raise UsageError("; ".join(complaints))
    return values


def from_one(**given: int | None) -> None:
    """Raise UsageError if a count is below 1. The message lists all such counts."""
    few = {name: count for name, count in given.items() if count is not None and count < 1}
    if few:
        complaints = (f"{option(name)}: {count} is below 1" for name, count in few.items())
        raise UsageError("; ".join(complaints))


def span_of(option: str, text: str, between: tuple[float, float], in_words: str) -> np.timedelta64:
    """Parse a duration given as an option, such as ``2 h``.

    `between` is the allowed range [s], and `in_words` is the text for this range in the message.
    Raises UsageError if the text is not a duration in this range.
    """
    import numpy as np

    from calm.units import QuantityError, parse_quantity

    try:
        seconds = parse_quantity(text, "time", usual_unit="h")
    except QuantityError as error:
        raise UsageError(f"{option}: `{text}` {error}") from None
    if not between[0] <= seconds <= between[1]:
        raise UsageError(f"{option}: `{text}` is not between {in_words}")
    return np.timedelta64(round(seconds * 1e9), "ns")


def draws_of(uncertainty: bool, samples: int) -> tuple[int, int] | None:
    """Return the number of samples and the seed for `--uncertainty`; None without this option.

    Raises UsageError if the number of samples is not a power of two, or is given without
    `--uncertainty`.
    """
    from calm.case.draws import SAMPLES, checked_samples

    if not uncertainty:
        if samples != SAMPLES:
            raise UsageError(f"--samples: {samples} needs --uncertainty")
        return None
    return checked_samples(samples), 0
