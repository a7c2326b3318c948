"""Results as JSON."""

from __future__ import annotations

import json
import math
from typing import Any

from calm.errors import NoEquilibrium


def failure_document(name: str, failure: NoEquilibrium) -> dict[str, Any]:
    """The object that takes a result's place where a mooring has no equilibrium.

    Parameters
    ----------
    name : str
        Name of the mooring.
    failure : NoEquilibrium
        Why it has none.

    Returns
    -------
    dict
        `name`, `status`, `message` and `advice`, all text.
    """
    return {"name": name, **failure.to_dict()}


def to_json(documents: list[dict[str, Any]]) -> str:
    """JSON text: one document as an object, several as an array in the order given.

    A number that is not finite becomes null, since JSON has none. The text is plain ASCII, so that
    no terminal or pipe can spoil it.
    """
    content = documents[0] if len(documents) == 1 else documents
    return json.dumps(_finite(content), indent=2, allow_nan=False) + "\n"


def _finite(value: Any) -> Any:
    """The same value with every number that is not finite replaced by None, at any depth."""
    if isinstance(value, dict):
        return {key: _finite(member) for key, member in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(member) for member in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
