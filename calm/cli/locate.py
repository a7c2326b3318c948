"""``calm locate``: find the position of an anchor from acoustic ranges."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from calm.cli import options
from calm.cli.outputs import ExitCode, OutputPath, Outputs, narrate, save
from calm.errors import UsageError

if TYPE_CHECKING:
    from calm.ranging import Sound


DEFAULT_SPEED = "1500 m/s"


def locate(
    file: Path,
    /,
    *,
    sound_speed: str | None = None,
    transducer: str = "0 m",
    depth: str | None = None,
    above_seabed: str = "0 m",
    plot: Path | None = None,
    json: OutputPath = None,
    near: options.Signed = None,
    hemisphere: str = "",
    update: Path | None = None,
    accept: bool = False,
) -> ExitCode:
    """Locate an anchor from ship-to-release acoustic ranges.

    Outliers are reported, and rejected if enough ranges remain. The result is the
    position with its 95 % ellipse and the depth with its 95 % interval. CALM warns
    if the ship's positions constrain the result poorly. If two positions fit, both
    are reported. CALM chooses the more likely one: its ranges fit better, or it is
    closer to the planned position, allowing for the usual fallback of an anchor.
    If CALM cannot choose, the exit code is 1. Acoustic rays are assumed to be
    straight.

    Parameters
    ----------
    file
        CSV file with the columns latitude, longitude, and range[m] or two-way time[s]. Positions
        are those of the transducer in WGS 84, in degrees or in degrees and minutes. Survey files
        without column headings, as written for the programs of WHOI and NOC, are accepted, too.
    sound_speed
        Speed of sound, used to convert travel times to ranges: a speed, or a CSV file with the
        columns depth[m] and sound_speed[m/s]; 1500 m/s by default. Ignored for ranges in metres.
    transducer
        Depth of the ship's transducer.
    depth
        Water depth at the anchor, if known; otherwise it is estimated.
    above_seabed
        Height of the transponder (usually the release) above the seabed.
    plot
        Draw the anchor position, and the ranges as circles about the ship's positions, in this
        .png, .svg or .pdf file.
    json
        Write the position as JSON (- for standard output).
    near
        Planned latitude and longitude of the anchor, used to choose between two positions that
        fit; by default, the planned position in the file of --update.
    hemisphere
        Hemispheres of positions that have neither letter nor sign, such as S,W.
    update
        Mooring file in which position and depth are written to `deployed:`. The distance of the
        anchor from its planned position is reported. If two positions remain, if the depth differs
        from the planned depth by more than 30 m or 3 %, or if the position is doubtful for another
        reason, nothing is written and the exit code is 1.
    accept
        Write the position even if it is doubtful.

    Examples
    --------
      calm locate ranges.csv
      calm locate times.csv --sound-speed "1492 m/s" --transducer "5 m" --plot circles.png
      calm locate times.csv --sound-speed profile.csv --depth "1103 m"
      calm locate ranges.csv --depth "1103 m" --near "48 18.0 N, 5 12.0 W"
      calm locate ranges.csv --update mooring.yaml   (writes position and depth to deployed:)

    ranges.csv:

      latitude[deg],longitude[deg],range[m]
      48.30120,-5.19870,1432.5
    """
    from calm.drawing.picture import check_format, image
    from calm.ranging import locate as found_at
    from calm.ranging import range_fit, read_ranges
    from calm.records.record import parse_place
    from calm.report.anchor_sheets import located_figure, located_part
    from calm.report.folder import check_destination

    outputs = Outputs((file,), json)
    if plot is not None:
        check_format(plot)
        check_destination(plot)
    given = options.quantities(
        transducer=(transducer, "length"),
        depth=(depth, "length"),
        above_seabed=(above_seabed, "length"),
    )
    under, height = given["transducer"], given["above_seabed"]
    answering = given["depth"] - height if "depth" in given else None
    if under < 0.0 or height < 0.0 or (answering is not None and answering <= under):
        raise UsageError(
            "--transducer and --above-seabed must not be negative, and the transponder must be "
            "deeper than the transducer"
        )
    sound = _sound(sound_speed or DEFAULT_SPEED)
    survey = read_ranges(file, under, hemisphere)
    if sound_speed is not None and not survey.timed:
        narrate("--sound-speed is ignored because the ranges are already in metres")
    for notice in survey.notices:
        narrate(f"{file}: {notice}")
    mooring = None if update is None else range_fit.located_mooring(update)
    about = None if near is None else parse_place(near)
    if about is None and mooring is not None and mooring.position is not None:
        about = mooring.position.latitude, mooring.position.longitude
    located = found_at(survey, sound, answering, about)
    water_depth = located.depth + height
    doubts, edited = located.doubts, None
    if update is not None and mooring is not None:
        working, text, beside, far = range_fit.with_deployed(update, mooring, located, water_depth)
        edited, doubts = (working, text), (*doubts, *far)
        for line in beside:
            narrate(f"{update}: {line}")
    outputs.write_answer(
        lambda: {**located.to_dict(), "depth": water_depth}, located_part(located, water_depth)
    )
    if plot is not None:
        save(plot, image(located_figure(located), plot.suffix))
    if edited is None:
        return ExitCode.FINDING if located.undecided and not accept else ExitCode.DONE
    if doubts and not accept:
        narrate(f"{update} was not changed: {'; '.join(doubts)}. Use --accept to write it anyway")
        return ExitCode.FINDING
    working, text = edited
    lost = working.save(text)
    narrate(f"{update}: `deployed:` now has a position and a depth" + (f"; {lost}" if lost else ""))
    return ExitCode.DONE


def _sound(text: str) -> Sound:
    from calm.ranging import Sound, ranges

    if text.lower().endswith((".csv", ".txt", ".tsv")):
        return ranges.read_sound(Path(text))
    speed = options.quantities(sound_speed=(text, "speed"))["sound_speed"]
    if not ranges.SLOWEST <= speed <= ranges.FASTEST:
        raise UsageError(f"--sound-speed: `{text}` {ranges.sound_complaint()}")
    return Sound.constant(speed)
