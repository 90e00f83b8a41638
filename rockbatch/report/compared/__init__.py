"""The sections of the page of two studies, each a function ``section(pair)``; their order is that of page.py."""
