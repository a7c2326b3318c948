"""Rules of the design check for catalogues and solved lines; each rule is a small function with its
source.
"""
