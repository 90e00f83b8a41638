"""Figures as data (``description``), and how matplotlib draws them (``paper``); the report has its own renderer."""
