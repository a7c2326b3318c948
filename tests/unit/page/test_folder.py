"""The folder of a page: what is written, from where, and what a runtime has to hold."""

import importlib.metadata
import json
import py_compile
import re
import sys
import tomllib
import zipfile
from functools import cache
from io import BytesIO
from pathlib import Path

import pytest

from calm.errors import UsageError
from calm.page import archive, folder
from calm.page.folder import write_page
from calm.shipped import shipped_folder

ROOT = Path(__file__).resolve().parents[3]
SELF = f"{sys.version_info[0]}.{sys.version_info[1]}"


packed = cache(archive.packed)
"""The archive for a version of Python, made once."""


@pytest.fixture(autouse=True)
def packed_once(monkeypatch):
    """A page has the archive that was made before."""
    monkeypatch.setattr(folder, "packed", packed)


def opened(python):
    return zipfile.ZipFile(BytesIO(packed(python)))


@pytest.fixture
def runtime(tmp_path):
    """A folder as a release of Pyodide has it, with xterm.js of npm beside it."""
    pyodide, xterm = tmp_path / "rt/pyodide", tmp_path / "rt/package"
    (xterm / "lib").mkdir(parents=True)
    (xterm / "css").mkdir()
    pyodide.mkdir()
    (xterm / "lib/xterm.js").write_text("screen")
    (xterm / "css/xterm.css").write_text("style")
    needed = {"pydantic": ["pydantic_core"], "gsw": ["numpy"]}
    names = ("numpy", "pydantic", "pydantic-core", "pyyaml", "gsw", "scipy")
    packages = {
        name: {"file_name": f"{name}.whl", "depends": needed.get(name, [])} for name in names
    }
    lock = {"info": {"python": f"{SELF}.0"}, "packages": packages}
    (pyodide / "pyodide-lock.json").write_text(json.dumps(lock))
    for name in ("pyodide.mjs", "pyodide.asm.js", "pyodide.asm.wasm", "python_stdlib.zip"):
        (pyodide / name).write_text(name)
    for name in names:
        (pyodide / f"{name}.whl").write_text(name)
    return tmp_path / "rt"


def test_the_archive_has_what_the_builder_needs_and_no_compiled_code():
    with opened("3.1") as content:
        names = content.namelist()
    assert {"calm/tui/app.py", "calm/page/driver.py", "textual/app.py", "rich/console.py"} <= {
        *names
    }
    assert "calm/_shipped/lines/s1000.yaml" in names
    assert any(name.startswith("calm/_shipped/catalog/") for name in names)
    assert not [name for name in names if re.search(r"\.(so|pyc|ttf)$|/tests?/|^numpy/", name)]
    assert len(names) == len({*names})


def test_the_archive_of_the_same_files_is_the_same():
    assert archive.packed("3.1") == packed("3.1")


def test_modules_are_compiled_for_a_runtime_of_this_version():
    name = f"calm/__pycache__/errors.{sys.implementation.cache_tag}.pyc"
    with opened(SELF) as content:
        code = content.read(name)
    assert code[:4] == importlib.util.MAGIC_NUMBER
    flags = int.from_bytes(code[4:8], "little")
    assert flags == 1  # unchecked: its source has another time in the page
    assert py_compile.PycInvalidationMode.UNCHECKED_HASH


def test_its_libraries_are_among_those_of_the_package():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    wanted = {re.split(r"[^\w-]", each.lower())[0] for each in project["dependencies"]}
    assert {*archive.LIBRARIES, *archive.IN_RUNTIME} <= wanted
    left = wanted - {*archive.LIBRARIES, *archive.IN_RUNTIME}
    assert left == {"scipy", "typst", "cyclopts", "python-calamine"}
    found = {each.metadata["Name"].lower() for each in archive.distributions()}
    assert {"markdown-it-py", "markupsafe", "platformdirs"} <= found
    assert importlib.metadata.version("textual")


def test_a_page_loads_the_runtime_from_its_address(tmp_path):
    written = write_page(tmp_path / "page")
    assert sorted(written) == sorted(path.name for path in (tmp_path / "page").iterdir())
    settings = json.loads((tmp_path / "page/page.json").read_text(encoding="utf-8"))
    assert settings["runtime"] == folder.PYODIDE
    assert all(each.startswith(folder.TERMINAL) for each in settings["terminal"].values())
    files = {each["file"] for each in settings["examples"]}
    assert files == {path.name for path in shipped_folder("lines").glob("*.yaml")}
    assert {"file": "s1000.yaml", "title": "S1000"} in settings["examples"]


def test_a_page_has_a_copy_of_a_runtime_that_is_given(tmp_path, runtime):
    written = write_page(tmp_path / "page", runtime)
    copied = {path.name for path in (tmp_path / "page/runtime").iterdir()}
    assert "scipy.whl" not in copied
    assert {"pydantic-core.whl", "numpy.whl", "xterm.js", "pyodide.asm.js"} <= copied
    assert {f"runtime/{name}" for name in copied} <= {*written}
    settings = json.loads((tmp_path / "page/page.json").read_text(encoding="utf-8"))
    assert settings["runtime"] == "runtime/"
    assert settings["terminal"]["xterm.js"] == "runtime/xterm.js"
    scripts = "".join(
        (tmp_path / "page" / name).read_text(encoding="utf-8")
        for name in ("index.html", "page.js", "worker.js", "page.json", "offline.js", "page.css")
    )
    assert not re.findall(r"https?://[\w.]+", scripts)


def test_another_content_is_another_build(tmp_path, monkeypatch, runtime):
    built = []
    for content in ("one", "two"):
        monkeypatch.setattr(folder, "packed", lambda _, content=content: content.encode())
        write_page(tmp_path / content, runtime)
        settings = json.loads((tmp_path / content / "page.json").read_text(encoding="utf-8"))
        built.append(settings["built"])
    assert built[0] != built[1]


def test_a_runtime_that_lacks_files_is_refused(tmp_path, runtime):
    (runtime / "pyodide/pydantic-core.whl").unlink()
    (runtime / "package/css/xterm.css").unlink()
    with pytest.raises(UsageError, match=r"lacks xterm\.css, pydantic-core\.whl; it must contain"):
        write_page(tmp_path / "page", runtime)
    assert not (tmp_path / "page").exists()
    lock = runtime / "pyodide/pyodide-lock.json"
    lock.write_text(lock.read_text().replace('"gsw": {"file', '"other": {"file'))
    with pytest.raises(UsageError, match=r"lacks xterm\.css, gsw, pydantic-core\.whl;"):
        write_page(tmp_path / "page", runtime)
    with pytest.raises(UsageError, match="there is no folder"):
        write_page(tmp_path / "page", runtime / "nowhere")
