"""Line builder in the terminal: screens and widgets; the module `live` solves and judges the
line.
"""
