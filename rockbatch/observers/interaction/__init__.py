"""Axial force and moment of sections at the same moment: interaction.csv."""

TABLE = "interaction.csv"
