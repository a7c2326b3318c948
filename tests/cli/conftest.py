"""Small moorings that need no catalogue, and a place to run commands in."""

import subprocess
import sys
from types import SimpleNamespace

import pytest

from calm.case.memory import Memory
from calm.cli import main

MOORING = """\
name: {name}
environment:
  depth: 100 m
  current: {{speed: {speed}, toward: 90 deg}}
line:
  - {{use: ball, label: top float}}
  - {{use: rope, length: {length}, clamps: [{{use: logger, at: 10 m}}]}}
  - {{use: weight}}
components:
  ball: {{kind: sphere, role: float, diameter: 1 m, buoyancy: {buoyancy}, max_tilt: 80 deg}}
  rope: {{kind: cable, diameter: 10 mm, weight: 0.2 N/m, breaking_load: 20 kN}}
  logger: {{kind: cylinder, diameter: 40 mm, length: 0.3 m, buoyancy: -5 N}}
  weight: {{kind: anchor, weight: 5000 N}}
"""


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """An empty working folder, and no settings of the person who runs the tests."""
    for name in ("CALM_DEBUG", "NO_COLOR", "FORCE_COLOR", "COLUMNS", "CALM_CATALOG_DIR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "configuration"))
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    work = tmp_path / "work"
    work.mkdir()
    monkeypatch.chdir(work)
    return work


@pytest.fixture(scope="module")
def solved_once():
    """What several tests of a module solve is solved for the first of them."""
    shared = Memory()

    def share(memory):
        vars(memory).update(vars(shared))

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Memory, "__init__", share)
        yield


@pytest.fixture
def write_mooring(folder):
    def write(file="m.yaml", *, name="Test", speed="0.5 m/s", length="60 m", buoyancy="2000 N"):
        text = MOORING.format(name=name, speed=speed, length=length, buoyancy=buoyancy)
        (folder / file).write_text(text, encoding="utf-8")
        return file

    return write


@pytest.fixture
def heavy(write_mooring):
    """A mooring whose float cannot hold its line: no equilibrium."""
    return write_mooring("heavy.yaml", name="Heavy", buoyancy="10 N")


@pytest.fixture
def broken(folder):
    """A mooring file with two mistakes."""
    text = MOORING.format(name="Broken", speed="0.5", length="60 kg", buoyancy="2000 N")
    (folder / "broken.yaml").write_text(text, encoding="utf-8")
    return "broken.yaml"


@pytest.fixture
def calm(capsys):
    """Runs a command in this process; gives its exit code and what it wrote."""

    def run(*words):
        code = main([str(word) for word in words])
        written = capsys.readouterr()
        return SimpleNamespace(code=code, out=written.out, err=written.err)

    return run


@pytest.fixture
def calm_process(march_as_it_stands):
    """Runs a command in a process of its own, which need not load what is compiled."""

    def run(*words, **options):
        command = [sys.executable, "-m", "calm", *map(str, words)]
        options = {"capture_output": True, "text": True, "timeout": 120} | options
        return subprocess.run(command, check=False, **options)

    return run
