"""Drawings of a line (side view, plan and schematic), and graphs.

Side views and plans are described in metres, independently of the output format. A module for each
output format draws them.
"""
