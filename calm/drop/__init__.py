"""The anchor's way to the seabed, and the line's behind it: a chain of nodes without inertia."""

from calm.drop.plan import DropPlan as DropPlan
from calm.drop.plan import drop_plan as drop_plan
