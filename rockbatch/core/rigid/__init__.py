"""The pier on a rigid base (Housner 1963): rocking about two corners, impacts, rest, lift-off again (THEORY.md, Rigid base)."""
