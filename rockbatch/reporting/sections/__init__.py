"""Sections of the report, each a function ``section(contents)``; page.py has their order."""
