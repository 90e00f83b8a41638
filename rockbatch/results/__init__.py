"""Finished results: one outcome, its histories, tables and files, opened again. Never loads the compiler."""
