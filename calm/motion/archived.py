"""What makes the result of `calm motion` one for an archive: flags, serial numbers, attributes."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from calm.batch.profiles import Profiles
from calm.case import Mooring
from calm.case.parts import clamps_down
from calm.dataset.discovery import coverage, with_flags, written
from calm.dataset.netcdf import Attributes, ResultLayout, labels
from calm.motion.line_places import serials_of
from calm.motion.measurements import MooringMeasurements

MEASURED, ESTIMATED, MISSING = 1, 8, 9
"""Flags of depths, of the table of OceanSITES."""
FLAGGED = {"clamp_depth": ["clamp_depth_sd"], "depth_top": ["depth_sd"]}
_OF_DOCUMENT = {
    "institution": "institution", "author": "creator_name", "email": "creator_email",
    "url": "creator_url", "license": "license", "project": "project", "site": "site_code",
    "platform": "platform_code", "investigator": "principal_investigator",
    "acknowledgement": "acknowledgement", "ship": "platform_deployment_ship_name",
    "cruise": "platform_deployment_cruise_name",
}  # fmt: skip
"""Attributes of ACDD and OceanSITES, by the keys of `document:`."""


def about(mooring: Mooring) -> Attributes:
    """Return what `document:` and `deployed:` of a mooring file say, as archives call it."""
    file = mooring.file
    said: Attributes = {}
    if file.document is not None:
        known = file.document.to_dict()
        said = {name: str(known[key]) for key, name in _OF_DOCUMENT.items() if key in known}
    for part in ("name", "email", "url"):  # who writes the file is who publishes it
        if f"creator_{part}" in said:
            said[f"publisher_{part}"] = said[f"creator_{part}"]
    if "institution" in said:
        said["creator_institution"] = said["institution"]
    if file.deployed is not None and file.deployed.date is not None:
        said["platform_deployment_date"] = str(file.deployed.date)
    said["water_depth"] = float(mooring.water.depth)
    return said


def archived(
    layout: ResultLayout, mooring: Mooring, measured: MooringMeasurements, source: Mapping[str, str]
) -> ResultLayout:
    """Return a layout of motion with flags of depths, serial numbers, and attributes.

    Its date is that of SOURCE_DATE_EPOCH, and only that: the same input gives the same bytes.

    Parameters
    ----------
    source : what the record is from
    """
    variables = list(layout.variables)
    serials, clamps = serials_of(mooring), len(clamps_down(mooring.file.pieces))
    for dimension, mine in (("clamp", serials[:clamps]), ("component", serials[clamps:])):
        if any(mine):
            variables.append(labels(f"{dimension}_serial", dimension, mine, "serial number"))
    position = mooring.file.position
    deployed = mooring.file.deployed
    if deployed is not None and deployed.position is not None:
        position = deployed.position
    place = () if position is None else (position.latitude, position.longitude)
    name = str(layout.attributes["title"]).partition(": ")[0]
    inputs = "; ".join(filter(None, source.values()))
    attributes: Attributes = {
        **layout.attributes,
        **coverage(measured.time, (0.0, float(mooring.water.depth)), place),
        **about(mooring),
        "id": f"OS_{''.join(c if c.isalnum() else '-' for c in name)}_"
        f"{np.datetime_as_string(measured.time[0], 'M').replace('-', '')}_D_DEPTHS",
        "keywords": "EARTH SCIENCE > OCEANS > OCEAN PRESSURE",
        "processing_level": "Data interpolated",
        "comment": "Depths of a mooring line, estimated from its statics; x, y from the anchor",
        "instrument": ", ".join(measured.label),
        "history": f"{layout.attributes['history']}: {inputs}",
    }
    if not attributes.get("summary"):
        attributes["summary"] = f"Depths of every part of the mooring {name} over time"
    if os.environ.get("SOURCE_DATE_EPOCH"):
        attributes["date_created"] = attributes["date_modified"] = written()
    return replace(layout, variables=with_flags(variables, FLAGGED), attributes=attributes)


def depth_flags(one: MooringMeasurements, profiles: Profiles) -> dict[str, NDArray[np.int8]]:
    """Return flags of depths: measured where a pressure of its own counts, else interpolated."""
    clamps = profiles.clamp_depth.shape[1]
    depth = np.hstack([profiles.clamp_depth, profiles.depth_top])
    flag = np.where(np.isfinite(depth), ESTIMATED, MISSING).astype(np.int8)
    for j, point in enumerate(one.point.tolist()):
        own = np.isfinite(one.depth[:, j]) & (flag[:, point] == ESTIMATED)
        flag[own, point] = MEASURED
    return {"clamp_depth_qc": flag[:, :clamps], "depth_top_qc": flag[:, clamps:]}
