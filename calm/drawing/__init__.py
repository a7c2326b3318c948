"""Drawings of a line (side view, plan and schematic), and graphs.

Side views and plans are described in metres, and drawn by a module for each output format.
"""
