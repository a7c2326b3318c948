"""Pictures of a solved line for a terminal, drawn with braille dots in any number of cells.

Each is a text for each row of cells. From 20 by 6 cells on they show a scale; more room shows more.
"""
