"""Playback of a recording: forward step by step, and to any frame by key frames.

A key frame is a deep copy of the scene and its input. No game rule paints on pictures, so copies share them. Key frames
are KEY_SECONDS apart, or further if a long recording would need more than MOST_KEYS, see `spacing`.
"""

import copy
import copyreg
from collections.abc import Callable
from time import perf_counter

import pygame

from game.errors import ReplayDiverged
from game.run.replay import Replay
from game.run.session import Session
from game.scene import Scene

if not hasattr(pygame.Surface, "__deepcopy__"):
    # pygame 2.6.1 cannot copy pictures. A reduction that is a name makes copy return the object itself.
    copyreg.pickle(pygame.Surface, lambda picture: "picture")

KEY_SECONDS = 5
MOST_KEYS = 48


class Tape:
    """Playback of a Replay, `recording`. `make()` builds the scene as at the start."""

    def __init__(self, make: Callable[[], Scene], recording: Replay) -> None:
        self.recording = recording
        self.length = recording.frames
        seconds = max(KEY_SECONDS, -(-self.length // (60 * MOST_KEYS)))
        self.spacing = 60 * seconds  # [frames] between two key frames
        self.session = Session(make(), recording, replay=recording)
        self.diverged = ""  # the line that names the frame, after a divergence
        self.diverged_at = None
        self.goal = None  # the frame of the seek under way
        self.keys = {}
        recording.index = 0
        self._note_key()

    @property
    def scene(self) -> Scene:
        """The scene in its current state."""
        return self.session.scene

    @property
    def position(self) -> int:
        """Number of frames played."""
        return self.recording.index

    @property
    def ended(self) -> bool:
        """True after the last frame."""
        return self.position >= self.length

    def step(self) -> None:
        """Play one frame; do nothing after the last. A divergence is recorded and playback continues."""
        if self.ended:
            return
        try:
            self.session.step()
        except ReplayDiverged as error:
            if self.diverged_at is None or self.position <= self.diverged_at:
                self.diverged, self.diverged_at = str(error), self.position
        if self.recording.parted and self.diverged_at is None:
            self.diverged, self.diverged_at = self.recording.parted, self.position
        self._note_key()

    def _note_key(self):
        if self.position % self.spacing == 0 and self.position not in self.keys:
            self.keys[self.position] = copy.deepcopy((self.scene, self.session.inputs))

    def seek(self, frame: int) -> None:
        """Go to a frame, however long it takes."""
        self.begin_seek(frame)
        while self.goal is not None:
            self.seek_on(60.0)

    def begin_seek(self, frame: int) -> None:
        """Go to the nearest key frame before; seek_on() makes the rest. An earlier seek is cancelled."""
        frame = max(0, min(self.length, frame))
        nearest = max(key for key in self.keys if key <= frame)
        if frame < self.position or nearest > self.position:
            self.session.scene, self.session.inputs = copy.deepcopy(self.keys[nearest])
            self.recording.index = nearest
        self.goal = frame if frame != self.position else None

    def seek_on(self, seconds: float) -> None:
        """Play towards the frame of the seek, for so long at most."""
        started = perf_counter()
        while self.goal is not None and self.position < self.goal:
            self.step()
            if perf_counter() - started > seconds:
                break
        if self.goal is not None and self.position >= self.goal:
            self.goal = None
