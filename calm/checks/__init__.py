"""Rules of the design check for catalogues and solved lines.

Each rule is a small function with its source.
"""
