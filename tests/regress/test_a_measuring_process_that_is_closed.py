"""The thread that reads from the measuring process reports its end if the pipe is closed during a read.

Before the fix it raised an error.
"""

import os
from queue import SimpleQueue
from types import SimpleNamespace

from game.measure.surveyor import _listen


def test_what_is_closed_while_it_is_read_has_ended():
    reading, writing = os.pipe()
    stdout, found = os.fdopen(reading), SimpleQueue()
    os.write(writing, b'{"a": 1}\nno json\n')

    def lines():
        yield stdout.readline()
        yield stdout.readline()
        stdout.close()
        yield stdout.readline()

    _listen(SimpleNamespace(stdout=lines()), found)
    os.close(writing)
    assert found.get() == {"a": 1} and found.get()["ended"] and found.empty()
