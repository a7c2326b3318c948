"""What is found of a net: its legs, its nodes, and what its ends bear."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from functools import cached_property
from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.case.result import Accuracy, Result, ResultForms
from calm.case.result_tables import Clamps, Components
from calm.case.tow import TowResult
from calm.files import MooringFile
from calm.files.legs import leg_numbers
from calm.physics.line import Floats

if TYPE_CHECKING:
    from calm.case.net import Net


@dataclass(frozen=True)
class EndLoad:
    """What a leg does to an end that is held, or to its anchor.

    The pull of the line and its parts up and sideways [N], its angle from the vertical [degrees];
    where the end is [m]. Of an anchor the weight in water that it needs, and has [N], and the
    unstretched length of line on the seabed [m].
    """

    leg: str
    tension: float
    vertical: float
    horizontal: float
    angle: float
    x: float
    y: float
    depth: float
    required_weight: float | None = None
    weight: float | None = None
    grounded_length: float = 0.0


@dataclass(frozen=True)
class NodePlace:
    """Where the legs of a node meet [m]; `imbalance` is what is left of their pulls there [N]."""

    name: str
    depth: float
    x: float
    y: float
    imbalance: float


@dataclass(frozen=True, kw_only=True, repr=False)
class NetResult(ResultForms):
    """A converged net. Lengths and depths [m], forces [N], angles [degrees].

    x and y are east and north of the origin of the file's places. `miss` is the worst distance of a
    leg's end from where it is held, `closure` the worst of the legs', recomputed from coordinates.
    `legs` are lines of their own, counted from their upper ends; one without an anchor has a
    stand-in for it, of which nothing is true.
    """

    mooring: Net = field(repr=False)
    name: str
    type: str = "net"
    status: str
    iterations: int
    segments: int
    miss: float
    closure: float
    accuracy: Accuracy
    legs: tuple[Result, ...]
    nodes: tuple[NodePlace, ...]
    anchors: tuple[EndLoad, ...]
    held: tuple[EndLoad, ...]
    warnings: tuple[str, ...] = ()

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
        """What is clamped on them."""
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
        free = np.array([1.0 if keys.top.free else nan for keys in self.file.legs])
        return {
            "top_depth": free * [leg.top.depth for leg in self.legs],
            "anchor_vertical": np.array([leg.anchor.vertical for leg in self.legs]),
            "anchor_horizontal": np.array([leg.anchor.horizontal for leg in self.legs]),
            "used_buoyancy": free * [leg.top.used_buoyancy for leg in self.legs],
        }

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of the result format; None stands where a figure is unknown."""
        from calm.version import __version__

        components, clamps = self.components.to_dicts(), self.clamps.to_dicts()
        for component in components:
            for name in ("kind", "role", "tension", "least_tension"):
                del component[name]
        numbers = leg_numbers(self.file)
        for row in (*components, *clamps):
            row["leg"] = self.legs[numbers[row["index"]]].name
        legs = [
            {
                "name": leg.name,
                "closure": leg.closure,
                "used_buoyancy": leg.top.used_buoyancy,
                "reserve": leg.top.reserve,
                "shape": {name: column.tolist() for name, column in vars(leg.shape).items()},
            }
            for leg in self.legs
        ]
        anchors = [asdict(each) for each in self.anchors]
        told = ("name", "type", "status", "iterations", "segments", "miss", "closure")
        return {
            "calm": __version__,
            **{name: getattr(self, name) for name in told},
            "accuracy": {k: v for k, v in asdict(self.accuracy).items() if v is not None},
            **({"anchor": anchors[0]} if len(anchors) == 1 else {}),
            "anchors": anchors,
            "held": [
                {k: v for k, v in asdict(each).items() if k not in _OF_ANCHORS}
                for each in self.held
            ],
            "nodes": [asdict(each) for each in self.nodes],
            "legs": legs,
            "components": components,
            "clamps": clamps,
            "warnings": list(self.warnings),
        }


_OF_ANCHORS = ("required_weight", "weight", "grounded_length")

AnyResult = Result | TowResult | NetResult


def legs_of(result: Result | NetResult) -> tuple[Result, ...]:
    """Return the legs of a net; a mooring is one."""
    return result.legs if isinstance(result, NetResult) else (result,)
