"""Pictures of a solved line for a terminal, drawn with braille dots in any number of cells.

Each is a text for each row of cells. From 20 by 6 cells on they show a scale; more room shows more.
"""

from calm.drawing.sketch.elevation import elevation as elevation
from calm.drawing.sketch.tension import current_profile as current_profile
from calm.drawing.sketch.tension import plan as plan
from calm.drawing.sketch.tension import tension as tension
