"""Read a mooring file in one of its environments; all mistakes are reported together."""

import math
import os.path
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import BeforeValidator, Field

from calm.errors import InputError, Problem, unknown
from calm.files.catalogue import Catalogue
from calm.files.check_limits import Accept, Checks, LimitKey, read_accepts
from calm.files.components import Anchor, Flexible
from calm.files.definition import Model, Text, described, optional
from calm.files.environment import Position, Seabed, read_environment
from calm.files.legs import FileLeg, LegKeys, check_held_depths, read_legs, stand_in_anchor
from calm.files.line_items import LineReader
from calm.files.logbook import Deployed, DocumentKeys, OutputUnits, ReleaseKeys, check_deployed
from calm.files.mooring_file import (
    MooringFile,
    Solver,
    TowKeys,
    check_fit,
    unknown_releases,
)
from calm.files.pieces import Piece, check_one_fit, labels_of, numbered, travelling
from calm.files.uncertainty import Uncertainty
from calm.files.yaml_document import SourceMapping, compose, read_document, validate
from calm.units import QuantityError


def _given(value: object) -> object:
    if value is None:
        raise QuantityError("has no value")
    return value


class MooringKeys(Model):
    """Keys at the top level of a mooring file."""

    name: Text | None = optional("name of the mooring or tow", "Shelf edge 2026")
    description: Text | None = optional("purpose of the mooring", "Slope currents, first year")
    document: DocumentKeys | None = optional(
        "title block of the drawing", {"id": "M-2026-17", "revision": "B"}
    )
    position: Position | None = optional(
        "position of the mooring", {"latitude": "48.3 deg", "longitude": "-5.2 deg"}
    )
    tow: Annotated[TowKeys | None, BeforeValidator(_given, json_schema_input_type=TowKeys)] = (
        optional(
            "speed and course of a tow without anchor", {"speed": "4 knot", "toward": "90 deg"}
        )
    )
    environment: dict[str, Any] = described("the water", {"depth": "1100 m"}, default_factory=dict)
    line: Annotated[tuple[Any, ...], Field(min_length=1)] = described(
        "the pieces from the top to the anchor; in a tow, from the ship to the towed body",
        [{"use": "sphere-steel-1250"}, {"use": "anchor-wheels-4"}],
    )
    legs: dict[str, LegKeys] | None = optional(
        "instead of `line`: several lines that join at nodes or end at fixed points",
        {"main": {"line": [{"use": "sphere-steel-1250"}], "bottom": {"join": "A"}}},
    )
    nodes: dict[str, dict[str, Any]] | None = optional("nodes at which legs join", {"A": {}})
    components: dict[str, Any] | None = optional(
        "definitions of components used only in this file",
        {"my-float": {"kind": "sphere", "diameter": "1.2 m", "buoyancy": "7000 N"}},
    )
    environments: dict[str, dict[str, Any]] | None = optional(
        "named variants, each overriding keys of `environment`",
        {"storm": {"current": {"speed": "1.2 m/s", "toward": "90 deg"}}},
    )
    units: OutputUnits | None = optional(
        "units of display in tables, documents and the builder", {"force": "kgf", "speed": "kn"}
    )
    solver: Solver | None = optional(
        "numerical settings and drag laws", {"angle_step": "1 deg", "strumming": "vandiver"}
    )
    checks: Checks | None = optional(
        "limits of the design check", {"anchor_factor": 1.5, "maximum_knockdown": "50 m"}
    )
    uncertainty: Uncertainty | None = optional(
        "uncertainty of the inputs of the design",
        {"current": "10 %", "cable_drag": ["-15 %", "30 %"]},
    )
    releases: tuple[ReleaseKeys, ...] | None = optional(
        "the codes of each release, with its serial number",
        [{"serial": 1729, "codes": {"enable": "0A51", "release": "0A55"}}],
    )
    deployed: Deployed | None = optional(
        "place and time of the deployment, and differences from the design",
        {"date": "2027-03-02T10:40", "depth": "1103 m"},
    )


