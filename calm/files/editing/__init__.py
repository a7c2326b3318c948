"""Edit mooring and tow files as text. No physics is computed here."""

from calm.files.editing.changes import EditError
from calm.files.editing.draft import Draft, History, clamps_of
from calm.files.editing.items import LINE, LineItem
from calm.files.editing.working_file import KeptWork, NotWritten, WorkingFile
from calm.files.editing.writing import Value, inline, read_inline

__all__ = [
    "LINE", "Draft", "EditError", "History", "KeptWork", "LineItem", "NotWritten", "Value",
    "WorkingFile", "clamps_of", "inline", "read_inline",
]  # fmt: skip
