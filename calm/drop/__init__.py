"""Anchor drop: fall of the anchor and the line to the seabed. Inertia is neglected."""

from calm.drop.plan import DropPlan as DropPlan
from calm.drop.plan import drop_plan as drop_plan