def read_mooring(
    path: str | Path,
    *,
    environment: str | Path | None = None,
    catalogs: Sequence[str | Path] = (),
    text: str | None = None,
    stand_in: bool = False,
) -> MooringFile:
    """Read a mooring file and all files to which it refers, for one environment.

    Raises
    ------
    InputError
        The file has mistakes; all are listed, each with its position.
    """
    reader = MooringReader(path, catalogs=catalogs, text=text, stand_in=stand_in)
    return reader.in_environment(environment)


class _ReadLine(NamedTuple):
    pieces: tuple[Piece, ...]
    legs: tuple[FileLeg, ...]
    looser: tuple[LimitKey, ...]
    accepts: tuple[Accept, ...]
    notices: tuple[str, ...]
    problems: tuple[Problem, ...]


class MooringReader:
    """Reader of a mooring file, for use in several environments.

    Parameters
    ----------
    catalogs : catalogue files, as in `Catalogue.load`
    text : text to read instead of the file; paths in the text are relative to the folder of `path`
    stand_in : whether a line without an anchor gets a substitute anchor with the id `STAND_IN`

    Raises
    ------
    InputError
        The file or a catalogue cannot be read at all.
    """

    def __init__(
        self,
        path: str | Path,
        *,
        catalogs: Sequence[str | Path] = (),
        text: str | None = None,
        stand_in: bool = False,
    ) -> None:
        self._path, self._stand_in = str(path), stand_in
        self._problems: list[Problem] = []
        self._lines: dict[bool, _ReadLine] = {}
        catalogue = Catalogue.load(catalogs)
        document = read_document(Path(path)) if text is None else compose(str(path), text)
        self._top = top = SourceMapping.of(document, self._problems)
        self._towed, self._legged = "tow" in top.data, "legs" in top.data
        given = top
        if self._legged:  # a file with legs has no line; its legs are read one by one
            ours = {key: value for key, value in top.data.items() if key not in ("legs", "nodes")}
            given = top.holding({"line": ["legs"], **ours})
        self._keys = validate(MooringKeys, given, context={"towed": self._towed})
        self._definitions = _child(top, "components")
        if self._definitions is not None:
            catalogue = catalogue.under(self._definitions)
        self._catalogue = catalogue

    def in_environment(self, environment: str | Path | None = None) -> MooringFile:
        """Read the file in a named variant, an environment file, or the default environment.

        Raises
        ------
        InputError
            The file has mistakes; all are listed, each with its position.
        """
        keys, problems = self._keys, [*self._problems]
        top = self._top.into(problems)
        chosen = choose_environment(top, environment, towed=self._towed)
        section = chosen[0] if chosen else _child(top, "environment")
        in_air = section is not None and section.data.get("fluid") == "air"
        if in_air not in self._lines:
            self._lines[in_air] = self._read_line(in_air)
        line = self._lines[in_air]
        problems += line.problems
        notices = [*line.notices]
        checks, surroundings = (keys and keys.checks) or Checks(), None
        if chosen:
            position = keys.position if keys else None
            surroundings = read_environment(*chosen, notices, towed=self._towed, position=position)
        if surroundings is not None:
            depth = surroundings.depth
            if surroundings.seabed is not None:
                _check_anchor_positions(
                    surroundings.seabed, line.pieces, line.legs, checks, top, depth
                )
            if self._legged:
                check_held_depths(line.legs, top, depth)
            else:
                check_fit(line.pieces, depth, keys.tow if keys else None, top)
        if problems or keys is None or surroundings is None:
            raise InputError(_in_order(problems, self._path))
        return MooringFile(
            path=self._path,
            name=keys.name or Path(self._path).stem,
            description=keys.description or "",
            position=keys.position,
            tow=keys.tow,
            environment=surroundings,
            pieces=line.pieces,
            legs=line.legs,
            solver=keys.solver or Solver(),
            checks=checks,
            uncertainty=keys.uncertainty or Uncertainty(),
            looser=line.looser,
            notices=tuple(notices),
            variants=keys.environments or {},
            accepts=line.accepts,
            document=keys.document,
            releases=keys.releases or (),
            deployed=keys.deployed,
            units=keys.units.chosen if keys.units else {},
        )

    def _read_line(self, in_air: bool) -> _ReadLine:
        problems: list[Problem] = []
        notices: list[str] = []
        top, keys, towed = self._top.into(problems), self._keys, self._towed
        reader = LineReader(self._catalogue, top, notices, towed=towed, in_air=in_air)
        reader.check(self._definitions.data if self._definitions is not None else ())
        before = len(problems)
        legs: tuple[FileLeg, ...] = ()
        pieces = reader.read(top, "line") if isinstance(top.data.get("line"), list) else ()
        line_is_whole = bool(pieces) and len(problems) == before
        if self._stand_in and not towed and pieces and not _anchored(pieces):
            pieces = (*pieces, stand_in_anchor(0, len(top.data["line"])))
        if self._legged:
            legs, pieces = read_legs(top, reader, keys.position if keys else None)
            line_is_whole = bool(pieces) and len(problems) == before
        else:
            (_check_tow if towed else _check_anchor)(pieces, top)
            check_one_fit(pieces, top)
            pieces = numbered(pieces)
            if line_is_whole:
                pieces = travelling(pieces, top)
        labels = labels_of(pieces) if line_is_whole else None
        accepts = read_accepts(((keys and keys.checks) or Checks()).accept, labels, top)
        if keys and keys.deployed and labels is not None:
            cut = [p.label for p in pieces if isinstance(p.component, Flexible)]
            check_deployed(keys.deployed, labels, cut, top)
        if keys and keys.releases and labels is not None:
            notices += unknown_releases(keys.releases, pieces, keys.deployed)
        return _ReadLine(
            pieces, legs, tuple(reader.looser), accepts, tuple(notices), tuple(problems)
        )


