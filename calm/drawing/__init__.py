"""Pictures: of a line from the side and above, of its parts, and graphs.

What is drawn is a model in metres; a printer for each medium puts it out.
"""
