"""Drawings of a line (side view, plan and schematic), and graphs.

A side view or plan is first described in metres, independently of the output format. Each output
format has a module that draws the picture.
"""
