"""No file, however broken, ends a command with a traceback or an internal error."""

import warnings
from pathlib import Path
from random import Random

import numpy as np
import pytest
import xarray as xr

from calm.cli import main
from tests.property.mutants import mutant

LINES = sorted((Path(__file__).parents[2] / "lines").glob("*.yaml"))
EXPECTED = {0, 1, 2, 3}
CSV = "time,depth[m],u[m/s],v[m/s]\n" + "".join(
    f"2026-03-01T{hour:02d}:00,{depth},0.{hour % 10},-0.1\n"
    for hour in range(12)
    for depth in (5, 50, 90)
)
MOORING = """\
name: Small
environment: {depth: 100 m, current: {file: current.csv, time: "2026-03-01T06:00"}}
line:
  - {use: ball}
  - {use: rope, length: 60 m}
  - {use: weight}
components:
  ball: {kind: sphere, role: float, diameter: 1 m, buoyancy: 2000 N}
  rope: {kind: cable, diameter: 10 mm, weight: 0.2 N/m}
  weight: {kind: anchor, weight: 5000 N}
"""


def ended(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str]:
    """The exit code of a command, and what it said."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        code = main(list(words))
    written = capsys.readouterr()
    return int(code), written.err + written.out


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(20))
def test_mutated_mooring_files(
    seed: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    random = Random(seed)
    path = tmp_path / "mutant.yaml"
    for _ in range(100):
        text = mutant(random.choice(LINES).read_text(encoding="utf-8"), random)
        path.write_text(text, encoding="utf-8", newline="")
        words = random.choice((["run", "--json", "-"], ["run"], ["check"], ["run", "--explain"]))
        code, said = ended(capsys, words[0], str(path), *words[1:])
        assert code in EXPECTED, f"{said}\n{text}"
        assert "Traceback" not in said


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_mutated_records_of_text(
    seed: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    random = Random(seed)
    (tmp_path / "m.yaml").write_text(MOORING)
    for _ in range(100):
        (tmp_path / "current.csv").write_text(mutant(CSV, random), encoding="utf-8", newline="")
        code, said = ended(capsys, "run", str(tmp_path / "m.yaml"))
        assert code in EXPECTED, said
        assert "Traceback" not in said


def arrays() -> xr.Dataset:
    """A record as an archive holds it."""
    shape = ("time", "depth")
    u = np.linspace(0.1, 0.5, 12).reshape(4, 3)
    return xr.Dataset(
        {
            "u": (shape, u, {"units": "m/s", "standard_name": "eastward_sea_water_velocity"}),
            "v": (shape, -u, {"units": "m/s", "standard_name": "northward_sea_water_velocity"}),
        },
        {
            "time": ("time", np.arange(4.0), {"units": "hours since 2026-03-01"}),
            "depth": ("depth", [5.0, 50.0, 90.0], {"units": "m", "positive": "down"}),
        },
    )


ATTRIBUTES = ["units", "positive", "standard_name", "long_name", "calendar", "valid_range",
              "valid_min", "scale_factor", "_FillValue", "coord_sys", "orientation", "axis",
              "missing_value", "comment", "coordinates"]  # fmt: skip
WORDS = ["", "m", "m/s", "kg", "up", "[/x]", "beam", "magnetic", "hours since never", "-1",
         "noleap", "depth below the ADCP", "time depth", "\x00", "é" * 99]  # fmt: skip


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("seed", range(4))
def test_hostile_records_of_arrays(
    seed: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    random = Random(seed)
    for trial in range(60):
        # a name of its own: a file that could not be written stays open in the library
        path = tmp_path / f"current{trial}.nc"
        (tmp_path / "m.yaml").write_text(MOORING.replace("current.csv", path.name))
        dataset = arrays()
        for _ in range(random.randint(1, 3)):
            name = random.choice(list(dataset.variables))
            wanted = random.choice(ATTRIBUTES)
            dataset[name].attrs[wanted] = random.choice(WORDS)
            match random.randrange(6):
                case 0:
                    dataset[name] = dataset[name] * random.choice((1e9, -1.0, np.nan, 0.0))
                case 1:
                    dataset = dataset.drop_vars(name)
                case 2:
                    dataset = dataset.isel({random.choice(list(dataset.dims)): slice(0)})
                case 3:
                    more = random.choice(("x", "lat", "member"))
                    dataset = dataset if more in dataset.dims else dataset.expand_dims(more)
                case _:
                    pass
            if not dataset.variables or not dataset.dims:
                break
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                dataset.to_netcdf(path, engine="h5netcdf")
        except (ValueError, TypeError, OverflowError):
            continue  # what xarray does not write is not in a file
        if random.random() < 0.3:
            content = bytearray(path.read_bytes())
            for _ in range(random.randint(1, 40)):
                content[random.randrange(len(content))] = random.randrange(256)
            path.write_bytes(content[: random.choice((len(content), len(content) // 2))])
        code, said = ended(capsys, "run", str(tmp_path / "m.yaml"))
        assert code in EXPECTED, said
        assert "Traceback" not in said
