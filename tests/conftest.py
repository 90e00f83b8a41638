"""What holds for all tests: which kernels fast ones may compile, and how others are tried without the compiler."""

import functools
import multiprocessing
import os
import random
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress
from importlib import import_module
from unittest import mock

import pytest
from short_pages import pages, short_pages

from rockbatch.common.garbage import collect_rarely
from rockbatch.core import kernel
from rockbatch.motions.motion import Motion
from rockbatch.pier import Base, Damper, ElasticBase, Pier, RigidBase, YieldingBase
from rockbatch.pier.restraints import Restraint
from rockbatch.simulation import kept

__all__ = ["pages", "short_pages"]

collect_rarely()
with suppress(OSError):  # of no home
    os.environ["ROCKBATCH_CACHE"] = str(kept.folder())  # commands that tests run elsewhere, as other users, find it too

entry_to = kernel._entry_to.__wrapped__


@functools.cache
def kept_entry_to(block):
    """Return the entry by which Python calls a building block, kept on disk where its name is that of one function."""
    call, function = entry_to(block), block.py_func
    if "<" not in function.__qualname__:
        call._cache = kernel._Kept(function)
    return call


kernel._entry_to = kept_entry_to

PHYSICS = ("core", "simulation", "verification")
COMPILES = os.environ.get("NUMBA_DISABLE_JIT") != "1"
DEVICE = (Damper("viscous", nu=0.1),)
SHARED = [
    ElasticBase(50.0, restraints=DEVICE),
    RigidBase(restraints=DEVICE),
    RigidBase(),
    ElasticBase(50.0),
    ElasticBase(50.0, zeta=0.05),
]
"""Bases whose kernels fast tests compile (docs/pages/extending.md)."""


LIBRARIES = [
    "numba.np.arraymath",
    "scipy.signal",
    "scipy.optimize",
    "pint",
    "distributed",
    "pandas",
    "matplotlib.pyplot",
]
"""What takes longest to load: ten seconds in a new environment, whose modules are compiled to bytecode then."""


def pytest_sessionstart(session):
    """Load libraries in every other worker from the last one on: two in step would both compile the bytecode of each."""
    worker = getattr(session.config, "workerinput", None)
    for library in LIBRARIES[:: -1 if int(worker["workerid"][2:]) % 2 else 1] if worker else ():
        with suppress(ImportError):
            import_module(library)


SLOW = ({"finite"}, {"shaft"}, {"backbone"})
"""What is compiled by itself in the bases whose kernels slow tests compile beside these; those of all others are thorough."""
OF_SLOW = [
    RigidBase(shaft="elastic", flexural_modes=1),
    ElasticBase(50.0, kinematics="finite"),
    YieldingBase(50.0, eta=2.0, spring="backbone", backbone=((1.0, 1.0), (2.0, 1.0))),
]
"""Bases whose kernels slow tests compile."""


def compiled_traits(base, tied):
    """Return what distinguishes the kernel of a base, to which devices may be ``tied``, from that of springs or a rigid base."""
    traits = {"devices": tied or bool(base.restraints), "shaft": base.bends}
    if base.on_springs:
        n = base.has_exponent and base.n != 5.0
        traits |= {"finite": base.kinematics == "finite", "n": n, "damped": base.zeta is not None}
        traits |= {"backbone": bool(getattr(base, "backbone", ()))}
    return {name for name, present in traits.items() if present}


def marks_of(parameters):
    """Return the marks of a test that compiles the kernel of a base with devices, if any, or of the case with that name."""
    tied = any(
        isinstance(each, Restraint) for one in parameters for each in (one if isinstance(one, tuple) else (one,))
    )
    finite = any(isinstance(each, str) and "finite" in each for each in parameters)
    marks = {"thorough" if tied else "slow"} if finite else set()
    for base in parameters:
        traits = compiled_traits(base, tied) if isinstance(base, Base) else set()
        if traits and traits not in ({"devices"}, {"damped"}):
            marks.add("slow" if traits in SLOW else "thorough")
    return marks


def thin_out(items):
    """Mark the cases of sweeps: ``sweep(fast=3, slow=9)`` keeps three fast and nine slow, drawn at random; others are thorough.

    Without ``slow``, all that are not fast are slow; without ``fast``, none is.
    """
    cases = {}
    for item in items:
        if item.get_closest_marker("sweep") and not item.get_closest_marker("thorough"):
            cases.setdefault((item.path, item.cls, item.originalname), []).append(item)
    for (_, _, name), rest in cases.items():
        kept = rest[0].get_closest_marker("sweep").kwargs
        for limit, mark in (("fast", "slow"), ("slow", "thorough")):
            if limit in kept or limit == "fast":
                free = [item for item in rest if limit == "slow" or not item.get_closest_marker("slow")]
                drawn = set(random.Random(name).sample(free, min(kept.get(limit, 0), len(free))))
                rest = [item for item in rest if item not in drawn]
                for item in rest:
                    item.add_marker(mark)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Mark sweeps, and tests of the physics that have a base with a kernel of its own among their parameters.

    What is thorough is slow.
    """
    for item in items:
        if item.path.parent.name in PHYSICS and hasattr(item, "callspec") and "uncompiled" not in item.fixturenames:
            for mark in marks_of(item.callspec.params.values()):
                item.add_marker(mark)
    thin_out(items)
    for item in items:
        if item.get_closest_marker("thorough"):
            item.add_marker("slow")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_finish(session):
    """Compile the shared kernels before the first test of the physics, each in one of the workers."""
    worker = getattr(session.config, "workerinput", None)
    physics = [item for item in session.items if item.path.parent.name in PHYSICS]
    if worker and physics and COMPILES:
        from rockbatch import simulate

        still, share = Motion.still(0.1), slice(int(worker["workerid"][2:]), None, worker["workercount"])
        for base in SHARED[share]:
            simulate(Pier(0.2, 1.0), base, still, substeps=1, forces=True, ledger=True)
        if any(item.get_closest_marker("slow") and not item.get_closest_marker("thorough") for item in physics):
            for base in OF_SLOW[share]:
                simulate(Pier(0.2, 1.0, flexural_period_s=0.3), base, still, substeps=1)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item):
    """Fail a fast test of the physics that needs another kernel than the shared ones."""
    if not COMPILES or item.path.parent.name not in PHYSICS or item.get_closest_marker("slow"):
        return (yield)
    from rockbatch.core import run

    march = run._march

    def shared_march(traits, *rest):
        own = [name for name, value in traits._asdict().items() if value is not None]
        shared = own in ([], ["pull"], ["damped"]) and type(traits).__name__ != "FlexibleTraits"
        if not shared:
            pytest.fail(f"mark as slow, or run it uncompiled: {traits} has a kernel of its own")
        return march(traits, *rest)

    with mock.patch.object(run, "_march", shared_march):
        return (yield)


@pytest.fixture(scope="session")
def uncompiled():
    """Call functions in a process in which Numba compiles nothing: a sub-step of a run takes a millisecond there."""
    if not COMPILES:
        yield lambda function, *given, **named: function(*given, **named)
        return
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        with pytest.MonkeyPatch.context() as patch:  # here Numba would notice it, too
            patch.setenv("NUMBA_DISABLE_JIT", "1")
            pool.submit(int).result()
        yield lambda function, *given, **named: pool.submit(function, *given, **named).result()
