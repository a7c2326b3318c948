import json
import zlib

import numpy as np
import pytest
import zarr

from calm.batch.dataset import layout_of
from calm.batch.profiles import STATUSES, solve_profiles
from calm.batch.store.chunks import packed, unpacked
from calm.batch.store.identity import differences, identity_of, to_text
from calm.batch.store.store import WORK, open_store
from tests.unit.batch.made import MadeRecord, made_mooring


@pytest.fixture
def store(tmp_path):
    mooring, record = made_mooring(tmp_path), MadeRecord(40)
    layout = layout_of(mooring, record, None)
    identity = to_text(identity_of(mooring, record, {}))
    with open_store(tmp_path / "s.part", layout, 16, identity) as opened:
        yield opened


def chunks_of(store, number):
    record = MadeRecord(40)
    start, stop = store.span(number)
    mooring = made_mooring(store.folder.parent)
    profiles = solve_profiles(mooring, record.u[start:stop], record.v[start:stop], record.depth)
    arrays = store.layout.arrays(record.time[start:stop], profiles, None)
    return {
        variable.name: packed(
            np.resize(arrays[variable.name], store.chunk_shape(variable)).astype(variable.dtype)
        )
        for variable in store.in_blocks
    }


@pytest.mark.parametrize("dtype", ["<f4", "<i8", "|i1"])
def test_chunks_come_back_as_they_went(dtype):
    random = np.random.default_rng(1)
    values = (random.normal(size=(50, 7)) * 100).astype(dtype)
    data = packed(values)
    assert (unpacked(data, values.dtype, values.shape) == values).all()
    assert data == packed(values.copy())


def test_chunks_are_one_stream_that_any_inflater_reads():
    values = np.linspace(0.0, 1.0, 4096, dtype=np.float32)
    data = packed(values)
    inflater = zlib.decompressobj()
    planes = inflater.decompress(data)
    assert inflater.eof and not inflater.unused_data
    assert planes == values.view(np.uint8).reshape(-1, 4).T.tobytes()
    assert len(data) < 0.7 * values.nbytes


def test_zarr_reads_what_is_done_and_nan_elsewhere(store):
    store.write(1, chunks_of(store, 1))
    group = zarr.open_group(store.folder, mode="r")
    depth = group["depth_top"][:]
    assert depth.shape == (40, 4)
    assert np.isfinite(depth[16:32]).all()
    assert np.isnan(depth[:16]).all() and np.isnan(depth[32:]).all()
    assert group["component_label"][:].tolist()[0] == "top float"


def test_a_block_is_done_when_its_flag_tells_its_size(store):
    assert store.missing() == [0, 1, 2]
    store.write(1, chunks_of(store, 1))
    assert store.missing() == [0, 2]
    assert store.statuses().tolist() == [16, *[0] * (len(STATUSES) - 1)]
    flag = store.folder / WORK / "1"
    size = flag.read_text()
    for torn in ("", size[:-1]):
        flag.write_text(torn)
        assert store.missing() == [0, 1, 2]
    flag.write_text(size)
    (store.folder / "tilt" / "1.0").write_bytes(b"")
    assert store.missing() == [0, 1, 2]


def test_the_last_block_counts_its_own_profiles_alone(store):
    store.write(2, chunks_of(store, 2))
    assert store.span(2) == (32, 40)
    assert store.statuses().sum() == 8


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
        texts.append(to_text(identity_of(made_mooring(tmp_path / name), MadeRecord(), {})))
    assert texts[0] == texts[1]
    assert "checks" not in json.loads(texts[0])["mooring"]
