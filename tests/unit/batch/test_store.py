import json
import zlib
from pathlib import Path

import numpy as np
import pytest
import zarr
from calm.batch.store.chunks import packed, unpacked

from calm.batch.dataset import layout_of
from calm.batch.profiles import solve_profiles
from calm.batch.store.identity import differences, identity_of, to_text
from calm.batch.store.store import open_store
from tests.unit.batch.made import MadeRecord, content, made_mooring


@pytest.fixture
def store(tmp_path):
    mooring, record = made_mooring(tmp_path), MadeRecord(40)
    layout = layout_of(mooring, record, None)
    identity = to_text(identity_of(mooring, record, {}))
    return open_store(tmp_path / "s.part", layout, 16, identity)


STATUS = (16, *[0] * 8)


def missing(store):
    return [number for number in range(store.count) if store.flag(number) is None]


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
    store.write(1, chunks_of(store, 1), STATUS)
    group = zarr.open_group(store.folder, mode="r")
    depth = group["depth_top"][:]
    assert depth.shape == (40, 4)
    assert np.isfinite(depth[16:32]).all()
    assert np.isnan(depth[:16]).all() and np.isnan(depth[32:]).all()
    assert group["component_label"][:].tolist()[0] == "top float"


def test_a_block_is_done_when_its_flag_tells_its_sizes(store):
    assert missing(store) == [0, 1, 2]
    flag = store.write(1, chunks_of(store, 1), STATUS)
    assert missing(store) == [0, 2]
    assert store.flag(1) == flag
    assert flag.statuses == STATUS
    file = store.work / "1"
    told = file.read_text()
    for torn in ("", told[:-1], "{}", "17", bytes(len(told)).decode()):
        file.write_text(torn)
        assert missing(store) == [0, 1, 2]
    file.write_text(told)
    (store.folder / "tilt" / "1.0").write_bytes(b"")
    assert missing(store) == [0, 1, 2]


def test_a_chunk_that_has_changed_is_found_out(store):
    flag = store.write(1, chunks_of(store, 1), STATUS)
    tilt = next(variable for variable in store.in_blocks if variable.name == "tilt")
    file = store.chunk_file(tilt, 1)
    data = file.read_bytes()
    assert store.chunk(tilt, 1, flag) == data
    file.write_bytes(bytes(len(data)))  # as a power cut leaves it
    assert missing(store) == [0, 2]
    assert store.chunk(tilt, 1, flag) is None
    file.unlink()
    assert store.chunk(tilt, 1, flag) is None
    store.forget(1)
    store.forget(1)
    assert missing(store) == [0, 1, 2]


def test_a_file_being_written_is_never_seen_in_part(store, monkeypatch):
    """Somebody who comes late writes the same file again: until it is whole the other one stays."""
    store.write(1, chunks_of(store, 1), STATUS)
    file = store.folder / "tilt" / "1.0"
    data, seen = file.read_bytes(), []
    written = Path.write_bytes

    def slowly(path, content):
        written(path, content[:5])
        seen.append(file.read_bytes())
        return written(path, content)

    monkeypatch.setattr(Path, "write_bytes", slowly)
    store.write(1, chunks_of(store, 1), STATUS)
    assert len(seen) > 10
    assert set(seen) == {data}
    assert not list(store.folder.rglob("*.part"))


def test_metadata_that_a_power_cut_took_comes_back(tmp_path, store):
    mooring, record = made_mooring(tmp_path), MadeRecord(40)
    before = content(store.folder)
    for path in store.folder.rglob(".z*"):
        path.write_bytes(b"\0\0")
    (store.work / "0123.part").write_bytes(b"left by a killed process")
    identity = to_text(identity_of(mooring, record, {}))
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
        texts.append(to_text(identity_of(made_mooring(tmp_path / name), MadeRecord(), {})))
    assert texts[0] == texts[1]
    assert "checks" not in json.loads(texts[0])["mooring"]
