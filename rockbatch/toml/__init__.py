"""TOML files whose mistakes are reported with their lines, all at once.

``tomllib`` gives values without lines; :mod:`lines` finds them. :mod:`kinds` has the kinds of values, and
:mod:`reader` checks tables against the keys they may have and raises every mistake together.
"""
