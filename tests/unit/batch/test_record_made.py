import hashlib
from pathlib import Path

import numpy as np

from calm.records.current_file import open_record
from calm.records.current_terms import Terms
from calm.records.record import DEPTHS, LATITUDE, LONGITUDE, made_record


def test_made_record_is_the_same_everywhere() -> None:
    # rounded to steps far coarser than the last digits of sines, by no library that stamps it
    assert hashlib.sha256(made_record()).hexdigest() == (
        "2084522129ebf05e6d280287ee610e6c4367373a5b12f026cd2011986bb64edb"
    )


def test_made_record_is_thirty_days_of_plausible_currents(tmp_path: Path) -> None:
    path = tmp_path / "record.nc"
    path.write_bytes(made_record())
    with open_record(path, Terms(300.0, place=(LATITUDE, LONGITUDE))) as record:
        depth, u, v, w = record.profiles(0, record.count)
        assert depth.tolist() == list(DEPTHS)
        assert u.shape == (720, 10)
        assert w is None
        speed = np.hypot(u, v)
        assert 0.6 < speed.max() < 0.9
        strongest = record.time[np.unravel_index(speed.argmax(), speed.shape)[0]]
        # within the half-day of the surge
        assert abs(strongest - np.datetime64("2026-03-19T12:00")) < np.timedelta64(24, "h")
        assert len(np.unique(np.diff(record.time))) == 1
