"""Line builder in the terminal: screens and widgets.

The module `live` solves and checks the line while the user edits.
"""