def _child(section: SourceMapping, key: str) -> SourceMapping | None:
    return section.child(key) if isinstance(section.data.get(key), dict) else None


def _in_order(problems: list[Problem], path: str) -> list[Problem]:
    once = dict.fromkeys(problems)
    # problems of the mooring file come first
    return sorted(once, key=lambda one: (one.path != path, one.path, one.line, one.column))


def _check_tow(pieces: Sequence[Piece], top: SourceMapping) -> None:
    for piece in pieces:
        if isinstance(piece.component, Anchor):
            message = f"`{piece.use}` is an anchor, but the line of a tow ends at the towed body"
            top.refuse_at(piece.line, piece.column, message)


def _check_anchor(pieces: Sequence[Piece], top: SourceMapping) -> None:
    if not pieces:
        return
    for piece in pieces[:-1]:
        if isinstance(piece.component, Anchor):
            message = (
                f"anchor `{piece.use}` must be the last item; a line has only one "
                "anchor, at its end"
            )
            top.refuse_at(piece.line, piece.column, message)
    last_is_known = pieces[-1].place.item == len(top.data["line"]) - 1
    if last_is_known and not _anchored(pieces):
        message = "the line has no anchor; its last item must be one (`kind: anchor`)"
        top.refuse(("line",), message, key=True, lacks="no anchor")
    if len(pieces) == 1 and _anchored(pieces) and len(top.data["line"]) == 1:
        here, lacks = (pieces[0].line, pieces[0].column), "nothing above the anchor"
        top.refuse_at(*here, "a line needs at least one piece above its anchor", lacks=lacks)


def _anchored(pieces: Sequence[Piece]) -> bool:
    return any(isinstance(piece.component, Anchor) for piece in pieces)


