"""Puts the commit that a wheel or a source distribution is built from into it."""

import runpy
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class CommitHook(BuildHookInterface):
    """Writes ``calm/_shipped/commit``; a source distribution has it already."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Name the commit, unless it is unknown or this is an editable installation."""
        checkout = Path(self.root)
        commit = runpy.run_path(str(checkout / "calm" / "version.py"))["commit_of"](checkout)
        if commit and version != "editable":
            file = Path(self.directory) / "commit"
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(commit + "\n", encoding="ascii")
            build_data["force_include"][str(file)] = "calm/_shipped/commit"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Leave no file beside what is built."""
        (Path(self.directory) / "commit").unlink(missing_ok=True)
