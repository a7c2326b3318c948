"""``calm deck`` and ``calm locate``: papers for the deployment, and where the anchor then is."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from calm.cli import options, reading
from calm.cli.outputs import ExitCode, OutputPath, Outputs, narrate
from calm.errors import NoEquilibrium, UsageError
from calm.version import __version__

if TYPE_CHECKING:
    from calm.deck import Deck
    from calm.ranging import Sound
    from calm.report.diagram import Paper


def deck(
    files: options.MooringPaths,
    /,
    *,
    output: options.OutputFile,
    page: Literal["a4", "a3", "letter"] = "a4",
    environment: list[str] | None = None,
    order: Literal["anchor-last", "anchor-first"] = "anchor-last",
    ship_speed: str = "1 m/s",
    streamed: str | None = None,
    course: str | None = None,
    deck_time: str | None = None,
    catalog: options.CatalogFiles = None,
    units: options.Units = None,
) -> ExitCode:
    """Draw the diagram and write the lists for the deployment of moorings and nets.

    Writes deck.pdf with a mooring diagram for the wall, deployment and recovery
    logs, cutting list, hardware bill, shipping list, lifts, instrument sheet and,
    anchor last, the plan of the anchor drop; the diagram by itself as diagram.pdf
    and diagram.svg; the lists as CSV files and as sheets of deck.xlsx; and the plan
    as plan.json. A net of legs is drawn as a whole, as net.svg too, and listed leg
    by leg; its drop is not planned.

    Parameters
    ----------
    output
        The folder to write; with several moorings, each gets a subfolder of its
        name.
    page
        The paper.
    environment
        The environment of depths and lengths: a name from the files, or an
        environment file; further ones are design currents. By default the
        file's own, with all those it names.
    order
        Which end goes over the side last.
    ship_speed
        Speed over the ground at which the ship tows the line out before the
        anchor is let go.
    streamed
        Horizontal distance from the anchor to the top float when the anchor is
        let go; by default that of the line towed at that speed.
    course
        Course over the ground as the ship tows the line out; by default against
        the current at the surface.
    deck_time
        Handling time of each piece and clamp before it goes over, such as "3
        min", except shackles and rings; by default by role, from `document:
        deck_time:` in the file. Without either the plan has no start of the
        run.

    Examples
    --------
      calm deck mooring.yaml -o cruise/
      calm deck mooring.yaml -o cruise/ --page a3 --environment storm
      calm deck north.yaml south.yaml -o cruise/
      calm deck mooring.yaml -o cruise/ --ship-speed "2 knot" --course "245 deg" --deck-time "3 min"
      calm deck shallow.yaml -o cruise/ --order anchor-first
    """
    from calm.deck import deck_items, deck_of
    from calm.report import diagram, provenance
    from calm.report.folder import check_folder

    check_folder(output)
    provenance.moment()
    ship = options.quantities(
        ship_speed=(ship_speed, "speed"),
        streamed=(streamed, "length"),
        course=(course, "angle"),
        deck_time=(deck_time, "time"),
    )
    designs, tows = reading.read_designs(files, environment, catalog or [], None, "calm deck")
    if tows:
        narrate(f"not drawn, because they are tows: {', '.join(map(str, tows))}")
    options.show_units(units, [one.file for design in designs for one in design.moorings])
    folders = _folders(designs, output)
    decks: list[Deck] = []
    for design in designs:
        for notice in dict.fromkeys(n for one in design.moorings for n in one.file.notices):
            narrate(f"{design.path}: {notice}")
        try:
            decks.append(deck_of(design.moorings, deck_items.Order(order), **ship))
        except NoEquilibrium as failure:
            narrate(f"{design.path}: {failure}")
            return ExitCode.NO_EQUILIBRIUM
    for folder, design, one in zip(folders, designs, decks, strict=True):
        _write(folder, design.path, one, diagram.Paper(page))
    return ExitCode.DONE


def _write(folder: Path, path: Path, deck: Deck, paper: Paper) -> None:
    from calm.report.check_tables import verdict_of
    from calm.report.folder import write_report

    state, words = verdict_of(deck.assessment.all_findings())
    narrate(f"{path}: {state.sign} {words}: calm check {path}")
    notes = _signs_that_are_lacking(deck)
    for note in (*deck.notes, *notes):
        narrate(f"{path}: {note}")
    write_report(folder, _contents(deck, paper, notes))
    narrate(f"the sheets are in {folder}")


def _contents(deck: Deck, paper: Paper, notes: tuple[str, ...]) -> Mapping[str, bytes]:
    from calm.checks.finding import State
    from calm.report import check_tables, deck_files, result_files
    from calm.report.diagram import diagram_svg
    from calm.report.folder import printed

    texts = {"diagram.svg": diagram_svg(deck, paper), **deck_files.deck_csvs(deck)}
    if deck.file.legs:
        texts["net.svg"] = deck_files.net_svg(deck)
    counts = check_tables.counted_states(deck.assessment.all_findings())
    fails, unknown = counts[State.FAIL], counts[State.UNKNOWN]
    verdict = {"state": str(deck.assessment.state), "fails": fails, "unknown": unknown}
    texts["plan.json"] = result_files.to_json(
        [{"calm": __version__, **_plan(deck), "verdict": verdict}]
    )
    return {
        "deck.pdf": printed(deck_files.deck_report(deck, paper, notes), paper, least=7.5),
        "deck.xlsx": deck_files.deck_workbook(deck),
        "diagram.pdf": printed(deck_files.diagram_report(deck, paper), paper, least=7.5),
        **{name: text.encode("utf-8", "replace") for name, text in texts.items()},
    }


def _plan(deck: Deck) -> dict[str, Any]:
    """The plan of the anchor drop, or why there is none."""

    if deck.file.legs:
        return {"status": "net", "message": "The drop of a net of legs is not solved."}
    if deck.plan is None:
        return {"status": str(deck.order), "message": "The anchor goes first: it is not dropped."}
    if isinstance(deck.plan, NoEquilibrium):
        return {"name": deck.file.name, **deck.plan.to_dict()}
    return deck.plan.to_dict()


def _signs_that_are_lacking(deck: Deck) -> tuple[str, ...]:
    """Return what the sheets cannot show of the names in a file, and where."""
    from calm.drawing.typesetting import lacking

    signs = lacking(text for text, _ in _texts(deck))
    if not signs:
        return ()
    where = dict.fromkeys(place for text, place in _texts(deck) if lacking([text]))
    named = ", ".join(f"{sign} (U+{ord(sign):04X})" for sign in signs)
    return (f"The font of the sheets lacks {named}, which shows as �: in {', '.join(where)}",)


def _texts(deck: Deck) -> Iterator[tuple[str, str]]:
    """Return what a person wrote, and where it stands."""
    from calm.report.provenance import title_pairs

    for name, text in title_pairs(deck.file):
        yield text, name
    if deck.file.document is not None:
        for revision in deck.file.document.history:
            yield f"{revision.by} {revision.change}", "history"
    for one in deck.parts:
        equipment = one.part.equipment
        texts = (one.label, one.name, one.serial, one.deployed_serial, one.remark,
                 equipment.sampling, equipment.termination)  # fmt: skip
        yield " ".join(filter(None, texts)), f"`{one.label}`"


def _folders(designs: Sequence[reading.DesignFile], output: Path) -> list[Path]:
    """Return where each mooring's sheets go.

    UsageError: two moorings would have the same folder, or a file that is read stands where one
    goes.
    """
    if len(designs) == 1:
        return [output]
    # signs that systems refuse become a stroke
    plain = (re.sub(r'[\x00-\x1f<>:"/\\|?*]+', "-", each.name).strip(" .") for each in designs)
    folders = [output / (name or "mooring") for name in plain]
    for folder in folders:
        if [str(one).casefold() for one in folders].count(str(folder).casefold()) > 1:
            raise UsageError(f"two moorings would go to {folder}; give them other names")
    return folders


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
    update: Path | None = None,
    accept: bool = False,
    output: Annotated[Path | None, Parameter(name=["--output", "-o"], show=False)] = None,
) -> ExitCode:
    """Find where an anchor lies from acoustic ranges taken by a ship.

    Outliers among the ranges are reported and left out, if enough ranges
    remain. The position comes with its 95 % ellipse, the depth with its
    interval, and a warning if the ship's positions leave them poorly known. If
    two positions fit, the one near the planned position is taken, and the other
    is given. Rays are taken as straight.

    Parameters
    ----------
    file
        CSV file with the columns latitude, longitude (WGS 84, of the
        transducer; degrees, or degrees and minutes) and range[m], or the
        two-way time[s]; or a survey without a heading, in the forms of WHOI's
        and NOC's programs.
    sound_speed
        Speed of sound for times: a speed, or a CSV file with the columns
        depth[m] and sound_speed[m/s]; 1500 m/s by default. Ranges in metres are
        used as they are.
    transducer
        Depth of the ship's transducer.
    depth
        Depth of the water at the anchor, if known; otherwise it is estimated.
    above_seabed
        Height above the seabed of the transponder, such as the release.
    plot
        Draw the ranges as circles about the ship, with the position found:
        .png, .svg or .pdf.
    json
        Write the place as JSON, - to print it.
    near
        Approximate latitude and longitude of the drop, to choose between two
        positions; by default the planned position in the file of --update.
    update
        A mooring file: write position and depth into its `deployed:`, and
        report the distance from its planned position. If the position is in
        doubt nothing is written, and the exit code is 1.
    accept
        Write the position in spite of a doubt.

    Examples
    --------
      calm locate ranges.csv
      calm locate times.csv --sound-speed "1492 m/s" --transducer "5 m" --plot circles.png
      calm locate times.csv --sound-speed profile.csv --depth "1103 m"
      calm locate ranges.csv --depth "1103 m" --near "48 18.0 N, 5 12.0 W"
      calm locate ranges.csv --update mooring.yaml   (its deployed: gets position and depth)

    ranges.csv:

      latitude[deg],longitude[deg],range[m]
      48.30120,-5.19870,1432.5
    """
    from calm.drawing.picture import check_format, image
    from calm.ranging import locate as found_at
    from calm.ranging import range_fit, read_ranges
    from calm.records.record import parse_place
    from calm.report.anchor_sheets import located_figure, located_part
    from calm.report.folder import check_destination, write_file

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
    survey = read_ranges(file, under)
    if sound_speed is not None and not survey.timed:
        narrate("--sound-speed is not used: ranges in metres are taken as they are")
    for notice in survey.notices:
        narrate(f"{file}: {notice}")
    if output is not None:
        narrate("-o is now --update: the file is edited in place")
        update = update or output
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
        write_file(plot, image(located_figure(located), plot.suffix))
    if edited is None:
        return ExitCode.DONE
    if doubts and not accept:
        narrate(f"{update} is not written: {'; '.join(doubts)}. --accept writes it anyway")
        return ExitCode.FINDING
    working, text = edited
    lost = working.save(text)
    narrate(f"{update}: `deployed:` now has position and depth" + (f"; {lost}" if lost else ""))
    return ExitCode.DONE


def _sound(text: str) -> Sound:
    """One speed, or the profile of a file."""
    from calm.ranging import Sound, ranges

    if text.lower().endswith((".csv", ".txt", ".tsv")):
        return ranges.read_sound(Path(text))
    speed = options.quantities(sound_speed=(text, "speed"))["sound_speed"]
    if not ranges.SLOWEST <= speed <= ranges.FASTEST:
        raise UsageError(f"--sound-speed: `{text}` {ranges.sound_complaint()}")
    return Sound.constant(speed)
