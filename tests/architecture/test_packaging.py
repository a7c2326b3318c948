"""What is built is what stands in the checkout, and it works away from it."""

import importlib.metadata
import os
import re
import runpy
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest
import yaml
from hatchling.builders.sdist import SdistBuilder
from hatchling.builders.wheel import WheelBuilder

import calm
from calm.cli import main
from calm.version import commit_of

ROOT = Path(__file__).resolve().parents[2]
INSTALLED_AS = {
    "calm": "calm",
    "catalog": "calm/_shipped/catalog",
    "lines": "calm/_shipped/lines",
    "docs": "calm/_shipped/docs",
}


def build_wheel(project: Path, folder: Path) -> Path:
    return Path(
        next(WheelBuilder(str(project)).build(directory=str(folder), versions=["standard"]))
    )


def checkout_files() -> dict[str, bytes]:
    """Contents of the files to install, by their path in the wheel."""
    return {
        f"{target}/{path.relative_to(ROOT / source).as_posix()}": path.read_bytes()
        for source, target in INSTALLED_AS.items()
        for path in (ROOT / source).rglob("*")
        if path.is_file()
        and "__pycache__" not in path.parts
        and path.name != "_site.zip"
        and not (source == "docs" and path.suffix in (".py", ".1"))
    }


def wheel_files(wheel: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(wheel) as archive:
        return {
            name: archive.read(name)
            for name in archive.namelist()
            if ".dist-info/" not in name and ".data/" not in name
        }


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build_wheel(ROOT, tmp_path_factory.mktemp("wheel"))


def test_the_wheel_holds_the_checkout_and_nothing_else(wheel: Path) -> None:
    built, wanted = wheel_files(wheel), checkout_files()
    assert built.pop("calm/_shipped/commit", b"").decode().strip() == commit_of(ROOT)
    assert sorted(built) == sorted(wanted)
    assert built == wanted


def test_the_wheel_installs_the_manual_page(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        (name,) = [name for name in archive.namelist() if name.endswith("share/man/man1/calm.1")]
        assert archive.read(name) == (ROOT / "docs" / "calm.1").read_bytes()


@pytest.mark.thorough
def test_the_source_distribution_builds_the_same_wheel(wheel: Path, tmp_path: Path) -> None:
    source = next(SdistBuilder(str(ROOT)).build(directory=str(tmp_path), versions=["standard"]))
    with tarfile.open(source) as archive:
        archive.extractall(tmp_path, filter="data")
    unpacked = Path(str(source).removesuffix(".tar.gz"))
    assert wheel_files(build_wheel(unpacked, tmp_path)) == wheel_files(wheel)
    assert all((unpacked / file).exists() for file in ("README.md", "tests/conftest.py"))


def test_the_wheel_finds_its_own_catalogue_and_lines(wheel: Path, tmp_path: Path) -> None:
    site = tmp_path / "site"
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(site)
    line = site / "calm" / "_shipped" / "lines" / "deep-current-meters.yaml"
    program = (
        "import sys, calm, calm.cli; print(calm.__file__, file=sys.stderr); "
        f"sys.argv = ['calm', 'run', {str(line)!r}]; sys.exit(calm.cli.main())"
    )
    finished = subprocess.run(
        [sys.executable, "-c", program],
        cwd=tmp_path,
        # compiling at another place takes 17 s
        env={**os.environ, "PYTHONPATH": str(site), "CALM_COMPILED": "never"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert finished.returncode == 0, finished.stderr
    assert str(site) in finished.stderr


def index_page(*words: str | None) -> str:
    return runpy.run_path(str(ROOT / "hatch_build.py"))["index_page"](*words)


def description(wheel: Path) -> str:
    """What a package index shows of a wheel."""
    with zipfile.ZipFile(wheel) as archive:
        (name,) = [name for name in archive.namelist() if name.endswith(".dist-info/METADATA")]
        return archive.read(name).decode("utf-8").partition("\n\n")[2]


def test_an_index_shows_the_pictures_of_the_readme_at_the_tag_of_the_version() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    page = index_page(readme, "https://forge.example/calm/", "1.2.3")
    places = {
        view: re.findall(rf"https://forge\.example/calm/{view}/v1\.2\.3/([^)#\"\s]+)", page)
        for view in ("raw", "blob")
    }
    assert len(places["raw"]) == readme.count("![") + readme.count("<img ") >= 3
    assert all((ROOT / place).is_file() for found in places.values() for place in found)
    assert not re.search(r'(\]\(|src=")(?!https?:)', page)
    # nothing else is changed
    assert re.sub(r"https://forge\.example/calm/(raw|blob)/v1\.2\.3/", "", page) == readme


def test_an_index_is_given_no_picture_or_link_that_it_cannot_show(wheel: Path) -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    page, homeless = description(wheel), index_page(readme, None, "")
    source = project.get("urls", {}).get("Source")
    assert page.rstrip() == index_page(readme, source, project["version"]).rstrip()
    for text in (page, homeless):
        assert not re.search(r'(\]\(|src=")(?!https?:)', text)
        assert "Your first mooring" in text
    assert not re.search(r"<img|!\[", homeless)


def test_there_is_one_version(capsys: pytest.CaptureFixture[str]) -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    newest = re.search(r"^## \[?(\d+\.\d+\.\d+)", changelog, re.MULTILINE)
    assert newest is not None
    sys_argv, sys.argv = sys.argv, ["calm", "--version"]
    try:
        main()
    except SystemExit:
        pass
    finally:
        sys.argv = sys_argv
    versions = {
        project["version"],
        calm.__version__,
        importlib.metadata.version("calm-mooring"),
        newest[1],
        capsys.readouterr().out.split()[0],
    }
    assert versions == {calm.__version__}


def test_development_dependencies_are_listed_once() -> None:
    """As an extra, which every pip knows."""
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert settings["project"]["optional-dependencies"]["dev"]
    assert "dependency-groups" not in settings


def test_constraints_name_every_direct_dependency() -> None:
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    wanted = [
        *settings["build-system"]["requires"],
        *settings["project"]["dependencies"],
        *(
            wanted
            for extra in ("dev", "docs", "release", "records", "cluster", "plot")
            for wanted in settings["project"]["optional-dependencies"][extra]
        ),
    ]
    pinned = {
        line.partition("==")[0].lower()
        for line in (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
        if not line.startswith("#")
    }
    others = [name for name in wanted if not name.startswith("calm-mooring[")]
    missing = [name for name in others if re.split(r"[^\w.-]", name.lower())[0] not in pinned]
    assert not missing


def test_the_conda_recipe_wants_what_the_wheel_wants() -> None:
    named = {"typst": "typst-py"}
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    wanted = [dependency.lower().partition(">=") for dependency in project["dependencies"]]
    recipe = yaml.safe_load((ROOT / "conda" / "recipe.yaml").read_text(encoding="utf-8"))
    assert recipe["context"]["version"] == project["version"]
    assert recipe["requirements"]["run"] == [
        f"python {project['requires-python']}",
        *(f"{named.get(name, name)} >={least}" for name, _, least in wanted),
    ]
