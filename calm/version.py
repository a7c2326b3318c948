"""The version of CALM."""

__version__ = "0.1.0"
