"""What the sea does to a line: drag, current, one element, the march. Numbers and arrays only."""
