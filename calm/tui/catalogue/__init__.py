"""The catalogue: its pane, its index, and components of one's own."""
