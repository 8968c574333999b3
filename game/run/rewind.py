"""Rewind: store the last ten seconds of a running scene, so that the state after any of these steps can be restored.

Key frames (stored states) are taken at intervals. The inputs of the steps between them are stored. A seek restores the
last key frame before the requested step, and repeats the steps from there.

A key frame is due once the steps since the previous one took KEY_SECONDS, or once there are MOST_STEPS of them. This
limits the time of a seek. An expensive key frame waits until the steps have taken twice its own time, or is not taken
at all. If key frames need more than MOST_BYTES, the oldest are removed. A restart by the player clears the stored
steps.

While kernels are not compiled, steps are slow. Then a key frame waits PLAIN times as long, and nothing is compressed.
Therefore a seek in the first seconds of a first start may take PLAIN times as long.
"""

import pickle
import zlib
from collections import deque
from collections.abc import Callable
from time import perf_counter

from game.input.inputs import InputFrame
from game.run.chunks import Chunk
from game.run.key_frame import KeyFrame, bytes_held
from game.run.session import Session
from physics.jit import tiers

STEPS = 600  # steps that can be rewound: ten seconds
KEY_SECONDS = 0.05  # [s] of steps between two key frames: with restoring, a seek stays below a tenth of a second
PLAIN = 4  # measured with the lander, whose key frames take 6 ms: 1.3 instead of 5.4 ms per frame
DEAREST = 0.1  # [s] greatest cost of a key frame
MOST_STEPS = 90  # between two key frames
STONE_COSTS = 5  # after this many times the cost of a key frame, a seek takes an extra one for later seeks
PACK_SECONDS = 0.001  # of each step, for compression of at least one chunk
MOST_BYTES = 2**29  # of key frames, before compression
FIXED = 2**18  # bytes of tables that cost as much as the fixed part of a key frame
MOST_RAW = 2048  # chunks that wait for compression (16 MB); if there are more, the oldest stay uncompressed


class Stretch:
    """A key frame, and the inputs of the steps from this key frame to the next one.

    start: number of the step of the key frame; before: input of the step that led to the key frame.
    """

    def __init__(self, start: int, key: KeyFrame, before: InputFrame) -> None:
        self.start, self.key, self.before = start, key, before
        self.spent = 0.0  # [s] duration of these steps
        self.bytes = 0  # size of the data that the key frame does not share with earlier ones, before compression
        self.packed = b""
        self.open: list[InputFrame] | None = []

    @property
    def inputs(self) -> list[InputFrame]:
        """The inputs of the steps after the key frame, one per step."""
        return pickle.loads(zlib.decompress(self.packed)) if self.open is None else self.open

    def close(self) -> None:
        """Compress the inputs. This is called when no more inputs will follow."""
        if self.open is not None:
            self.packed, self.open = zlib.compress(pickle.dumps(self.open, 5)), None

    def cut(self, steps: int) -> None:
        """Remove all but the inputs of the first `steps` steps. New inputs can be added after them."""
        inputs = self.inputs
        self.spent *= steps / max(1, len(inputs))
        self.open = inputs[:steps]


