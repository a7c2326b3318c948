"""Graphs for the pages of a report, as SVG: drawn many times, without a plotting library.

Lengths are in points (1/72 inch); the upper left corner of a graph is its origin.
"""

from calm.drawing.graph.axes import Axes as Axes
from calm.drawing.graph.axes import Graph as Graph
from calm.drawing.graph.axes import LegendEntry as LegendEntry
from calm.drawing.graph.axes import Stroke as Stroke
from calm.drawing.graph.axes import draw_mark as draw_mark
from calm.drawing.graph.axes import write_legend as write_legend
from calm.drawing.graph.scale import Scale as Scale
from calm.drawing.graph.scale import Tick as Tick
from calm.drawing.graph.scale import counts as counts
from calm.drawing.graph.scale import covering as covering
from calm.drawing.graph.scale import decades as decades
from calm.drawing.graph.scale import moments as moments
from calm.drawing.graph.scale import numbers as numbers
from calm.drawing.graph.scale import seconds as seconds
