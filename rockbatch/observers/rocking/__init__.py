"""Rocking about a base that has yielded, apart from its lean."""
