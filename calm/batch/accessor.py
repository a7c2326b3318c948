"""Where `open_result` was."""

from calm.batch.result import open_result as open_result
