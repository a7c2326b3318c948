"""What the sea does to a line: drag, current, one element's balance, the march. Numbers and arrays only."""
