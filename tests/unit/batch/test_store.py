import json
from threading import Event

import numpy as np
import pytest
import zarr

from calm.batch.dataset import arrays_of, layout_of
from calm.batch.profiles import solve_profiles
from calm.batch.work_store import differences, identity_of, open_store, to_text
from tests.unit.batch.made import MadeRecord, content, made_mooring

pytestmark = pytest.mark.thorough


@pytest.fixture
def store(tmp_path):
    mooring, record = made_mooring(tmp_path), MadeRecord(40)
    layout = layout_of(mooring, record, None)
    identity = to_text(identity_of(mooring, record, {}, Event()))
    return open_store(tmp_path / "s.part", layout, 16, identity)


def missing(store):
    return [number for number in range(store.count) if store.statuses(number) is None]


def write(store, number):
    record = MadeRecord(40)
    start, stop = store.span(number)
    mooring = made_mooring(store.folder.parent)
    profiles = solve_profiles(mooring, record.u[start:stop], record.v[start:stop], record.depth)
    store.write(number, arrays_of(store.layout, record.time[start:stop], profiles, None))


def test_zarr_reads_what_is_done_and_nan_elsewhere(store):
    write(store, 1)
    group = zarr.open_group(store.folder, mode="r")
    assert group.metadata.zarr_format == 2
    depth = group["depth_top"][:]
    assert depth.shape == (40, 4)
    assert np.isfinite(depth[16:32]).all()
    assert np.isnan(depth[:16]).all() and np.isnan(depth[32:]).all()
    assert group["component_label"][:].tolist()[0] == "top float"


def test_a_block_is_done_when_it_has_its_flag(store):
    assert missing(store) == [0, 1, 2]
    write(store, 1)
    assert missing(store) == [0, 2]
    assert store.statuses(1).tolist() == [0] * 16
    (store.work / "1").unlink()
    assert missing(store) == [0, 1, 2]


def none(*_):
    pass


@pytest.mark.parametrize("left", [b"", b"\0" * 50, None], ids=["empty", "zeros", "gone"])
@pytest.mark.parametrize("name", ["tilt/2.0", "status/2"])
def test_a_chunk_that_has_changed_is_found_out(store, left, name):
    """As a power cut leaves it; the last chunk, which is shorter than the others, too."""
    for number in range(3):
        write(store, number)
    assert store.forget_damaged(none) == []
    file = store.folder / name
    file.unlink() if left is None else file.write_bytes(left)
    assert store.forget_damaged(none) == [2]
    assert missing(store) == [2]
    write(store, 2)
    assert store.forget_damaged(none) == []


def test_metadata_that_a_power_cut_took_comes_back(tmp_path, store):
    mooring, record = made_mooring(tmp_path), MadeRecord(40)
    before = content(store.folder)
    for path in store.folder.rglob(".z*"):
        path.write_bytes(b"\0\0")
    (store.folder / "tilt" / "2.0123.partial").write_bytes(b"left by a killed process")
    identity = to_text(identity_of(mooring, record, {}, Event()))
    open_store(store.folder, layout_of(mooring, record, None), 16, identity)
    assert content(store.folder) == before


def test_differences_are_told_in_words_and_not_all_of_many():
    before = {"a": {"b": [1, {"c": 2}]}, "gone": 1, "list": [1, 2]}
    now = {"a": {"b": [1, {"c": 3}]}, "new": "x", "list": [1]}
    assert differences(before, now) == (
        "a.b[1].c was 2, is now 3; gone was 1, is now absent; "
        "list was a list of 2, is now a list of 1; new was absent, is now x"
    )
    many = {str(number): number for number in range(8)}
    assert differences({}, many).endswith("; and 3 more")


def test_the_identity_is_the_same_from_another_folder(tmp_path):
    texts = []
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        texts.append(to_text(identity_of(made_mooring(tmp_path / name), MadeRecord(), {}, Event())))
    assert texts[0] == texts[1]
    assert "checks" not in json.loads(texts[0])["mooring"]
