"""Command line: parse arguments, call the program, and show results."""

from calm.cli.main import main

__all__ = ["main"]
