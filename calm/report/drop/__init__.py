"""The plan of an anchor drop as blocks and drawings."""
