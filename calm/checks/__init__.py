"""Judgements on a catalogue and on a solved line: small functions, each with its source."""
