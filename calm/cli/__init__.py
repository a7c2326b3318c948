"""Command line: parse arguments, run commands, and show results."""

from calm.cli.main import main

__all__ = ["main"]
