"""Drawings of a line (side view, plan and schematic), and graphs.

Side views and plans are described in metres. Each output format has a module that draws the views.
"""
