"""Which functions make the figures that a page or a plot shows."""

import sys

import pytest

from rockbatch.common.figures.description import Figure


def makers(call):
    """Return the names of the functions that describe a figure while ``call`` is called."""
    made, describe = set(), Figure.__init__

    def noted(self, *args, **more):
        frame = sys._getframe(1)
        made.add(f"{frame.f_globals['__name__']}.{frame.f_code.co_name}")
        describe(self, *args, **more)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Figure, "__init__", noted)
        call()
    return made
