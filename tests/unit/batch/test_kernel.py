"""The lanes: packed arithmetic, the plain march's element, and where they are kept."""

import platform
import re
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pytest

from calm.batch.kernel import cable, compiled, lanes, rod
from calm.batch.kernel.closing import place_free_end
from calm.batch.kernel.march import march as march_lanes
from calm.batch.kernel.plan import plan_of
from calm.batch.kernel.profile import lay_profile, read_profile
from calm.case import Mooring, load
from calm.physics.march import Cuts, march
from calm.physics.profile import Profile
from calm.physics.track import Track
from calm.shipped import shipped_folder

AVX = platform.machine() in ("x86_64", "AMD64") and any(
    "avx" in feature for feature in numba.core.codegen.get_host_cpu_features().split(",")
    if feature.startswith("+")
)  # fmt: skip


@pytest.mark.slow  # it compiles the kernel anew
@pytest.mark.skipif(not AVX, reason="packed square roots are told by their names on x86-64")
@pytest.mark.parametrize("function", [cable.pass_segments, rod.pass_piece])
def test_square_roots_are_packed(function: Any) -> None:
    marching()  # compiles
    for assembly in function.inspect_asm().values():
        # the tension, the thinning, |V × A|, |A + c V|, the axis, |Vn| in a segment; in a piece
        # |V|, |V × A|, |A|, |A + c V|, the axis, |Vn|
        assert len(re.findall(r"\bvsqrtpd\s.*%[yz]mm", assembly)) >= 6


def marching() -> tuple[Mooring, np.ndarray, np.ndarray]:
    """A mooring in its own current, its lanes' heights at the end and forces there."""
    mooring = load(shipped_folder("lines") / "cdms-1.yaml")
    assert isinstance(mooring, Mooring)
    plan = plan_of(mooring)
    assert plan is not None
    water = mooring.water
    levels = len(water.level) + len(plan.fixed)
    read, joined = np.zeros((levels, 4)), np.zeros((levels, 5))
    bounds, rows = np.zeros((1, levels + 2)), np.zeros((1, levels + 1, 8))
    count = read_profile(water.level, water.u, water.v, water.w, read)
    lay_profile(read, count, plan.fixed, bounds[0], rows[0], joined)
    s = np.zeros(lanes.SCRATCH)
    for lane in range(lanes.LANES):
        place_free_end(s, lane, 80.0 + lane, *plan.floating)
    stages = plan.clear.stages
    nodes = np.zeros(lanes.STATE * lanes.LANES * (len(stages[0]) + 1))
    forces = np.zeros(3 * lanes.LANES * len(stages[6]))
    own = np.zeros((3, 1, len(stages[5])))
    tables = np.zeros(lanes.LANES, np.int64), np.zeros(lanes.LANES, np.int64), bounds, rows
    march_lanes(s, tables, stages, 3, nodes, forces, own)
    return mooring, s[lanes.Z : lanes.Z + lanes.LANES], s[lanes.FX : lanes.FX + 3 * lanes.LANES]


def test_a_lane_ends_where_the_plain_march_does() -> None:
    mooring, z, force = marching()
    track, profile = Track.of(mooring.line), Profile(mooring.water)
    stages = plan_of(mooring).clear.stages
    counts = [
        count for kind, count in zip(stages[0], stages[2], strict=True) if kind == lanes.CABLE
    ]
    cuts = Cuts(np.repeat(stages[5] / 8.0, 8), 8 * np.array(counts))
    for lane in range(lanes.LANES):
        end = march(track, profile, 80.0 + lane, angle_step=1.0, reach=1.0, cuts=cuts)
        # the lanes look a segment's current up where its top has it, one order further down
        assert z[lane] == pytest.approx(end.z, abs=1e-6 * mooring.water.depth)
        assert force[lane :: lanes.LANES] == pytest.approx(end.force, rel=1e-5, abs=1e-3)


def test_a_folder_that_cannot_be_written_is_done_without(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "file"
    file.write_text("")
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(file / "below"))
    compiled.cache_folder.cache_clear()
    assert compiled.cache_folder() is None
    doubled = compiled.entry(lambda x: 2.0 * x)
    compiled.cache_folder.cache_clear()
    assert doubled(1.5) == 3.0


def test_compiled_code_is_kept_where_the_user_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    compiled.cache_folder.cache_clear()
    folder = compiled.cache_folder()
    compiled.cache_folder.cache_clear()
    assert folder is not None
    assert folder.parent == tmp_path
    assert folder.is_dir()
