"""WHOI Cable: its problem files, read and written."""
