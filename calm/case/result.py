"""The result of a solved mooring or net, in the names and units of the result format.

Its ends, its anchors, its pieces, its knockdown, a net's legs and nodes, and its JSON object.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import cached_property
from math import nan
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias

import numpy as np

from calm.case.result_tables import (
    MOORED_ENDS,
    Accuracy,
    AnchorLoad,
    Clamps,
    Components,
    EndLoad,
    NodePlace,
    Shape,
    Top,
    documents,
)
from calm.case.strumming import Strumming, StrummingBand, band_of
from calm.files import MooringFile
from calm.physics.line import Floats
from calm.solve.solution import OtherEquilibrium

if TYPE_CHECKING:
    from calm.case.mooring import Mooring, ProfilerTravel
    from calm.case.net import Net
    from calm.case.tow import TowResult


def document_of(
    result: Result | TowResult | NetResult, ends: dict[str, Any], **last: Any
) -> dict[str, Any]:
    """The JSON object of a result; `ends` stand before its components, `last` behind its clamps."""
    from calm.version import __version__

    document = result.file.document
    told = ("type", "status", "iterations", "segments", "miss", "closure")
    return {
        "calm": __version__,
        "name": result.name,
        **({} if document is None else {"document": document.to_dict()}),
        **{name: getattr(result, name) for name in told},
        "accuracy": {k: v for k, v in asdict(result.accuracy).items() if v is not None},
        **ends,
        "components": documents(result.components, result.file),
        "clamps": documents(result.clamps, result.file),
        **last,
        "warnings": list(result.warnings),
    }


def line_document(result: Result | TowResult, ends: dict[str, Any]) -> dict[str, Any]:
    """The JSON object of a single line; `ends` holds what a mooring, or a tow, has at its ends."""
    more = {
        "strumming": _known(result.strumming),
        "strumming_band": _known(result.strumming_band),
        "other_equilibrium": result.other_equilibrium,
    }
    return document_of(result, ends | more, shape=result.shape.to_dict())


def _known(part: Strumming | StrummingBand | None) -> dict[str, Any] | None:
    """A part of a result as a dictionary; None where there is none."""
    return None if part is None else asdict(part)


@dataclass(frozen=True, kw_only=True, repr=False)
class ResultForms:
    """Tell how a solution was found, and the forms of a result in a notebook and for other
    libraries.

    `iterations` counts marches, `segments` the cuts of the final one, `miss` is how far the end of
    a line, the worst of a net's, is from where it is held: in height, of a single line [m];
    `closure` the relative force residual recomputed from the final coordinates. `notebook_form`
    makes HTML of a result, `netcdf_form` a file, `plot_form` draws it; the packages above set them.
    """

    name: str
    type: str
    status: str
    iterations: int
    segments: int
    miss: float
    closure: float
    accuracy: Accuracy
    warnings: tuple[str, ...] = ()

    notebook_form: ClassVar[Callable[[Any], str] | None] = None
    netcdf_form: ClassVar[Callable[[Any], bytes] | None] = None
    plot_form: ClassVar[Callable[[Any, Any], Any] | None] = None

    if TYPE_CHECKING:

        @property
        def components(self) -> Components:
            """Return the pieces."""

    def plot(self, ax: Any = None) -> Any:
        """Draw the line from the side on axes of matplotlib, and return them.

        Without `ax` the axes are those of a new figure. UsageError: matplotlib is not installed.
        """
        form = type(self).plot_form
        assert form is not None, "a mooring is read by calm.load"
        return form(self, ax)

    def to_pandas(self) -> Any:
        """Return the components as a pandas data frame."""
        return self.components.to_pandas()

    def to_xarray(self) -> Any:
        """The dataset that `calm run --netcdf` writes: components, clamps and shape, with units."""
        from io import BytesIO

        from xarray import load_dataset

        form = type(self).netcdf_form
        assert form is not None, "a mooring is read by calm.load"
        return load_dataset(BytesIO(form(self)))

    def _repr_html_(self) -> str | None:
        """The table of the line, for notebooks; None where nothing makes it."""
        form = type(self).notebook_form
        return None if form is None else form(self)


@dataclass(frozen=True, kw_only=True, repr=False)
class Solved(ResultForms):
    """Hold what the result of every single line has. Depths [m].

    `other` is another equilibrium that was found.
    """

    strumming: Strumming | None
    components: Components
    clamps: Clamps
    shape: Shape
    other: OtherEquilibrium | None = None

    def __repr__(self) -> str:
        """Return the figures of both ends, in SI units and degrees."""
        lines = [f"{self.name}: {self.type}, {self.status}"]
        for end in ("top", "anchor", "tow_point", "body"):
            if end in vars(self):
                figures = asdict(vars(self)[end]).items()
                known = [f"{name} {value:.6g}" for name, value in figures if value is not None]
                lines.append(f"{end}: {', '.join(known)}")
        tables = f"{len(self.components)} components, {len(self.clamps)} clamps"
        return "\n".join([*lines, f"{tables}, {len(self.warnings)} warnings"])


@dataclass(frozen=True, kw_only=True, repr=False)
class Result(Solved):
    """A converged mooring. Lengths and depths [m], forces [N], angles [degrees].

    `still_shape` is the same line without current, None where that has no unique shape. `profilers`
    are on their way; the rest of the result is of all of them at their upper stops.
    """

    mooring: Mooring
    top: Top
    anchor: AnchorLoad
    still_shape: Shape | None
    profilers: tuple[ProfilerTravel, ...] = ()

    @property
    def other_used_buoyancy(self) -> float:
        """Share in use of the buoyancy of the float in another equilibrium at the surface; NaN if
        none was found.
        """
        afloat = self.other is not None and self.other.used_buoyancy < 1.0
        return self.other.used_buoyancy if self.other is not None and afloat else nan

    @property
    def other_equilibrium(self) -> dict[str, float] | None:
        """Depth of the free end, length on the seabed, buoyancy in use and anchor load of another
        equilibrium; None if none was found.
        """
        return None if self.other is None else self.other._asdict()

    @property
    def file(self) -> MooringFile:
        """The file as read."""
        return self.mooring.file

    @cached_property
    def strumming_band(self) -> StrummingBand | None:
        """Return the same mooring with more drag on its cables; solved when first asked for.

        None of a leg of a net, which does not stand alone.
        """
        if self.mooring.file.legs:
            return None
        still = self.still_shape
        return band_of(self.mooring, None if still is None else float(still.depth[0]))

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of the result format; None stands where a figure is unknown."""
        ends: dict[str, Any] = {"top": asdict(self.top), "anchor": asdict(self.anchor)}
        if self.profilers:
            ends["profilers"] = [asdict(each) for each in self.profilers]
        return line_document(self, ends)


