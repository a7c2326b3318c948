"""The water for which what a person gives of a component holds."""

from __future__ import annotations

REFERENCE_DENSITY = 1025.0
"""Density of the sea water [kg/m³] for which buoyancies and drags are given."""

REFERENCE_VISCOSITY = 1.36e-6
"""Kinematic viscosity of sea water of 10 °C and 35 [m²/s], where nothing else is known."""
