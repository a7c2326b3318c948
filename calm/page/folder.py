"""Write the page to a folder, which any web server can serve."""

import hashlib
import json
import shutil
from importlib.resources import files
from pathlib import Path
from typing import Any

from calm.errors import UsageError
from calm.page.archive import IN_RUNTIME, normal_name, packed
from calm.page.builder import BAR
from calm.page.documents import DOCUMENTS
from calm.shipped import shipped_folder
from calm.version import __version__
from calm.whole_file import put

PYODIDE = "https://cdn.jsdelivr.net/pyodide/v0.29.5/full/"
"""Address of Pyodide, the Python runtime, for pages without their own copy."""
PYTHON = "3.13"
"""Python version of the runtime."""
TERMINAL = "https://cdn.jsdelivr.net/npm/@xterm/xterm@6.0.0/"
"""Address of xterm.js, the terminal in the page."""

ARCHIVE = "calm.zip"
_RUNTIME = "runtime/"
_CORE = ("pyodide.mjs", "pyodide.asm.wasm", "python_stdlib.zip", "pyodide-lock.json")
_CODE = ("pyodide.asm.js", "pyodide.asm.mjs")
"""Names of the same Pyodide file in different versions of Pyodide."""
_SCREEN = ("xterm.js", "xterm.css")


def write_page(folder: Path, runtime: Path | None = None) -> list[str]:
    """Write the page to a folder and return the names of its files; other files are kept.

    `runtime` is a folder with releases of Pyodide and xterm.js, which are copied to the page. By
    default, the page loads the releases from `PYODIDE` and `TERMINAL`. Raise UsageError if a file
    of the runtime is missing.
    """
    found = {} if runtime is None else _runtime_files(runtime)
    python = PYTHON
    if found:
        python = ".".join(_lock(found["pyodide-lock.json"])["info"]["python"].split(".")[:2])
    own = {each.name: each.read_bytes() for each in (files("calm.page") / "web").iterdir()}
    own[ARCHIVE] = packed(python)
    own["page.json"] = json.dumps(_settings(own, found), ensure_ascii=False, indent=1).encode()
    folder.mkdir(parents=True, exist_ok=True)
    for name, path in found.items():
        (folder / _RUNTIME).mkdir(exist_ok=True)
        shutil.copyfile(path, folder / _RUNTIME / name)
    for name, content in own.items():
        put(folder / name, content)
    return [*own, *(_RUNTIME + name for name in found)]


def _settings(own: dict[str, bytes], found: dict[str, Path]) -> dict[str, Any]:
    digest = hashlib.sha256()
    for name in sorted(own):
        digest.update(own[name])
    for name in sorted(found):
        digest.update(name.encode() + str(found[name].stat().st_size).encode())
    terminal = {name: _RUNTIME + name for name in _SCREEN}
    if not found:
        terminal = {"xterm.js": f"{TERMINAL}lib/xterm.js", "xterm.css": f"{TERMINAL}css/xterm.css"}
    return {
        "version": __version__,
        "built": digest.hexdigest()[:16],
        "runtime": _RUNTIME if found else PYODIDE,
        "packages": list(IN_RUNTIME),
        "terminal": terminal,
        "archive": {"name": ARCHIVE, "size": len(own[ARCHIVE])},
        "examples": _examples(),
        "documents": [{"kind": each.kind, "title": each.title} for each in DOCUMENTS],
        "actions": [each._asdict() for each in BAR],
    }


def _examples() -> list[dict[str, str]]:
    found = []
    for path in sorted(shipped_folder("lines").glob("*.yaml")):
        lines = path.read_text(encoding="utf-8").splitlines()
        names = [line.partition(":")[2] for line in lines if line.startswith("name:")]
        found.append({"file": path.name, "title": (names or [path.stem])[0].strip().strip("'\"")})
    return found


def _lock(path: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return found


def _runtime_files(runtime: Path) -> dict[str, Path]:
    if not runtime.is_dir():
        raise UsageError(f"--runtime: there is no folder {runtime}")
    there: dict[str, Path] = {}
    for path in sorted(runtime.rglob("*"), key=lambda path: len(path.parts), reverse=True):
        there[path.name] = path  # the uppermost of several files of this name
    wanted = [*_CORE, *_SCREEN]
    wanted += [name for name in _CODE if name in there] or _CODE[:1]
    if "pyodide-lock.json" in there:
        packages = _lock(there["pyodide-lock.json"])["packages"]
        names = list(IN_RUNTIME)
        for name in names:  # the loop appends the packages that a package needs
            if name in packages:
                needed = map(normal_name, packages[name]["depends"])
                names += [each for each in needed if each not in names]
        wanted += [packages[name]["file_name"] if name in packages else name for name in names]
    missing = [name for name in wanted if name not in there]
    if missing:
        raise UsageError(
            f"--runtime: {runtime} lacks {', '.join(missing)}; it must contain a distribution of "
            "Pyodide, and the files xterm.js and xterm.css of the npm package @xterm/xterm"
        )
    return {name: there[name] for name in wanted}
