"""Archive of CALM and its libraries for the page, made from the installed packages.

The archive contains only Python modules and data. Compiled libraries come with Pyodide, the Python
runtime of the page.
"""

import importlib.metadata
import io
import py_compile
import re
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from calm.shipped import shipped_folder

LIBRARIES = ("jinja2", "pint", "rich", "textual", "xlsxwriter")
"""Distributions required by the builder and its documents."""
IN_RUNTIME = ("numpy", "pydantic", "pyyaml", "gsw")
"""Distributions that Pyodide contains as compiled libraries."""

_DEPENDENCIES = ("annotated-types", "pydantic-core", "typing-extensions", "typing-inspection")
_EXCLUDED = re.compile(
    r"(^|/)(__pycache__|tests?|testsuite)/|\.(so|pyd|dylib|pyi|c|h|exe|whl|ttf|otf)$"
    r"|^calm/page/web/|^calm/verification/|^\.\./"
    r"|^pygments/(lexers|styles|formatters)/(?!__init__|_mapping|special|default|terminal)"
)
"""Pattern of excluded files: compiled code, tests, fonts for PDF files, and most lexers."""
_TIME_STAMP = (1980, 1, 1, 0, 0, 0)
"""Time stamp of every entry, fixed so that equal files give equal archives."""


def packed(python: str) -> bytes:
    """Create the ZIP archive and return the content; the same files always give the same bytes.

    `python` is the Python version of the page, such as "3.13". If this process has the same
    version, the archive also contains compiled modules.
    """
    compiles = python == f"{sys.version_info[0]}.{sys.version_info[1]}"
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, path in sorted(_files()):
            _put(archive, name, path.read_bytes())
            if compiles and path.suffix == ".py" and (code := _compiled(path, name)):
                place = PurePosixPath(name)
                tag = f"{place.stem}.{sys.implementation.cache_tag}.pyc"
                _put(archive, str(place.parent / "__pycache__" / tag), code)
    return content.getvalue()


def _put(archive: zipfile.ZipFile, name: str, content: bytes) -> None:
    entry = zipfile.ZipInfo(name, _TIME_STAMP)
    entry.compress_type = zipfile.ZIP_DEFLATED
    archive.writestr(entry, content)


def _compiled(path: Path, name: str) -> bytes | None:
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        target = str(Path(folder) / "compiled.pyc")
        try:
            py_compile.compile(
                str(path), target, name, doraise=True,
                invalidation_mode=py_compile.PycInvalidationMode.UNCHECKED_HASH,
            )  # fmt: skip
        except (py_compile.PyCompileError, ValueError):
            return None  # a template, which is not valid Python
        return Path(target).read_bytes()


def _files() -> Iterator[tuple[str, Path]]:
    """Yield the name in the archive and the path of every file."""
    package = Path(__file__).parents[1]
    roots = {f"calm/_shipped/{name}": shipped_folder(name) for name in ("catalog", "lines")}
    for root, folder in {"calm": package, **roots}.items():
        for path in folder.rglob("*"):
            name = f"{root}/{path.relative_to(folder).as_posix()}"
            is_shipped = root == "calm" and name.startswith("calm/_shipped/")
            if path.is_file() and not is_shipped and not _EXCLUDED.search(name):
                yield name, path
    for distribution in distributions():
        for file in distribution.files or ():
            name = file.as_posix()
            is_about = ".dist-info/" in name and file.name not in ("METADATA", "entry_points.txt")
            path = Path(str(distribution.locate_file(file)))
            if not is_about and not _EXCLUDED.search(name) and path.is_file():
                yield name, path


def distributions() -> list[importlib.metadata.Distribution]:
    """Return the installed distributions of `LIBRARIES` and of their dependencies."""
    wanted, found = list(LIBRARIES), {}
    while wanted:
        name = normal_name(wanted.pop())
        if name in found or name in (*IN_RUNTIME, *_DEPENDENCIES):
            continue
        try:
            found[name] = importlib.metadata.distribution(name)
        except importlib.metadata.PackageNotFoundError:
            continue  # not for this system, or not for this version of Python
        for line in found[name].requires or ():
            requirement, _, condition = line.partition(";")
            if "extra" not in condition:
                wanted.append(re.split(r"[^\w.-]", requirement.strip())[0])
    return [found[name] for name in sorted(found)]


def normal_name(name: str) -> str:
    """Return the normalised name of a distribution (PEP 503)."""
    return re.sub(r"[-_.]+", "-", name).lower()
