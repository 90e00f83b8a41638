"""Progress of a batch: bars that move by themselves, and functions that are called with what is finished."""

import io
import re
import subprocess
import sys
import time

import pytest

from rockbatch.batch import listening
from rockbatch.batch.listening import Bars, Calls, Listener, listener_of

REDRAWN = 3
"""Times that a bar has to be redrawn while nothing is finished."""


class Terminal(io.StringIO):
    """A stream on which a bar is drawn."""

    @property
    def drawn(self):
        """Return the states of the bar in the order in which they were drawn, as finished and all runs."""
        return re.findall(r"\b(\d+)/(\d+)\b", self.getvalue())


def terminal_for(monkeypatch):
    """Return a stream in place of stderr on which a bar moves at once."""
    stream = Terminal()
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.setattr(listening, "MOVES_S", 0.002)
    return stream


def waited_for(condition, seconds=10.0):
    """Return whether a condition comes true within so many seconds."""
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.001)
    return condition()


def test_a_bar_is_redrawn_while_nothing_is_finished(monkeypatch):
    terminal = terminal_for(monkeypatch)
    with Bars().progress(7) as advance:
        assert waited_for(lambda: terminal.drawn.count(("0", "7")) > REDRAWN)
        advance(2)
        assert waited_for(lambda: terminal.drawn[-1:] == [("2", "7")])
        redrawn = len(terminal.drawn)
        assert waited_for(lambda: len(terminal.drawn) > redrawn + REDRAWN)
        assert set(terminal.drawn[redrawn:]) == {("2", "7")}
    ended = len(terminal.drawn)
    time.sleep(0.02)
    assert len(terminal.drawn) == ended


@pytest.mark.parametrize("written", range(1, 9))
def test_a_failed_write_ends_a_batch_and_never_stops_it(written):
    """Whichever write fails, of the one who draws the bar or of the one who advances it."""
    code = f"""
import io, sys, time
from rockbatch.batch import listening

class Full(io.StringIO):
    writes = 0

    def write(self, text):
        self.writes += 1
        if self.writes > {written}:
            raise OSError(28, "No space left on device")
        return super().write(text)

listening.MOVES_S = 0.002
stream, sys.stderr = sys.stderr, Full()
try:
    with listening.Bars().progress(7) as advance:
        while sys.stderr.writes <= {written}:
            time.sleep(0.001)
        for _ in range(7):
            time.sleep(0.15)  # tqdm draws no more often
            advance(1)
except OSError as error:
    print("ended by", error.errno)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout == "ended by 28\n"


def test_a_bar_waits_for_its_delay(monkeypatch):
    terminal = terminal_for(monkeypatch)
    with Bars(delay=60.0).progress(7):
        time.sleep(0.02)
        assert not terminal.drawn


def test_a_function_is_called_with_what_is_finished_so_far_and_with_all():
    told = []
    with Calls(lambda done, total: told.append((done, total))).progress(9) as advance:
        for more in (1, 3, 0, 5):
            advance(more)
    assert told == [(1, 9), (4, 9), (4, 9), (9, 9)]


def test_the_kind_of_listener_is_that_which_was_asked_for(monkeypatch):
    own = Listener()
    assert listener_of(own) is own
    assert isinstance(listener_of(print), Calls)
    assert (type(listener_of(True)), type(listener_of(False))) == (Bars, Listener)
    for is_terminal, kind, delay in ((True, Bars, listening.SHORT), (False, Listener, None)):
        stream = Terminal()
        stream.isatty = lambda answer=is_terminal: answer
        monkeypatch.setattr(sys, "stderr", stream)
        found = listener_of(None)
        assert (type(found), getattr(found, "delay", None)) == (kind, delay)
    monkeypatch.setattr(sys, "stderr", None)
    assert type(listener_of(None)) is Listener
