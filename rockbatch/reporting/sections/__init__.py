"""The sections of the report, each a function ``section(contents)``; their order is that of page.py."""