def _check_anchor_positions(
    seabed: Seabed,
    pieces: Sequence[Piece],
    legs: Sequence[FileLeg],
    checks: Checks,
    top: SourceMapping,
    depth: float | None,
) -> None:
    """Check that no anchor slides downhill, lies outside the depth grid, or is above water.

    `depth` is the water depth at the origin [m].
    """
    ends = {leg.end - 1: leg.bottom.anchor for leg in legs}
    for piece in pieces:
        if not isinstance(piece.component, Anchor):
            continue
        place, own = ends.get(piece.index), piece.component.friction
        at = (0.0, 0.0) if place is None else place.at
        here, deeper = seabed.at(*at), float(seabed.deeper(np.array([at]))[0])
        most = math.degrees(math.atan(checks.anchor_friction if own is None else own))
        complaints = []
        if here.slope >= most:
            complaints.append(
                f"with a friction coefficient of {math.tan(math.radians(most)):g} the anchor "
                f"slides under its own weight on a seabed that slopes by {here.slope:.4g}°; it "
                f"holds on slopes of less than {most:.3g}°"
            )
        if place is not None and place.depth is not None:
            pass
        elif np.isnan(deeper):
            complaints.append(
                "the grid of the seabed has no depth at the anchor; set the `depth` of the anchor"
            )
        elif depth is not None and depth + deeper <= 0.0:
            complaints.append(
                f"the seabed slope puts the seabed {-depth - deeper:.3g} m above the surface at "
                "this anchor"
            )
        for one in complaints:
            top.refuse_at(piece.line, piece.column, one)


class EnvironmentFileKeys(Model):
    """Keys at the top level of an environment file."""

    name: Text | None = None
    environment: dict[str, Any]


def choose_environment(
    top: SourceMapping, chosen: str | Path | None, *, towed: bool
) -> tuple[SourceMapping, str | None] | None:
    """Select an environment; return its unvalidated section, and its name.

    The name of the default environment is None. The default environment supplies the missing keys
    of any other environment. The result is None if there is no such environment. Mistakes in all
    environments of the mooring file are recorded.

    Parameters
    ----------
    top : top level of the mooring file
    chosen : name of a variant in the file, or path of an environment file; None for the default
    towed : whether the file is a tow, which by default is in deep, still sea water
    """
    own = _child(top, "environment")
    if own is None:
        if "environment" in top.data:
            return None
        if chosen is None and not towed:
            top.refuse((), "`environment` is missing", lacks="no environment")
            return None
        own = top.holding({})
    variants = _child(top, "environments")
    known = {} if variants is None else {key: _child(variants, key) for key in variants.data}
    overlays = {key: overlay for key, overlay in known.items() if overlay is not None}
    for overlay in overlays.values():
        _check_environment(overlay, towed)
    if chosen is None:
        return own, None
    _check_environment(own, towed)
    if isinstance(chosen, str) and chosen in overlays:
        return overlays[chosen].over(own), chosen
    if isinstance(chosen, str) and not _is_file_name(chosen):
        message = unknown(f"no environment is called `{chosen}`", chosen, overlays)
        if variants is None and "environments" not in top.data:
            message = (
                f"the file has no named environments, so there is no `{chosen}`: add it under "
                "`environments:`, or choose an environment file, such as storm.yaml"
            )
            top.refuse_at(0, 0, message)
        else:
            top.refuse(("environments",), message, key=True)
        return None
    path = Path(chosen)
    try:
        file = SourceMapping.of(read_document(path), top.problems)
    except InputError as error:
        top.problems.extend(error.problems)
        return None
    keys = validate(EnvironmentFileKeys, file)
    return None if keys is None else (file.child("environment").over(own), keys.name or path.stem)


def _check_environment(section: SourceMapping, towed: bool) -> None:
    # the depth may be missing, since the environment may have a base or be a base
    section = section.over(section.holding({"depth": "1 m"}))
    read_environment(section, None, [], open_files=False, towed=towed)


def _is_file_name(text: str) -> bool:
    return os.path.isfile(text) or os.sep in text or text.endswith((".yaml", ".yml"))
