"""Physics of a line in the sea: drag, current, balance of each element, and integration down the
line.

Inputs are numbers and arrays only. The integration down the line is called a march.
"""
