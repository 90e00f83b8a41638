"""Finished results: write and read their tables, histories and run.json. Never loads the compiler."""
