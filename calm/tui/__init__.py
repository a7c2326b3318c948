"""Line builder in the terminal: its screens and widgets.

The module `live` solves and judges the line while it is edited.
"""
