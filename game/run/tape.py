"""Playback of a recording, step by step, with seeks to any frame by means of key frames.

A key frame is a deep copy of the scene and its input. The copies share pictures, because game rules never draw on them.
Key frames are KEY_SECONDS apart. In a long recording, the distance is increased so that there are at most MOST_KEYS of
them (see `spacing`).
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
    # pygame 2.6.1 cannot copy pictures. If an object is reduced to a string, `copy` returns the object itself.
    copyreg.pickle(pygame.Surface, lambda picture: "picture")

KEY_SECONDS = 5
MOST_KEYS = 48


class Tape:
    """Playback of a recording (a Replay). make() builds the scene in its initial state."""

    def __init__(self, make: Callable[[], Scene], recording: Replay) -> None:
        self.recording = recording
        self.length = recording.frames
        seconds = max(KEY_SECONDS, -(-self.length // (60 * MOST_KEYS)))
        self.spacing = 60 * seconds  # [frames] between two key frames
        self.session = Session(make(), recording, replay=recording)
        self.diverged = ""  # message with the frame at which scene and recording first differed
        self.diverged_at = None
        self.goal = None  # frame to which a seek is under way
        self.keys = {}
        recording.index = 0
        self._note_key()

    @property
    def scene(self) -> Scene:
        """The scene in its current state."""
        return self.session.scene

    @property
    def position(self) -> int:
        """Number of frames played so far."""
        return self.recording.index

    @property
    def ended(self) -> bool:
        """Whether the last frame of the recording has been played."""
        return self.position >= self.length

    def step(self) -> None:
        """Play one frame, if the recording has not ended.

        A difference from the recording is noted, and playback continues.
        """
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
        """Move to the frame `frame`. The call returns after the steps up to this frame have been played."""
        self.begin_seek(frame)
        while self.goal is not None:
            self.seek_on(60.0)

    def begin_seek(self, frame: int) -> None:
        """Start to move to the frame `frame`: restore the nearest key frame before it.

        seek_on() plays the remaining steps. An unfinished earlier seek is cancelled.
        """
        frame = max(0, min(self.length, frame))
        nearest = max(key for key in self.keys if key <= frame)
        if frame < self.position or nearest > self.position:
            self.session.scene, self.session.inputs = copy.deepcopy(self.keys[nearest])
            self.recording.index = nearest
        self.goal = frame if frame != self.position else None

    def seek_on(self, seconds: float) -> None:
        """Continue a seek: play steps towards its frame, for about `seconds` of real time at most."""
        started = perf_counter()
        while self.goal is not None and self.position < self.goal:
            self.step()
            if perf_counter() - started > seconds:
                break
        if self.goal is not None and self.position >= self.goal:
            self.goal = None
