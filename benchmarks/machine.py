"""What a figure was measured on."""

import importlib.metadata
import os
import platform
from pathlib import Path


def processor() -> str:
    """Name of the processor, as far as the system tells it."""
    information = Path("/proc/cpuinfo")
    if information.exists():
        for line in information.read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def describe(*distributions: str) -> str:
    """One line: processor, cores, system, Python and the versions of `distributions`."""
    versions = [f"{name} {importlib.metadata.version(name)}" for name in distributions]
    python = f"Python {platform.python_version()}"
    return ", ".join([processor(), f"{os.cpu_count()} cores", platform.system(), python, *versions])