class Rewind:
    """The past steps of a session, to which the session can return. Call note() after every step of the session.

    position: number of the step whose result the scene shows; end: number of the last step that was made. prepared():
    called after a key frame is restored and before steps are made from it.
    """

    def __init__(self, session: Session, prepared: Callable[[], None] = lambda: None) -> None:
        self.session, self.prepared = session, prepared
        self.position = self.end = 0
        self.ended_at = 0  # the step in which the game ended, if it did
        self.recorder, self.recorded_from = session.recorder, 0  # the last recorder, and the step at which it began
        self.stretches: list[Stretch] = []
        self.stones: dict[int, KeyFrame] = {}  # step -> extra key frame, taken during a long seek
        self.steps_made = 0  # number of steps that the last seek had to make
        self.raw: deque[Chunk] = deque(maxlen=MOST_RAW)
        self.rates: deque[float] = deque(maxlen=8)  # [s] per byte of the tables, for the last key frames
        self._begin_stretch()

    @property
    def start(self) -> int:
        """Number of the earliest step that a seek can reach."""
        return max(self.stretches[0].start, self.end - STEPS)

    @property
    def live(self) -> bool:
        """Whether the scene shows the result of the last step that was made. False after a seek into the past."""
        return self.position == self.end

    @property
    def following(self) -> InputFrame | None:
        """Recorded input of the step after the current state; None if the current state is that of the last step."""
        if self.live:
            return None
        stretch = next(each for each in reversed(self.stretches) if each.start <= self.position)
        return stretch.inputs[self.position - stretch.start]

    @property
    def bytes(self) -> int:
        """Memory of the stored steps [bytes]."""
        inputs = sum(len(each.packed) + 300 * len(each.open or ()) for each in self.stretches)
        return inputs + bytes_held([each.key for each in self.stretches])

    @property
    def since_result(self) -> int:
        """Number of steps since the end of the game; 0 if the game has not ended in the current state."""
        return 0 if self.session.scene.result is None else self.position - self.ended_at + 1

    def note(self) -> None:
        """Record a step of the session.

        Raises ValueError after a seek into the past. In this case, call drop_future() before the step.
        """
        if not self.live:
            raise ValueError(f"step {self.position} of {self.end} is not the last: drop_future() before it is made")
        session, last = self.session, self.stretches[-1]
        frame = session.inputs.now
        assert last.open is not None
        last.open.append(frame)
        self.position = self.end = self.end + 1
        last.spent += session.report.last or 0.0
        if session.recorder is not None:
            self.recorder, self.recorded_from = session.recorder, self.end - session.recorder.frames
        if session.scene.result is None:
            self.ended_at = self.end + 1
        if any(name == "restart" for name, _ in frame.changes):
            self.stretches.clear()
            self._begin_stretch()
        elif self._is_due(last):
            self._begin_stretch()
        elif not tiers.wanted:
            started = perf_counter()
            while self.raw and perf_counter() - started < PACK_SECONDS:
                self.raw.pop().pack()

    def _is_due(self, last):
        """Return whether to take a key frame now.

        It is taken if the steps since the last one took KEY_SECONDS, or if there are MOST_STEPS of them. While kernels
        are not compiled, these steps must take PLAIN times as long. Also, the key frame must be cheap. Its expected
        time must be at most DEAREST [s], and at most half the time of these steps. last: Stretch of the last key frame.
        """
        enough = KEY_SECONDS * (PLAIN if tiers.wanted else 1)
        if last.spent < enough and len(last.open) < MOST_STEPS:
            return False
        return self._cost() <= min(DEAREST, 0.5 * max(last.spent, enough))

    def _cost(self):
        """Return the expected time of taking a key frame [s].

        The time is computed from the least time per byte of the recent key frames.
        """
        return min(self.rates) * _weight(self.session.scene)

    def _begin_stretch(self):
        before = None
        if self.stretches:
            self.stretches[-1].close()
            before = self.stretches[-1].key
        started = perf_counter()
        key = KeyFrame(self.session.scene, before)
        self.rates.append((perf_counter() - started) / _weight(self.session.scene))
        self.stretches.append(Stretch(self.end, key, self.session.inputs.now))
        self.stretches[-1].bytes = sum(len(chunk.data) for chunk in key.chunks.new)
        self.raw += key.chunks.new
        key.chunks.new.clear()
        total = sum(each.bytes for each in self.stretches)
        while len(self.stretches) > 1 and (self.stretches[1].start <= self.end - STEPS or total > MOST_BYTES):
            total -= self.stretches[0].bytes
            del self.stretches[0]

    def seek(self, step: int) -> None:
        """Restore the scene's state after the step number `step`, which is limited to `start` .. `end`."""
        step = max(self.start, min(self.end, step))
        self.steps_made = 0
        if step == self.position:
            return
        session = self.session
        stretch = next(each for each in reversed(self.stretches) if each.start <= step or each is self.stretches[0])
        inputs = stretch.inputs
        if step < self.position or self.position < stretch.start:
            self._put_back(stretch, inputs, step)
        started, cost = perf_counter(), self._cost()
        while self.position < step:
            session.inputs.set(inputs[self.position - stretch.start])
            session.scene.step(session.inputs)
            self.position += 1
            self.steps_made += 1
            if perf_counter() - started > STONE_COSTS * cost and self.position < step:
                self.stones[self.position] = KeyFrame(session.scene, stretch.key)
                started = perf_counter()
        session.scene.cues.clear()

    def _put_back(self, stretch, inputs, step):
        """Restore the last stored state in `stretch` at or before the step `step`. inputs: inputs of the stretch.

        The stored state is the key frame of the stretch, or an extra key frame (`stones`) from an earlier seek.
        """
        last = stretch.start + len(inputs)
        self.stones = {at: stone for at, stone in self.stones.items() if stretch.start < at <= last}
        at = max((at for at in self.stones if at <= step), default=stretch.start)
        key = self.stones[at] if at in self.stones else stretch.key
        key.restore()
        self.position = at
        done = at - stretch.start
        self.session.inputs.now = inputs[done - 1] if done else stretch.before
        self.prepared()

    def drop_future(self) -> None:
        """Remove the steps after the current state, also from the recorder.

        The game then continues from the current state.
        """
        self.stones.clear()
        if self.live:
            return
        recorded, recorder = self.position - self.recorded_from, self.session.recorder or self.recorder
        if recorder is self.recorder and recorder is not None and 0 <= recorded <= recorder.frames:
            recorder.cut(recorded)
            self.session.recorder = recorder
        while self.stretches[-1].start > self.position:
            del self.stretches[-1]
        self.stretches[-1].cut(self.position - self.stretches[-1].start)
        self.end = self.position


def _weight(scene):
    """Return the size of the scene's largest tables, plus FIXED [bytes].

    The time of taking a key frame is proportional to this size.
    """
    tables = ((world.bodies, world.shapes, world.contact_rows) for world in scene.worlds)
    return FIXED + sum(table.nbytes for each in tables for table in each)
