"""The summary of a batch: table, page and JSON."""
