"""What holds for all tests."""

import sys

import pytest

from rockbatch.common.garbage import collect_rarely

collect_rarely()

KNOWN = set()
"""Kernels that this process has looked at."""

PHYSICS = ("core", "simulation", "verification")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item):
    """Fail a fast test of the physics that needs a kernel of its own: each takes 20 s to compile (CONTRIBUTING.md)."""
    result = yield
    run = sys.modules.get("rockbatch.core.run")
    for kernel in getattr(getattr(run, "_march", None), "signatures", ()):
        if kernel not in KNOWN:
            KNOWN.add(kernel)
            fast = item.path.parent.name in PHYSICS and not item.get_closest_marker("slow")
            assert not fast or is_shared(kernel), (
                f"mark as slow; it compiles {kernel[0]} with devices {str(kernel[4])[:20]}"
            )
    return result


def is_shared(kernel):
    """Return whether fast tests share a kernel: that of a rigid base, or of springs with one thing beside them at most."""
    traits, devices = kernel[0], kernel[4]
    beside = (
        [*traits][:-1] if traits.instance_class.__name__ == "SpringTraits" else []
    )  # the pull is that of the devices
    return sum(str(each) != "none" for each in (*beside, devices)) <= 1