@dataclass(frozen=True, kw_only=True, repr=False)
class NetResult(ResultForms):
    """A converged net. Lengths and depths [m], forces [N], angles [degrees].

    x and y are east and north of the origin of the file's places. `legs` are lines of their own,
    counted from their upper ends; one without an anchor has a stand-in for it, of which nothing is
    true.
    """

    type: str = "net"
    mooring: Net
    legs: tuple[Result, ...]
    nodes: tuple[NodePlace, ...]
    anchors: tuple[EndLoad, ...]
    held: tuple[EndLoad, ...]

    def __repr__(self) -> str:
        """Return the nodes and the pulls on the anchors, in SI units and degrees."""
        lines = [f"{self.name}: {self.type} of {len(self.legs)} legs, {self.status}"]
        lines += [f"node {one.name}: depth {one.depth:.6g}" for one in self.nodes]
        lines += [
            f"{what} of leg {one.leg}: tension {one.tension:.6g}, angle {one.angle:.3g}"
            for what, ends in (("anchor", self.anchors), ("held end", self.held))
            for one in ends
        ]
        return "\n".join([*lines[:9], f"{len(self.warnings)} warnings"])

    @property
    def file(self) -> MooringFile:
        """The file as read."""
        return self.mooring.file

    @cached_property
    def components(self) -> Components:
        """The pieces of the file, leg by leg."""
        pairs = zip(self.file.legs, self.legs, strict=True)  # a leg that is joined has a stand-in
        whole = Components.joined(
            [leg.components.head(keys.end - keys.first) for keys, leg in pairs]
        )
        pieces = self.file.pieces
        return whole.with_columns(part=list(pieces), index=np.arange(len(pieces)))

    @cached_property
    def clamps(self) -> Clamps:
        """Return what is clamped on them."""
        tables = [
            leg.clamps.with_columns(index=leg.clamps.index + keys.first)
            for keys, leg in zip(self.file.legs, self.legs, strict=True)
        ]
        return Clamps.joined(tables)

    @property
    def ends(self) -> dict[str, Floats]:
        """Of each leg the depth of its free upper end [m], the share in use of the buoyancy there,
        and the pull on its anchor up and sideways [N]; NaN where there is none.
        """
        return {
            one.name: np.array([one.found(leg) for leg in self.legs])
            for one in MOORED_ENDS
            if one.found
        }

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of the result format; None stands where a figure is unknown."""
        anchors = [asdict(each) for each in self.anchors]
        ends = {
            **({"anchor": anchors[0]} if len(anchors) == 1 else {}),
            "anchors": anchors,
            "held": [
                {k: v for k, v in asdict(each).items() if k not in _OF_ANCHORS}
                for each in self.held
            ],
            "nodes": [asdict(each) for each in self.nodes],
            "legs": [
                {
                    "name": leg.name,
                    "closure": leg.closure,
                    "used_buoyancy": leg.top.used_buoyancy,
                    "reserve": leg.top.reserve,
                    "shape": leg.shape.to_dict(),
                }
                for leg in self.legs
            ],
        }
        return document_of(self, ends)


_OF_ANCHORS = ("required_weight", "weight", "grounded_length", "slack_length")

AnyResult: TypeAlias = "Result | TowResult | NetResult"


def legs_of(result: Result | NetResult) -> tuple[Result, ...]:
    """Return the legs of a net; a mooring is one."""
    return result.legs if isinstance(result, NetResult) else (result,)
