"""``calm verify``: compare CALM with published, analytical and measured values."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice
from typing import TYPE_CHECKING, Any

from calm.cli.outputs import ExitCode, OutputPath, Outputs
from calm.cli.progress import progress
from calm.errors import UsageError

if TYPE_CHECKING:
    from calm.verification import Source


def verify(
    words: list[str] | None = None, /, *, field: bool = False, json: OutputPath = None
) -> ExitCode:
    """Verify CALM against published and analytical results.

    Each expected value is published, comes from a closed form or an independent
    integration, or is a property that every line must have. Values that agree by
    construction are checked but not counted. The exit code is 1 if a value is out
    of tolerance.

    Parameters
    ----------
    words
        Check only cases whose source or name contains all these words (or parts of words).
    field
        Instead of these cases, estimate the depths of withheld sensors on a real mooring, and
        compare them with the measured depths (see `calm docs motion`).
    json
        Write the values, with the reason for each tolerance, as JSON (- for standard output).

    Examples
    --------
      calm verify
      calm verify cdms tension
      calm verify braconnot --json -
      calm verify --field
    """
    from calm.report.verification import verification_document, verification_part
    from calm.solve import expect_many

    outputs = Outputs(json=json)
    if field:
        if words:
            raise UsageError("--field cannot be combined with search words")
        return verify_field(outputs)
    chosen = _chosen_sources(words or [])
    cases = [case for source in chosen for case in source.cases]
    expect_many(len(cases))
    outcomes = iter([case.check() for case in progress(cases, "figures")])
    findings = [(source, list(islice(outcomes, len(source.cases)))) for source in chosen]
    document = verification_document(findings)
    outputs.write_answer(lambda: document, verification_part(findings))
    return ExitCode.FINDING if document["out"] else ExitCode.DONE


def _chosen_sources(words: Sequence[str]) -> list[Source]:
    from calm.verification import SOURCES

    chosen = [source for source in (each.having(words) for each in SOURCES) if source.cases]
    if not chosen:
        titles = "; ".join(source.title for source in SOURCES)
        raise UsageError(f"no case has {' and '.join(words)}; the sources are: {titles}")
    return chosen


WITHHELD = tuple(f"Aquadopp {height}" for height in (526, 426, 326, 226, 126))
MEAN_RATIO, MAX_RATIO, IN_BAND = 0.55, 0.75, (0.88, 0.99)
"""Limits of the field verification. The ratio compares the rms error of CALM with the rms error of
interpolation. `MEAN_RATIO` and `MAX_RATIO` limit the mean and the maximum of this ratio over the
sensors. `IN_BAND` is the allowed range of the fraction of values within their 95 % bands.
"""


def verify_field(outputs: Outputs) -> ExitCode:
    """Estimate the depths at withheld sensors of the mooring dune2, and compare them with the
    measured depths.
    """
    import numpy as np

    import calm
    from calm.checks.finding import State
    from calm.motion import correction, line_response, motion_estimate, study
    from calm.report import blocks, motion_report
    from calm.shipped import shipped_folder

    folder = shipped_folder("docs") / "field" / "dune2"
    mooring = calm.load(folder / "mooring.yaml")
    files = [str(folder / f"{name}.nc") for name in ("pressures", "currents")]
    measured = motion_estimate.RecoveredMooring(mooring, files[:1], files[1:]).measured
    task = study.prepare(mooring, measured, motion_estimate.fitted(), WITHHELD)
    points = [int(measured.point[measured.label.index(label)]) for label in WITHHELD]
    depth, spread = correction.estimate_in_memory(task, points)
    still = line_response.Forward(mooring, {}).still
    held = tuple(
        study.judge_hidden(measured, task.measured, label, depth[:, j], spread[:, j], still)
        for j, label in enumerate(WITHHELD)
    )
    ratio = float(np.mean([one.rms for one in held]) / np.mean([one.linear_rms for one in held]))
    worst = max(one.rms / one.linear_rms for one in held)
    inside = float(np.mean([one.coverage for one in held]))
    good = ratio <= MEAN_RATIO and worst <= MAX_RATIO and IN_BAND[0] <= inside <= IN_BAND[1]
    verdict = (
        f"The rms error is {ratio:.2f} times the rms error of interpolation on average (limit "
        f"{MEAN_RATIO}) and {worst:.2f} times at worst (limit {MAX_RATIO}). The 95 % "
        f"bands contain {100.0 * inside:.0f} % of the depths (required: {100.0 * IN_BAND[0]:.0f} "
        f"to {100.0 * IN_BAND[1]:.0f} %)."
    )
    factors = study.intervals(task)
    document: dict[str, Any] = {
        "calm": calm.__version__,
        "factors": motion_report.factors_document(factors),
        "held_out": motion_report.held_out_document(held),
        "ratio": ratio,
        "within": good,
    }
    part = blocks.ReportPart(
        "",
        (
            blocks.Heading("dune2, Denmark Strait: depths at withheld sensors"),
            motion_report.factors_table(factors, task.common.datum),
            motion_report.held_out_table(held),
            blocks.Prose((verdict,), State.PASS if good else State.FAIL),
        ),
    )
    outputs.write_answer(lambda: document, part)
    return ExitCode.DONE if good else ExitCode.FINDING
