"""The lanes: packed arithmetic, the plain march's element, and where they are kept."""

import platform
import re
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pytest

from calm.batch.kernel import cable, compiled, lane, rod
from calm.batch.kernel.afloat import place_free_end
from calm.batch.kernel.march import march as march_lanes
from calm.batch.kernel.plan import Plan, plan_of
from calm.batch.kernel.profile import lay_profile, read_profile
from calm.batch.kernel.seabed import pass_to_seabed
from calm.batch.kernel.solve import desk_for
from calm.case import Mooring, load
from calm.physics import compiled as physics_compiled
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
@pytest.mark.parametrize("function", [cable.pass_packed, rod.pass_piece])
def test_square_roots_are_packed(function: Any) -> None:
    mooring = load(shipped_folder("lines") / "cdms-1.yaml")
    assert isinstance(mooring, Mooring)
    plan = plan_of(mooring)
    kernel = compiled.called(march_lanes, singly=False)
    kernel.compile(tuple(map(numba.typeof, (desk_for(plan, 2, 1), plan.clear, 0))))
    function = compiled.called(function, singly=False)
    for assembly in function.inspect_asm().values():
        # the tension, the thinning, |V × A|, |A + c V|, the axis, |Vn| in a segment; in a piece
        # |V|, |V × A|, |A|, |A + c V|, the axis, |Vn|
        assert len(re.findall(r"\bvsqrtpd\s.*%[yz]mm", assembly)) >= 6


def call(marching: Any, desk: Any, way: Any, halvings: int) -> None:
    marching(desk, way, halvings)


def marching() -> tuple[Mooring, Plan, np.ndarray, np.ndarray]:
    """A mooring in its own current, its lanes' heights at the end and forces there."""
    mooring = load(shipped_folder("lines") / "cdms-1.yaml")
    assert isinstance(mooring, Mooring)
    plan, water = plan_of(mooring), mooring.water
    desk = desk_for(plan, len(water.level), 1)
    count = read_profile(water.level, water.u, water.v, water.w, desk.read)
    sea, s = desk.water.sea, desk.scratch
    intervals = sea.intervals.view(np.recarray)
    lay_profile(desk.read, count, plan.clear.fixed, sea.levels, intervals, desk.joined)
    for i in range(lane.LANES):
        place_free_end(s, i, 80.0 + i, plan.clear.rides)
    address = compiled.by_address(march_lanes, desk, plan.clear, 3)
    compiled.entry(call)(address, desk, plan.clear, 3)
    first = s[lane.Z : lane.Z + lane.LANES], s[lane.FX : lane.FX + 3 * lane.LANES]
    return mooring, plan, *first


def test_a_lane_ends_where_the_plain_march_does() -> None:
    mooring, plan, z, force = marching()
    track, profile = Track.of(mooring.line), Profile(mooring.water)
    counts = 8 * np.diff(plan.clear.first_cut)
    cuts = Cuts(np.repeat(plan.clear.cuts / 8.0, 8), counts)
    for i in range(lane.LANES):
        end = march(track, profile, 80.0 + i, angle_step=1.0, reach=1.0, cuts=cuts)
        # the lanes look a segment's current up where its top has it, one order further down
        assert z[i] == pytest.approx(end.z, abs=1e-6 * mooring.water.depth)
        assert force[i :: lane.LANES] == pytest.approx(end.force, rel=1e-5, abs=1e-3)


def test_a_folder_that_cannot_be_written_is_done_without(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "file"
    file.write_text("")
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(file / "below"))
    physics_compiled.cache_folder.cache_clear()
    assert compiled.cache_folder() is None
    doubled = compiled.entry(lambda x: 2.0 * x)
    physics_compiled.cache_folder.cache_clear()
    assert doubled(1.5) == 3.0


def test_kept_code_of_two_kinds_is_never_linked_to_each_other() -> None:
    # kept by two processes, functions of one name, flags and types are one to the linker
    def named(singly: bool) -> str:
        function: Any = compiled.called(pass_to_seabed, singly=singly).py_func
        return f"{function.__module__}.{function.__qualname__}"

    assert named(True) != named(False)


def test_compiled_code_is_kept_where_the_user_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    physics_compiled.cache_folder.cache_clear()
    folder = compiled.cache_folder()
    physics_compiled.cache_folder.cache_clear()
    assert folder is not None
    assert folder.parent == tmp_path
    assert folder.is_dir()
