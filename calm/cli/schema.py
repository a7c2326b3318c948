"""``calm schema``: the JSON Schema of mooring files."""

import json

from calm.cli.outputs import ExitCode, show


def schema() -> ExitCode:
    """Print the JSON Schema of mooring files, for editors.

    Examples
    --------
      calm schema > mooring.schema.json
    """
    from calm.files import mooring_schema

    show(json.dumps(mooring_schema(), indent=2) + "\n")
    return ExitCode.DONE
