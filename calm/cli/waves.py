"""``calm waves``: what the sea adds to the tensions of a mooring."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from calm.cli.options import CatalogFiles, EnvironmentName, Units, quantities, show_units
from calm.cli.outputs import OutputPath, Outputs
from calm.cli.streams import ExitCode, narrate
from calm.errors import NoEquilibrium, UsageError

if TYPE_CHECKING:
    from calm.records.sea_states import SeaState

Signed = Annotated[str | None, Parameter(allow_leading_hyphen=True)]

WAVES_EXAMPLES = """Examples:

  calm waves buoy.yaml --hs "5 m" --tp "8.4 s"
  calm waves buoy.yaml --hs "2 m" --tp "6 s" --swell "3 m" --swell-tp "14 s"
  calm waves buoy.yaml --hs "3 m" --tp "7 s" --spectrum jonswap --toward "45 deg"
  calm waves buoy.yaml --scatter site.csv --json waves.json
  calm waves buoy.yaml --spectrum measured.csv"""


def waves(
    file: Path,
    /,
    *,
    environment: EnvironmentName = None,
    catalog: CatalogFiles = None,
    hs: Signed = None,
    tp: Signed = None,
    spectrum: str = "bretschneider",
    gamma: float = 3.3,
    swell: Signed = None,
    swell_tp: Signed = None,
    toward: Signed = None,
    scatter: Path | None = None,
    duration: str = "3 h",
    json: OutputPath = None,
    report: Path | None = None,
    units: Units = None,
) -> ExitCode:
    """Estimate tensions and motions of a mooring in waves, about its equilibrium.

    Linear: small waves about the shape in the mean current, drag linearised to
    what it dissipates. Where a piece falls slack this no longer holds: the status
    is slack-in-waves and the exit code 3. Without --hs, --scatter or a file as the
    --spectrum the seas are those of `waves:` of the environment.

    Parameters
    ----------
    file
        A mooring file.
    hs
        Significant wave height, such as "5 m".
    tp
        Period of the peak, such as "8.4 s"; that of a full sea for
        pierson-moskowitz, and left out for ochi-hubble, of swell and sea.
    spectrum
        bretschneider, jonswap, pierson-moskowitz, ochi-hubble, or a file of a
        measured one: CSV of frequency[Hz],density[m^2/Hz], or NetCDF.
    gamma
        Peakedness of jonswap.
    swell, swell_tp
        A swell under the sea of --hs, running the same way: its significant height
        and the period of its peak.
    toward
        Where the waves run, clockwise from north; 90 deg unless given.
    scatter
        A CSV file of seas: significant_wave_height[m],peak_period[s],share.
    duration
        Of the greatest and the least tension.
    json
        Write the answer as JSON, - to print it.
    report
        A folder for waves.html and waves.pdf, with pictures of the tension.
    """
    outputs = Outputs((file,), json)
    import calm
    from calm.case import Tow
    from calm.cli.progress import progress
    from calm.records.sea_states import OF_HEIGHT
    from calm.report.folder import check_folder, printed, write_report
    from calm.report.html import page
    from calm.report.sea_response import sea_response_part, sea_response_report
    from calm.waves.analysis import SLACK, analyse

    if report is not None:
        check_folder(report)
    asked, way, length = _asked(
        {"hs": hs, "tp": tp, "swell": swell, "swell-tp": swell_tp},
        spectrum, gamma, toward, scatter, duration,
    )  # fmt: skip
    mooring = calm.load(file, environment=environment, catalogs=catalog or [])
    if isinstance(mooring, Tow):
        raise UsageError(f"{file} is a tow; calm waves judges moorings")
    given, seas = mooring.file.environment.waves, asked or mooring.file.environment.seas
    if not seas:
        missing = "--hs: missing" if spectrum in OF_HEIGHT else "--hs, --tp: missing"
        raise UsageError(f"{missing}; or give a --scatter table, or `waves:` in {file}")
    if way is None:
        way = 90.0 if given is None else given.toward
    show_units(units, [mooring.file])
    try:
        analysis = analyse(mooring, seas, way, length, lambda each: progress(each, "seas"))
    except NoEquilibrium as failure:
        answer = {"name": mooring.file.name, **failure.to_dict()}
        outputs.write_answer(lambda: answer, None)
        narrate(f"{file}: {failure.status}: {failure.message} {failure.advice}")
        return ExitCode.NO_EQUILIBRIUM
    outputs.write_answer(analysis.to_dict, sea_response_part(analysis))
    if report is not None:
        said = sea_response_report(analysis)
        write_report(report, {"waves.html": page(said).encode(), "waves.pdf": printed(said)})
    if analysis.status != SLACK:
        return ExitCode.DONE
    narrate(
        f"{file}: {SLACK}: the least tension falls below 0, where linear tensions do not hold. "
        "Give it more weight or more stretch; or `calm export --to moordyn`, to solve it in time."
    )
    return ExitCode.NO_EQUILIBRIUM


def _asked(
    waves: dict[str, str | None],
    spectrum: str,
    gamma: float,
    toward: str | None,
    scatter: Path | None,
    duration: str,
) -> tuple[list[SeaState] | None, float | None, float]:
    """Return the seas, where they run [degrees], and how long they last [s]; None: not said.

    Raises
    ------
    UsageError
        With all that is wrong with the options.
    """
    from calm.errors import nearest
    from calm.records import sea_states

    given = quantities(
        {
            "hs": (waves["hs"], "length"),
            "tp": (waves["tp"], "time"),
            "swell": (waves["swell"], "length"),
            "swell-tp": (waves["swell-tp"], "time"),
            "toward": (toward, "angle"),
            "duration": (duration, "time"),
        }
    )
    complaints = [
        f"--{name}: must be above 0"
        for name in (*waves, "duration")
        if name in given and not given[name] > 0.0
    ]
    if not 1.0 <= gamma <= 10.0:
        complaints.append("--gamma: from 1, of a full sea, to 10")
    named, path = spectrum in sea_states.SPECTRA, Path(spectrum)
    if not named and not path.is_file():
        near = nearest(spectrum, sea_states.SPECTRA)
        meant = f"; did you mean `{near}`?" if near else ""
        complaints.append(
            f"--spectrum: `{spectrum}` is neither {', '.join(sea_states.SPECTRA)} nor a file{meant}"
        )
    chosen = [f"--{name}" for name, each in waves.items() if each is not None]
    swells = [name for name in ("--swell", "--swell-tp") if name in chosen]
    if len(swells) == 1:
        complaints.append("--swell, --swell-tp: a swell has both a height and a period")
    if scatter is not None and (chosen or not named):
        complaints.append(
            f"--scatter: gives heights and periods; leave {', '.join(chosen) or 'the file'} out"
        )
    elif scatter is None and not named and chosen:
        complaints.append(f"{', '.join(chosen)}: a measured spectrum has its own")
    elif scatter is None and named and (chosen or spectrum != "bretschneider"):
        needs = ["--hs", *(["--tp"] if spectrum not in sea_states.OF_HEIGHT else [])]
        if missing := [name for name in needs if name not in chosen]:
            complaints.append(f"{', '.join(missing)}: missing; or give a --scatter table")
    if complaints:
        raise UsageError("\n".join(complaints))
    seas = None
    if scatter is not None:
        seas = sea_states.scatter_states(scatter, spectrum, gamma)
    elif not named:
        seas = [sea_states.measured_spectrum(path)]
    elif chosen:
        seas = [sea_states.spectrum_of(spectrum, given["hs"], given.get("tp"), gamma)]
        if swells:
            seas = [sea_states.with_swell(seas[0], given["swell"], given["swell-tp"])]
    return seas, given.get("toward"), given["duration"]
