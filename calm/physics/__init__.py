"""Physics of a line in the sea: drag, current, one element, the march. Numbers and arrays only."""
