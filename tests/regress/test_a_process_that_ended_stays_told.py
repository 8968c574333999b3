"""The message that the measuring process "has ended" stays if the process dies while data for it is packed.

Before the fix "I/O operation on closed file" replaced it.
"""

import threading
from time import monotonic, sleep

from game.measure.surveyor import Surveyor


class Packed:
    """Snapshot whose save() waits until the test sets the event `free`."""

    def __init__(self) -> None:
        self.begun, self.free, self.done = threading.Event(), threading.Event(), threading.Event()

    def save(self, path):
        self.begun.set()
        self.free.wait(20.0)
        self.done.set()


def turns_until(surveyor, whether):
    end = monotonic() + 20.0
    while not whether() and monotonic() < end:
        surveyor.turn()
        sleep(0.01)
    assert whether()


def test_who_packs_late_says_nothing_of_a_closed_pipe():
    surveyor, snapshot = Surveyor(), Packed()
    surveyor.measure(snapshot, "tree")
    assert snapshot.begun.wait(20.0)
    packing = [each for each in threading.enumerate() if each.name == "hand on"]
    surveyor.process.kill()
    turns_until(surveyor, lambda: surveyor.trouble)
    reported = surveyor.trouble
    assert "has ended" in reported and surveyor.process is None
    snapshot.free.set()
    for thread in packing:
        thread.join(20.0)
    assert packing and snapshot.done.is_set()
    surveyor.turn()
    assert surveyor.trouble == reported
