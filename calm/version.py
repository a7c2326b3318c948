"""Version of CALM, and the git commit from which it was built."""

from pathlib import Path

__version__ = "0.1.0"


def built_from() -> str:
    """Return the commit of this installation, such as ``4c1fd21``, with ``-dirty`` for a changed
    checkout.

    The text is empty if the commit is unknown.
    """
    package = Path(__file__).parent
    written = package / "_shipped" / "commit"
    if written.is_file():
        return written.read_text(encoding="ascii").strip()
    return commit_of(package.parent)


def commit_of(checkout: Path) -> str:
    """Return the commit of a git checkout; empty if git is missing or this is not a checkout."""
    import subprocess

    if not (checkout / ".git").exists():
        return ""
    describe = ["git", "-C", str(checkout), "describe", "--always", "--exclude=*", "--dirty"]
    try:
        found = subprocess.run(describe, capture_output=True, text=True, check=False, timeout=10)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return found.stdout.strip()
