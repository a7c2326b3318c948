"""Rules of the design check, for a catalogue and for a solved line: small functions, each with its
source.
"""
