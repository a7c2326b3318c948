"""Design oceanographic moorings: shape, tensions and anchor load in static equilibrium.

>>> import calm
>>> result = calm.load("lines/s1000.yaml").solve()
>>> round(result.top.knockdown, 1)
32.2
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from calm.version import __version__ as __version__

if TYPE_CHECKING:
    from calm.batch.profiles import Profiles, solve_profiles
    from calm.case import Design, Result, load
    from calm.case.explain import explain
    from calm.case.leg_result import LegResult
    from calm.case.size import size
    from calm.checks.design_check import check
    from calm.drop.plan import drop_plan
    from calm.errors import CalmError, InputError, NoEquilibrium, UsageError
    from calm.gridding.gridded_record import GriddedRecord, grid
    from calm.motion.motion_estimate import estimate_motion
    from calm.motion.study import MotionEstimate
    from calm.ranging import locate

__all__ = [
    "CalmError", "Design", "GriddedRecord", "InputError", "LegResult", "MotionEstimate",
    "NoEquilibrium", "Profiles", "Result", "UsageError", "__version__", "check", "drop_plan",
    "estimate_motion", "explain", "grid", "load", "locate", "size", "solve_profiles",
]  # fmt: skip

# imported on first use, so that `import calm` is fast
_HOMES = {
    "calm.batch.profiles": ("Profiles", "solve_profiles"),
    "calm.case": ("Design", "Result", "load"),
    "calm.case.explain": ("explain",),
    "calm.case.leg_result": ("LegResult",),
    "calm.case.size": ("size",),
    "calm.checks.design_check": ("check",),
    "calm.drop.plan": ("drop_plan",),
    "calm.errors": ("CalmError", "InputError", "NoEquilibrium", "UsageError"),
    "calm.gridding.gridded_record": ("GriddedRecord", "grid"),
    "calm.motion.motion_estimate": ("estimate_motion",),
    "calm.motion.study": ("MotionEstimate",),
    "calm.ranging": ("locate",),
}


def __getattr__(name: str) -> object:
    home = next((home for home, names in _HOMES.items() if name in names), None)
    if home is None:
        raise AttributeError(f"module 'calm' has no attribute {name!r}")
    from importlib import import_module

    value = getattr(import_module(home), name)
    if home.startswith("calm.case"):
        _register_result_forms()
    globals()[name] = value
    return value


def _register_result_forms() -> None:
    # these functions use packages that `calm.case` must not import
    from calm.case import Result

    def html(result: Result) -> str:
        from calm.report.html import fragment
        from calm.report.sheet import result_part

        return fragment(result_part(result))

    def netcdf(result: Result) -> bytes:
        from calm.report.result_files import result_netcdf

        return result_netcdf(result)

    def plot(result: Result, ax: Any) -> Any:
        from calm.drawing.line_picture import elevation_of
        from calm.drawing.plot import plot_elevation

        return plot_elevation(elevation_of(result), ax)

    Result.notebook_form = staticmethod(html)
    Result.plot_form = staticmethod(plot)
    Result.netcdf_form = staticmethod(netcdf)


def __dir__() -> list[str]:
    return sorted(__all__)
