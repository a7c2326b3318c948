"""Anchor drop: fall of the anchor to the seabed with the line behind it, neglecting inertia."""

from calm.drop.plan import DropPlan as DropPlan
from calm.drop.plan import drop_plan as drop_plan
