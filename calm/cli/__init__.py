"""The command line: it parses, calls and shows, and computes nothing."""

from calm.cli.main import main

__all__ = ["main"]
