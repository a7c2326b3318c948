"""The line: its table, its verbs, and the first screen."""
