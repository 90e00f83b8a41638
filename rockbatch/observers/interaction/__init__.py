"""Axial force and moment of sections, and normal force and shear of the base, at the same moment: interaction.csv."""

from rockbatch.common.slices import ReportPart
from rockbatch.quantities.demands import INTERACTION

TABLE = INTERACTION
REPORT = ReportPart("Capacities", "capacities", behind="checks")
"""Demands and the capacities that depend on the axial force of the same moment."""
