"""Pictures: side view and plan of a line, its parts, and graphs.

Every picture is a model in metres; a separate printer exists for each medium.
"""
