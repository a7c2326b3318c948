"""What a wheel or a source distribution says of itself: its commit, and its page on an index."""

import re
import runpy
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.metadata.plugin.interface import MetadataHookInterface


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


class IndexPageHook(MetadataHookInterface):
    """Makes the README the project's page on a package index."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Lead pictures and links to the tag of this version at ``urls.Source``."""
        readme = (Path(self.root) / "README.md").read_text(encoding="utf-8")
        text = index_page(readme, metadata.get("urls", {}).get("Source"), metadata["version"])
        metadata["readme"] = {"content-type": "text/markdown", "text": text}


def index_page(readme: str, source: str | None, version: str) -> str:
    """The README where none of the repository's files stand beside it.

    Parameters
    ----------
    source : address of the repository at a forge; without one, pictures are left out and links
        become plain text, since an index shows neither
    """
    if source:
        files, pages = (f"{source.rstrip('/')}/{view}/v{version}/" for view in ("raw", "blob"))
        readme = re.sub(r'(!\[[^\]]*\]\(|<img src=")(?!https?:)', rf"\g<1>{files}", readme)
        return re.sub(r"((?<!!)\[[^\]]*\]\()(?!https?:)", rf"\g<1>{pages}", readme)
    readme = re.sub(r"^(!\[[^\]]*\]\([^)]*\)|<img [^>]*>)\n\n", "", readme, flags=re.MULTILINE)
    return re.sub(r"(?<!!)\[([^\]]*)\]\((?!https?:)[^)]*\)", r"\g<1>", readme)
