"""Sound effects: a few voices each, panned, and silence where there is no device.

pre_init with a buffer of 512 samples (12 ms): the default of larger buffers is heard as lag, smaller ones pop.
"""

import pygame

from game.draw import CANVAS_SIZE
from game.places import SOUNDS

CHANNELS = 24
VOICES = 3              # of one sound at once: more of the same is only louder
SPACING = 2             # steps between two starts of one sound: ten hits in a step are one crack
PAN_WIDTH = 0.6         # of full left-right; full panning is tiring on headphones


class Sounds:
    """play() by file name. `silent_because` says why nothing is heard, or is ""."""

    def __init__(self, volume=0.7, folder=SOUNDS, silent=False):
        self.folder = folder
        self.volume = volume
        self.loaded = {}
        self.voices = {}            # name -> channels that play it, oldest first
        self.last_step = {}
        self.now = 0
        self.silent_because = "sound is off" if silent else self._open()

    def _open(self):
        try:
            pygame.mixer.pre_init(44100, -16, 2, 512)
            pygame.mixer.init()
            pygame.mixer.set_num_channels(CHANNELS)
        except pygame.error as error:
            return f"no sound device ({error})"
        return ""

    def play_cues(self, cues):
        """Play what a scene asked for in one step: (name, canvas x or None, volume) each."""
        self.now += 1
        for name, x, volume in cues:
            self.play(name, x, volume)

    def play(self, name, x=None, volume=1.0):
        """Start a sound; the oldest voice of it gives way. Returns True if it is heard."""
        if self.silent_because or self.volume <= 0.0:
            return False
        if self.now - self.last_step.get(name, -SPACING) < SPACING:
            return False
        sound = self._load(name)
        playing = [c for c in self.voices.get(name, ()) if c.get_busy() and c.get_sound() is sound]
        channel = playing.pop(0) if len(playing) >= VOICES else pygame.mixer.find_channel(True)
        channel.play(sound)
        left, right = pan(x)
        channel.set_volume(left * volume * self.volume, right * volume * self.volume)
        self.voices[name] = [*playing, channel]
        self.last_step[name] = self.now
        return True

    def _load(self, name):
        if name not in self.loaded:
            path = self.folder / f"{name}.wav"
            if not path.exists():
                raise ValueError(f"no sound {name!r} in {self.folder}")
            self.loaded[name] = pygame.mixer.Sound(str(path))
        return self.loaded[name]


def pan(x):
    """(left, right) volumes 0..1 for a canvas x; None is the middle."""
    if x is None:
        return 1.0, 1.0
    side = max(-1.0, min(1.0, 2.0 * x / CANVAS_SIZE[0] - 1.0)) * PAN_WIDTH
    return min(1.0, 1.0 - side), min(1.0, 1.0 + side)
