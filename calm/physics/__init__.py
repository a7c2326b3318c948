"""Physics of a line in the sea: drag, current, balance of one element, march. Inputs are numbers
and arrays only.
"""
