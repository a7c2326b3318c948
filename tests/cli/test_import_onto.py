"""`calm import LIST --onto MOORING`: serial numbers of a list, on the line that carries them."""

import json
from datetime import datetime

import numpy as np
import pytest
import xarray

import calm as package
from calm.motion import matching

LINE = """\
position: {latitude: 48 deg, longitude: -10 deg}
environment:
  depth: 500 m
  current: {speed: 0.1 m/s, toward: 0 deg}
line:
  - {use: glass-17in, count: 6, label: top}
  - use: wire-jacketed-8
    length: 390 m   # measured
    label: wire
    clamps:
      - {use: sbe37, at: 10 m, label: upper}
      - {use: sbe37, at: 110 m, label: middle}
      - {use: sbe37, at: 310 m, label: lower}
  - {use: release-ar861, label: release}
  - {use: anchor-wheels-3}
deployed:
  date: 2026-03-01   # by the mate
"""
"""Clamps at some 113, 213 and 413 m in still water."""

CSV = """\
name,serial number,nominal depth[m],clock offset[s]
MicroCAT,3222,115,12
MicroCAT,3223,215,-3
MicroCAT,3224,415,
"""
HEIGHTS = """\
instrument,s/n,height above bottom [m]
MicroCAT,3222,387
MicroCAT,3223,287
lower,3224,
"""
RODB = """\
Mooring              = m1
WaterDepth           = 500
Columns              = z:instrument:serialnumber
  115  337  3222
  215  337  3223
  415  337  3224
"""
OCEANARRAY = """\
name: m1
waterdepth: 500
inline:
  - {instrument: release, serial: 77, hab: 10}
clamp:
  - {instrument: microcat, serial: 3222, hab: 385}
  - {instrument: microcat, serial: 3223, depth: 215}
  - {instrument: microcat, serial: 3224, hab: 85}
"""


def imos(path):
    """Three instruments one after the other, as in an aggregated product of IMOS."""
    index = ("OBSERVATION", np.repeat([0, 1, 2], 4), {"instance_dimension": "INSTRUMENT"})
    xarray.Dataset(
        {
            "TEMP": ("OBSERVATION", np.arange(12.0), {"units": "degree_Celsius"}),
            "instrument_index": index,
            "instrument_id": ("INSTRUMENT", [f"M1; SBE37; 322{i}" for i in (2, 3, 4)]),
            "NOMINAL_DEPTH": ("INSTRUMENT", [115.0, 215.0, 415.0], {"units": "m"}),
        },
        {"TIME": ("OBSERVATION", np.tile(np.arange(4.0), 3), {"units": "days since 2026-03-01"})},
    ).to_netcdf(path, engine="h5netcdf")


@pytest.fixture
def assigned(calm, folder):
    def run(name, text=None, *options):
        (folder / "m.yaml").write_text(LINE)
        if text is not None:
            (folder / name).write_text(text)
        done = calm("import", name, "--onto", "m.yaml", "-o", "new.yaml", *options)
        out = folder / "new.yaml"
        return done, out.read_text() if out.exists() else ""

    return run


@pytest.mark.parametrize(("name", "text"), [
    ("list.csv", CSV), ("heights.csv", HEIGHTS), ("info.dat", RODB), ("m.yml", OCEANARRAY),
    ("imos.nc", None),
])  # fmt: skip
def test_each_instrument_is_assigned_and_reported(assigned, folder, name, text):
    imos(folder / "imos.nc")
    done, written = assigned(name, text)
    assert done.code == 0, done.err
    for label, serial in (("upper", 3222), ("middle", 3223), ("lower", 3224)):
        assert f"{{label: {label}, serial: {serial}" in written
        assert any(str(serial) in line and f"`{label}`" in line for line in done.err.splitlines())
    # all else stays byte for byte
    kept = written.splitlines()
    assert [line for line in LINE.splitlines() if line not in kept] == []


def test_clock_offsets_and_what_has_no_place(assigned, calm):
    done, written = assigned("list.csv", f"{CSV}Aquadopp,99,300,\n", "--json", "out.json")
    assert done.code == 0, done.err
    assert "{label: upper, serial: 3222, remark: clock 12 s late}" in written
    assert "{label: middle, serial: 3223, remark: clock 3 s early}" in written
    assert "list.csv, line 5: Aquadopp 99 matches no part of the line" in done.err
    said = " ".join(done.err.split())
    assert "offset for 2 of " in said and "does not correct their times" in said
    assert "true time; this time must be after the deployment" in said
    with open("out.json") as file:
        document = json.load(file)
    assert len(document["assigned"]) == 3 and len(document["doubts"]) == 2
    assert calm("check", "new.yaml").code in (0, 1)


