"""The version of CALM, and the commit that it was built from."""

from pathlib import Path

__version__ = "0.1.0"


def built_from() -> str:
    """The commit of this CALM, e.g. ``4c1fd21``, with ``-dirty`` where a checkout has changes.

    A wheel carries the commit in a file; a checkout asks git. Empty where neither knows.
    """
    package = Path(__file__).parent
    written = package / "_shipped" / "commit"
    if written.is_file():
        return written.read_text(encoding="ascii").strip()
    return commit_of(package.parent)


def commit_of(checkout: Path) -> str:
    """The commit of a checkout of git's, empty where there is none or no git."""
    import subprocess

    if not (checkout / ".git").exists():
        return ""
    describe = ["git", "-C", str(checkout), "describe", "--always", "--exclude=*", "--dirty"]
    try:
        asked = subprocess.run(describe, capture_output=True, text=True, check=False, timeout=10)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return asked.stdout.strip()
