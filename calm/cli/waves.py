"""``calm waves``: estimate tensions and motions of a mooring in waves."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from calm.cli import options
from calm.cli.outputs import ExitCode, Outputs, narrate
from calm.cli.progress import progress
from calm.errors import NoEquilibrium, UsageError

if TYPE_CHECKING:
    from calm.records.sea_states import SeaState


def waves(
    file: options.MooringPath,
    /,
    *,
    environment: options.EnvironmentName = None,
    catalog: options.CatalogFiles = None,
    hs: options.Signed = None,
    tp: options.Signed = None,
    spectrum: str = "bretschneider",
    toward: options.Signed = None,
    scatter: Path | None = None,
    duration: str = "3 h",
    json: options.JsonAnswer = None,
    report: Path | None = None,
    units: options.Units = None,
) -> ExitCode:
    """Estimate the tensions and motions of a mooring in waves.

    The model is linear: it computes small motions about the shape in the mean
    current. The linear drag dissipates the same power as the quadratic drag. A
    linear model is not valid if a piece goes slack; the status is then
    slack-in-waves, and the exit code is 3.

    Without --hs, --scatter or a file for --spectrum, CALM uses the sea states
    under `waves:` in the environment, which may also specify a swell and a
    peakedness.

    Parameters
    ----------
    hs
        Significant wave height, such as "5 m".
    tp
        Peak period, such as "8.4 s", which is about 1.41 times the mean zero-crossing
        period Tz. For the spectrum pierson-moskowitz, the default is the peak period of
        a fully developed sea; the spectrum ochi-hubble does not use a peak period.
    spectrum
        Wave spectrum: bretschneider, jonswap, pierson-moskowitz, ochi-hubble (swell and sea), or a
        file with a measured spectrum: CSV with frequency[Hz],density[m^2/Hz], or NetCDF.
    toward
        Direction in which the waves travel, clockwise from north; 90 deg by default.
    scatter
        CSV file of sea states: significant_wave_height[m],peak_period[s],share.
    duration
        Duration over which the most probable maximum and minimum tension occur; 3 h by default.
    report
        Folder for waves.html and waves.pdf, with plots of the tension.

    Examples
    --------
      calm waves buoy.yaml --hs "5 m" --tp "8.4 s"
      calm waves buoy.yaml --hs "3 m" --tp "7 s" --spectrum jonswap --toward "45 deg"
      calm waves buoy.yaml --scatter site.csv --json waves.json
      calm waves buoy.yaml --spectrum measured.csv
    """
    outputs = Outputs((file,), json)
    from calm.case import load
    from calm.records.sea_states import OF_HEIGHT
    from calm.report import folder, sea_response
    from calm.waves.analysis import SLACK, analyse

    if report is not None:
        folder.check_folder(report)
    of_options, direction, length = _sea_states(
        {"hs": hs, "tp": tp}, spectrum, toward, scatter, duration
    )
    mooring = load(file, environment, catalog or [])
    leg = mooring.moored
    given, seas = mooring.file.environment.waves, of_options or mooring.file.environment.seas
    if not seas:
        missing = "--hs is" if spectrum in OF_HEIGHT else "--hs and --tp are"
        raise UsageError(
            f"{missing} missing; alternatively, use --scatter, or add `waves:` to {file}"
        )
    if direction is None:
        direction = 90.0 if given is None else given.toward
    options.show_units(units, [mooring.file])
    try:
        analysis = analyse(leg, seas, direction, length, lambda each: progress(each, "seas"))
    except NoEquilibrium as failure:
        answer = {"name": mooring.file.name, **failure.to_dict()}
        outputs.write_answer(lambda: answer, None)
        narrate(f"{file}: {failure.status}: {failure.message} {failure.advice}")
        return ExitCode.NO_EQUILIBRIUM
    outputs.write_answer(analysis.to_dict, sea_response.sea_response_part(analysis))
    if report is not None:
        folder.write_pages(report, "waves", sea_response.sea_response_report(analysis))
    if analysis.status != SLACK:
        return ExitCode.DONE
    narrate(
        f"{file}: {SLACK}: the line goes slack, so the linear tensions are not "
        "valid. Add weight, use a more elastic line, or simulate the mooring in the time domain "
        "(`calm export --to moordyn`)."
    )
    return ExitCode.NO_EQUILIBRIUM


def _sea_states(
    waves: dict[str, str | None],
    spectrum: str,
    toward: str | None,
    scatter: Path | None,
    duration: str,
) -> tuple[list[SeaState] | None, float | None, float]:
    """Read the sea states, their direction [degrees] and duration [s]. States and direction are
    None if not specified.
    """
    from calm.errors import nearest
    from calm.records import sea_states

    given = options.quantities(
        hs=(waves["hs"], "length"),
        tp=(waves["tp"], "time"),
        toward=(toward, "angle"),
        duration=(duration, "time"),
    )
    complaints = [
        f"{options.option(name)}: must be above 0"
        for name in (*waves, "duration")
        if name in given and not given[name] > 0.0
    ]
    if 0.0 < given["duration"] < 60.0:
        complaints.append("--duration must be at least one minute")
    named, path = spectrum in sea_states.SPECTRA, Path(spectrum)
    if not named and not path.is_file():
        near = nearest(spectrum, sea_states.SPECTRA)
        suggestion = f"; did you mean `{near}`?" if near else ""
        names = ", ".join(sea_states.SPECTRA)
        complaints.append(f"--spectrum: `{spectrum}` is neither {names} nor a file{suggestion}")
    chosen = [options.option(name) for name, each in waves.items() if each is not None]
    if scatter is not None and (chosen or not named):
        complaints.append(
            "a --scatter file already contains heights and periods; omit "
            f"{', '.join(chosen) or 'the spectrum file'}"
        )
    elif scatter is None and path.is_file() and not named and chosen:
        complaints.append(
            f"a measured spectrum has its own height and period; omit {', '.join(chosen)}"
        )
    elif scatter is None and named and (chosen or spectrum != "bretschneider"):
        needs = ["--hs", *(["--tp"] if spectrum not in sea_states.OF_HEIGHT else [])]
        if missing := [name for name in needs if name not in chosen]:
            complaints.append(f"missing: {', '.join(missing)}; alternatively, use --scatter")
    if complaints:
        raise UsageError("\n".join(complaints))
    seas = None
    if scatter is not None:
        seas = sea_states.scatter_states(scatter, spectrum)
    elif not named:
        seas = [sea_states.measured_spectrum(path)]
    elif chosen:
        seas = [sea_states.spectrum_of(spectrum, given["hs"], given.get("tp"))]
    return seas, given.get("toward"), given["duration"]