CHECKED = "2027-03-02T10:40"
CLOCKS = {
    "checked.csv": """\
name,serial,depth[m],clock offset[min],clock checked [UTC],recovery
MicroCAT,3222,115,0.2,2027-03-02T10:40,2027-03-01
MicroCAT,3223,215,-0.05,,2027/03/02 10:40
MicroCAT,3224,415,,2027-03-02T10:40,2027-03-01
""",
    "imos.csv": """\
name,serial,depth[m],TimeDriftInstrument,TimeDriftGPS
MicroCAT,3222,115,2027-03-02T10:39:48,2027-03-02T10:40
MicroCAT,3223,215,2027-03-02T10:40:03,2027-03-02T10:40
MicroCAT,3224,415,,
""",
    "info.dat": """\
End_Date = 2027/03/02
End_Time = 10:40
Columns = z:instrument:serialnumber:clockoffset
  115  337  3222 12
  215  337  3223 -3
  415  337  3224 nan
""",
    "m.yml": """\
name: m1
waterdepth: 500
recovery_time: 2027-03-02T10:40:00
inline:
  - {instrument: release, serial: 77, hab: 10}
clamp:
  - {instrument: microcat, serial: 3222, hab: 385, clock_drift_seconds: 12}
  - {instrument: microcat, serial: 3223, hab: 285, computer_clock_at_recovery: "2027-03-02T10:40:00", instrument_clock_at_recovery: "2027-03-02T10:40:03"}
  - {instrument: microcat, serial: 3224, hab: 85, clock_offset: 5}
""",  # noqa: E501
}


@pytest.mark.parametrize("name", CLOCKS)
def test_a_clock_offset_with_the_time_of_its_check_corrects_the_times(assigned, name):
    done, written = assigned(name, CLOCKS[name])
    assert done.code == 0, done.err
    assert "the times are not corrected" not in " ".join(done.err.split())
    assert ("clock 5 s late since the deployment" in written) == (name == "m.yml")
    clocks = matching.clocks_of(package.load("new.yaml"), np.datetime64("2026-03-01"))
    assert {label: (str(one.checked)[:16], one.late) for label, one in clocks.items()} == {
        "upper": (CHECKED, pytest.approx(12.0)), "middle": (CHECKED, pytest.approx(-3.0)),
    }  # fmt: skip
    assert f"its clock was 12 s late at {CHECKED}" in " ".join(done.err.split())


@pytest.mark.parametrize(("name", "old", "new"), [
    ("info.dat", RODB, f"End_Date = unknown\n{RODB}"),
    ("m.yml", "clamp:", "recovery_time: in May\nclamp:"),
])  # fmt: skip
def test_a_time_of_recovery_that_no_clock_needs_is_not_read(assigned, name, old, new):
    done, written = assigned(name, {"info.dat": RODB, "m.yml": OCEANARRAY}[name].replace(old, new))
    assert done.code == 0, done.err
    assert "serial: 3223" in written


def test_a_check_before_the_deployment_is_a_remark(assigned):
    text = CLOCKS["imos.csv"].replace("2027-03", "2025-03")
    done, written = assigned("list.csv", text)
    assert "remark: clock 12 s late" in written and "for 2 of " in done.err


def test_a_workbook_is_read_like_csv(assigned, folder):
    openpyxl = pytest.importorskip("openpyxl", reason="writes the workbook")
    moment = datetime(2027, 3, 2, 10, 40)
    book = openpyxl.Workbook()
    for row in (
        ["name", "serial", "depth[m]", "clock offset[s]", "clock checked"],
        ["MicroCAT", 3222, 115.0, 12, moment], ["MicroCAT", 3223, 215.0, -3, moment],
        ["MicroCAT", 3224, 415.0],
    ):  # fmt: skip
        book.active.append(row)
    book.save(folder / "list.xlsx")
    done, written = assigned("list.xlsx")
    assert done.code == 0, done.err
    assert f"serial: 3223\n      clock: {{checked: {CHECKED}, late: -3 s}}" in written


def test_the_label_of_a_part_is_enough(assigned):
    done, written = assigned("list.csv", "name,serial\nmiddle,41\n")
    assert done.code == 0 and "{label: middle, serial: 41}" in written


@pytest.mark.parametrize(("text", "said"), [
    ("name,colour\nMicroCAT,red\n", "no column for serial numbers or nominal depths"),
    ("time,depth[m],u[m/s]\n2026-03-01,115,0.3\n", "lists no usable instrument"),
    ("name,serial,depth[m]\nMicroCAT,3222,deep\n", "`deep`"),
    ("name,serial,depth[kg]\nMicroCAT,3222,12\n", "kg"),
    ("name,serial,depth[m]\nMicroCAT,3222,168.4\n", "could be `upper` or `middle`"),
    ("name,serial,clock checked\nMicroCAT,3222,2.3.2027\n", "`2.3.2027` is not a time"),
    ("name,serial,clock checked [CET]\nMicroCAT,3222,2027-03-02\n", "times must be in UTC"),
])  # fmt: skip
def test_lists_that_cannot_be_assigned_are_refused(assigned, text, said):
    done, written = assigned("list.csv", text)
    assert done.code == 2 and said in done.err and written == ""


@pytest.mark.parametrize(("name", "old", "new", "said"), [
    ("m.yml", "seconds: 12", "seconds: twelve", "m.yml:7:1: `twelve` is no number"),
    ("m.yml", "2027-03-02T10:40:00\ninline", "soon\ninline", "`soon` is not a time"),
    ("info.dat", "3222 12", "3222 x", "info.dat:4:1: `x` is no number"),
    ("info.dat", "2027/03/02", "03/2027", "`03-2027 10:40` is not a time"),
])  # fmt: skip
def test_a_clock_that_cannot_be_read_is_refused(assigned, name, old, new, said):
    done, written = assigned(name, CLOCKS[name].replace(old, new))
    assert done.code == 2 and said in done.err and written == ""
