"""Rewind: the last ten seconds of a scene that is being played, every step of them within reach.

Between key frames lie the inputs of the steps, and a seek puts the key frame before back and makes the steps again.
A key frame is taken as soon as the steps since the last took KEY_SECONDS together, or there are MOST_STEPS of them, so
a seek takes no longer than that and putting back. One that takes long itself waits until they took twice as long, or is
not taken at all; where key frames hold more than MOST_BYTES the past is shorter. Where a player restarts, it begins
anew. While kernels run plain, and steps take all the time there is, a key frame waits PLAIN times as long, and nothing
is compressed: a seek in the first seconds of a first start may take as much longer.
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

STEPS = 600  # that can be gone back: ten seconds
KEY_SECONDS = 0.05  # of steps lie between two key frames: with what putting back takes, below a tenth of a second
PLAIN = 4  # measured with the lander, whose key frames take 6 ms: 1.3 in place of 5.4 ms of each frame
DEAREST = 0.1  # [s] that a key frame may take
MOST_STEPS = 90  # between two key frames
STONE_COSTS = 5  # times what a key frame takes: after so long a seek leaves one more, for the next step back
PACK_SECONDS = 0.001  # of each step, at least one chunk, go into compressing
MOST_BYTES = 2**29  # of key frames, before they are compressed
FIXED = 2**18  # bytes: what a key frame of nothing takes is as much as this much of tables
MOST_RAW = 2048  # chunks wait for that, 16 MB; where there are more, the oldest stay as they are


class Stretch:
    """A key frame, and the inputs of the steps from there to the next one. `before`: the input of the step before."""

    def __init__(self, start: int, key: KeyFrame, before: InputFrame) -> None:
        self.start, self.key, self.before = start, key, before
        self.spent = 0.0  # [s] that these steps took
        self.bytes = 0  # that the key frame shares with none before it, before they are compressed
        self.packed = b""
        self.open: list[InputFrame] | None = []

    @property
    def inputs(self) -> list[InputFrame]:
        """The inputs, one a step."""
        return pickle.loads(zlib.decompress(self.packed)) if self.open is None else self.open

    def close(self) -> None:
        """Keep the inputs in few bytes: no more are to come."""
        if self.open is not None:
            self.packed, self.open = zlib.compress(pickle.dumps(self.open, 5)), None

    def cut(self, steps: int) -> None:
        """Forget the inputs after so many, and take new ones."""
        inputs = self.inputs
        self.spent *= steps / max(1, len(inputs))
        self.open = inputs[:steps]


class Rewind:
    """note() after every step that the session makes. `position`: steps up to where the scene stands; `end`: in all.

    prepared: called whenever a key frame was put back, before steps are made from there.
    """

    def __init__(self, session: Session, prepared: Callable[[], None] = lambda: None) -> None:
        self.session, self.prepared = session, prepared
        self.position = self.end = 0
        self.ended_at = 0  # the step that the game ended with, if it did
        self.recorder, self.recorded_from = session.recorder, 0  # the last one, and the step at which it began
        self.stretches: list[Stretch] = []
        self.stones: dict[int, KeyFrame] = {}  # by step
        self.steps_made = 0  # by the last seek
        self.raw: deque[Chunk] = deque(maxlen=MOST_RAW)
        self.rates: deque[float] = deque(maxlen=8)  # [s] per byte of the tables, of the last key frames
        self._begin_stretch()

    @property
    def start(self) -> int:
        """The earliest step that can be gone back to."""
        return max(self.stretches[0].start, self.end - STEPS)

    @property
    def live(self) -> bool:
        """True where the last step made is the last there is."""
        return self.position == self.end

    @property
    def following(self) -> InputFrame | None:
        """The input of the step that came after where the scene stands; None where it stands at the end."""
        if self.live:
            return None
        stretch = next(each for each in reversed(self.stretches) if each.start <= self.position)
        return stretch.inputs[self.position - stretch.start]

    @property
    def bytes(self) -> int:
        """What is kept of the past takes."""
        inputs = sum(len(each.packed) + 300 * len(each.open or ()) for each in self.stretches)
        return inputs + bytes_held([each.key for each in self.stretches])

    @property
    def since_result(self) -> int:
        """Steps since the game has ended, as of where the scene stands."""
        return 0 if self.session.scene.result is None else self.position - self.ended_at + 1

    def note(self) -> None:
        """The session made a step. Raises ValueError where it was made in the past: drop_future() comes before it."""
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
        """Whether a key frame is to be taken: not one that takes more than half the time of the steps it saves, nor one
        that could not be put back in a tenth of a second."""
        enough = KEY_SECONDS * (PLAIN if tiers.wanted else 1)
        if last.spent < enough and len(last.open) < MOST_STEPS:
            return False
        return self._cost() <= min(DEAREST, 0.5 * max(last.spent, enough))

    def _cost(self):
        """[s] that a key frame will take, if nothing comes in between."""
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
        """Go to a step from `start` to `end`; what lies outside is as near to it as there is."""
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
        """The key frame or the stone at a step, or the last before it."""
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
        """Play on from here: what came after is forgotten, by the recorder too."""
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
    """Bytes of the largest tables: what a key frame takes grows with them."""
    tables = ((world.bodies, world.shapes, world.contact_rows) for world in scene.worlds)
    return FIXED + sum(table.nbytes for each in tables for table in each)
