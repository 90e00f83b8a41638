"""TOML files whose mistakes are told with their lines, all at once.

``tomllib`` gives values without lines; :mod:`lines` finds them. :mod:`kinds` says what a value may be, and
:mod:`reader` checks tables against the keys they may have and raises every mistake together.
"""
