"""The shipped catalogue in a form that loads in milliseconds.

``python -m calm.files.compile_catalogue`` writes `compiled.json` from the YAML files beside it. It
holds their digests: where they differ from the files, the files are read instead.
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

from calm.files.document import Document, read_document
from calm.shipped import shipped_folder
from calm.whole_file import put

COMPILED = "compiled.json"


def shipped_files() -> list[Path]:
    """All that the shipped catalogue is read from."""
    return sorted(shipped_folder("catalog").iterdir())


def shipped_documents() -> list[Document]:
    """The shipped catalogue, one document a family; places are known only where it was parsed."""
    folder = shipped_folder("catalog")
    files = sorted(folder.glob("*.yaml"))
    try:
        compiled = json.loads((folder / COMPILED).read_bytes())
    except (OSError, ValueError):
        compiled = {}
    if compiled.get("digests") != _digests(files):
        return [read_document(path) for path in files]
    documents = compiled["documents"]
    return [Document(str(path), documents[path.name]) for path in files]


def compile_catalogue(folder: Path) -> str:
    """The text of `compiled.json` for a folder of catalogue files."""
    files = sorted(folder.glob("*.yaml"))
    documents = {path.name: read_document(path).data for path in files}
    compiled = {"digests": _digests(files), "documents": documents}
    return json.dumps(compiled, ensure_ascii=False, indent=0) + "\n"


def main() -> None:
    """Write the compiled form of the shipped catalogue."""
    target = shipped_folder("catalog") / COMPILED
    put(target, compile_catalogue(target.parent).encode())


def _digests(files: list[Path]) -> dict[str, str]:
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


if __name__ == "__main__":
    main()
