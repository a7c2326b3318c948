"""Physics of a line in the sea: drag, current, balance of elements, and integration.

Inputs are numbers and arrays only. The integration down the line is called a march.
"""
