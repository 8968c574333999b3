"""Music: one tune at a time, streamed from its file, with fades between tunes; also short jingles.

A file is opened when its tune starts. The old tune fades out before the new one fades in, because two tunes in
different keys at once are noise. The volume is set once per drawn frame, in step(), so that a volume slider has effect
while it moves.
"""

from collections.abc import Callable
from pathlib import Path

import pygame

from game.places import MUSIC

FADE = 0.4  # [s] for each of fade-out and fade-in: a change takes 0.8 s
QUICK = 0.12  # [s] fade-out before a jingle
DUCKED = 0.5  # factor on the volume behind a loud effect: -6 dB
DUCK_DOWN, DUCK_UP = 0.05, 0.35  # [s] to lower the volume, and to raise it again


class Music:
    """Player of tunes and jingles. playing: name of the tune or jingle that plays; None in silence.

    report(line) is called once for each file that cannot be played.
    """

    def __init__(self, report: Callable[[str], object], folder: Path = MUSIC) -> None:
        self.folder, self.report = folder, report
        self.wanted = None  # the tune to play once no jingle plays
        self.jingle_due = None
        self.playing = None
        self.in_jingle = False
        self.paused = False
        self.level = 0.0  # of the fade, 0..1
        self.duck = 1.0  # DUCKED..1
        self.ducked_for = 0.0  # [s] remaining
        self.unusable = set()

    def tune(self, name: str | None) -> None:
        """Choose the tune to play; None means silence. If a jingle is playing, the tune starts after the jingle."""
        if name != self.wanted:
            self.wanted = name
            self.resume()

    def jingle(self, name: str) -> None:
        """Play the jingle `name` once, and start it immediately. The chosen tune starts again after the jingle."""
        self.resume()
        self.jingle_due = name

    def duck_for(self, seconds: float) -> None:
        """Lower the music's volume for `seconds`, so that a loud effect can be heard."""
        self.ducked_for = max(self.ducked_for, seconds)

    def pause(self) -> None:
        """Make the music silent from the next step on.

        The mixer's own pause and unpause functions are not called, because they can deadlock. They hold Python's global
        interpreter lock while they wait for the sound thread. When an effect has just ended, the sound thread waits for
        that lock.
        """
        self.paused = True

    def resume(self) -> None:
        """Continue the music after pause(). A call of tune() with another tune, or of jingle(), also ends the pause."""
        self.paused = False

    def step(self, seconds: float, volume: float) -> None:
        """Advance the fades, the lowering of the volume, and the change of tunes by `seconds`.

        volume: volume of all music, 0..1.
        """
        if not self.paused:
            self._advance(seconds)
        pygame.mixer.music.set_volume(0.0 if self.paused else volume * self.level * self.duck)

    def _advance(self, seconds):
        if self.in_jingle and not pygame.mixer.music.get_busy():
            self.playing, self.in_jingle, self.level = None, False, 0.0
        if self.jingle_due is not None:
            self._leave_for(self.jingle_due, seconds / QUICK)
        elif self.playing != self.wanted and not self.in_jingle:
            self._leave_for(self.wanted, seconds / FADE)
        else:
            self.level = min(1.0, self.level + seconds / FADE)
        down = self.ducked_for > 0.0
        self.ducked_for = max(0.0, self.ducked_for - seconds)
        way = -seconds / DUCK_DOWN if down else seconds / DUCK_UP
        self.duck = min(1.0, max(DUCKED, self.duck + way * (1.0 - DUCKED)))

    def _leave_for(self, name, share):
        """Fade the current music out by one step. When its volume has reached 0, start the tune or jingle `name`.

        share: decrease of the volume in this step, as a part of the full volume, 0..1.
        """
        self.level = max(0.0, self.level - share)
        if self.level == 0.0 or self.playing is None:
            self._start(name)

    def _start(self, name):
        pygame.mixer.music.stop()
        self.in_jingle = self.jingle_due is not None
        self.jingle_due = None
        self.playing, self.level = name, float(self.in_jingle)
        if name is None or name in self.unusable:
            return
        path = self.folder / f"{name}.ogg"
        try:
            if not path.is_file():
                raise FileNotFoundError("there is no such file")
            pygame.mixer.music.load(str(path))
            pygame.mixer.music.play(0 if self.in_jingle else -1)
        except (OSError, pygame.error) as error:
            self.unusable.add(name)
            self.report(f"{path}: music: {error}")
