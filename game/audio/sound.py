"""Sound: effects over music. Each effect has a few voices, is panned, and varies in pitch.

Without a sound device, the program is silent. No scene reads the state of the sound player. Pitches are chosen with
separate random numbers. The buffer has 512 samples (12 ms): a larger buffer causes an audible delay, and a smaller one
causes pops.
"""

import math
import wave
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from random import Random
from time import perf_counter

import numpy as np
import pygame

from game.audio.music import Music
from game.drawing.canvas import CANVAS_SIZE
from game.places import MUSIC, SOUNDS
from game.startup import say

Cue = tuple[str, float | None, float]  # name, canvas x or None, volume

RATE = 44_100  # [Hz] of effects and mixer
CHANNELS = 24
VOICES = 3  # of one sound at once: more of them would only be louder
SPACING = 0.03  # [s] between two starts of one sound: ten hits in a step sound as one
PAN_WIDTH = 0.6  # of full left-right; full panning is tiring on headphones
PITCHES = (1.0, 0.96, 1.04)  # playing speed of the variants, +-4 %, so that repeated sounds differ
STEADY = {
    "blip",
    "confirm",
    "back",
    "powerup",
    "checkpoint",
    "secret",
    "goal",
    "life",
    "warning",
}  # melodies stay in tune
DUCK_SECONDS = 0.5
DUCKING = {"bomb", "big_explosion", "hurt", "warning", "life", "secret", "goal"}  # effects that lower the music
FIRST, LAST = 2, 0  # ranks, which decide when all channels are taken; other sounds have 1
RANKS = {
    **dict.fromkeys(DUCKING | {"confirm", "back", "blip", "checkpoint", "powerup"}, FIRST),
    **dict.fromkeys(("laser", "enemy_shot", "graze", "hit", "land", "ladder", "crate"), LAST),
}


@dataclass
class Voice:
    """One channel of the mixer, and the sound that it played last.

    All sounds are numbered in the order in which they start. started: number of the channel's last sound; rank:
    importance of this sound.
    """

    channel: "pygame.mixer.Channel"  # in quotes: a pygame without its mixer has no such name
    name: str = ""
    rank: int = LAST
    started: int = 0


class Sounds:
    """Player of effects and music, which are chosen by file name. silent_because: the reason for silence, or "".

    The volumes master, effects and music are 0..1, and may be set at any time. Call step() once per drawn frame.
    """

    def __init__(
        self,
        master: float = 0.8,
        effects: float = 1.0,
        music: float = 0.6,
        folder: Path = SOUNDS,
        silent: bool = False,
        music_folder: Path = MUSIC,
        report: Callable[[str], object] = say,
        clock: Callable[[], float] = perf_counter,
    ) -> None:
        self.master, self.effects, self.music = master, effects, music
        self.folder, self.report, self.clock = folder, report, clock
        self.random = Random(4)  # for sound only, never for a game's rules
        self.samples: dict[str, np.ndarray | None] = {}  # name -> int16 samples, None for an unusable file
        self.variants: dict[str, dict[float, pygame.mixer.Sound]] = {}  # name -> {pitch: pygame Sound}
        self.last_pitch = {}
        self.last_start = {}  # name -> when [s]
        self.starts = 0
        self.voices: list[Voice] = []
        self.player = Music(report, music_folder)
        self.silent_because = "sound is off" if silent else self._open()

    def _open(self):
        try:
            if pygame.mixer.get_init() not in (None, (RATE, -16, 2)):
                pygame.mixer.quit()
            pygame.mixer.init(RATE, -16, 2, 512, allowedchanges=0)
            pygame.mixer.set_num_channels(CHANNELS)
        except RuntimeError as error:  # pygame.error is a RuntimeError, and a pygame without its mixer raises one
            return f"no sound device ({error})"
        self.voices = [Voice(pygame.mixer.Channel(number)) for number in range(CHANNELS)]
        return ""

    def play_cues(self, cues: Iterable[Cue]) -> None:
        """Play the sounds that a step has requested. Each cue is (name, canvas x or None for the centre, volume 0..1).

        If several cues have the same name, only the loudest is played.
        """
        loudest = {}
        for name, x, volume in cues:
            if name not in loudest or volume > loudest[name][1]:
                loudest[name] = (x, volume)
        for name, (x, volume) in loudest.items():
            self.play(name, x, volume)

    def play(self, name: str, x: float | None = None, volume: float = 1.0) -> bool:
        """Start the sound `name`, and return whether it is played.

        x: canvas position, None for the centre; volume: 0..1. If VOICES voices already play this sound, the oldest of
        them is replaced.
        """
        loudness = min(1.0, volume) * self.effects * self.master
        now = self.clock()
        if self.silent_because or loudness <= 0.0 or now - self.last_start.get(name, -SPACING) < SPACING:
            return False
        try:
            voice = self._start(name, pan(x), loudness)
        except pygame.error as error:
            self._lose(error)
            return False
        if voice is None:
            return False
        self.starts += 1
        voice.name, voice.rank, voice.started = name, RANKS.get(name, 1), self.starts
        self.last_start[name] = now
        if name in DUCKING:
            self.player.duck_for(DUCK_SECONDS)
        return True

    def _start(self, name, sides, loudness):
        """Start the sound `name` on a voice and return the voice.

        Return None if the sound's file is unusable or no voice is available. sides: (left, right) volumes, which are
        multiplied by `loudness`.
        """
        sound = self._variant(name)
        voice = self._voice_for(name, RANKS.get(name, 1)) if sound else None
        if sound is None or voice is None:
            return None
        voice.channel.play(sound)
        voice.channel.set_volume(sides[0] * loudness, sides[1] * loudness)
        return voice

    def _lose(self, error):
        """Switch to silence because the sound device was removed, and report the `error` in one line."""
        self.silent_because = f"the sound device is gone ({error})"
        self.report(f"{self.silent_because}; the game goes on in silence")

    def _voice_for(self, name, rank):
        """Return the voice on which the sound `name` shall be played, or None if there is none.

        If VOICES voices already play this sound, the result is the oldest of them. Otherwise, it is an idle voice. If
        no voice is idle, it is the oldest voice of the lowest rank, unless that rank is higher than `rank`.
        """
        busy = [voice for voice in self.voices if voice.channel.get_busy()]
        same = [voice for voice in busy if voice.name == name]
        if len(same) >= VOICES:
            return min(same, key=lambda voice: voice.started)
        if len(busy) < len(self.voices):
            return next(voice for voice in self.voices if voice not in busy)
        least = min(busy, key=lambda voice: (voice.rank, voice.started))
        return least if least.rank <= rank else None

    def _variant(self, name):
        """Return the sound `name` at a random pitch, different from the last pitch of this sound.

        Melodies keep their pitch. Return None if the file is unusable.
        """
        if name not in self.samples:
            self.samples[name] = self._read(name)
        samples = self.samples[name]
        if samples is None:
            return None
        pitches = (1.0,) if name in STEADY else [each for each in PITCHES if each != self.last_pitch.get(name)]
        pitch = self.last_pitch[name] = self.random.choice(pitches)
        made = self.variants.setdefault(name, {})
        if pitch not in made:
            made[pitch] = pygame.mixer.Sound(buffer=stereo(resampled(samples, pitch)))
        return made[pitch]

    def _read(self, name):
        path = self.folder / f"{name}.wav"
        try:
            with wave.open(str(path)) as file:
                form = (file.getnchannels(), file.getsampwidth(), file.getframerate())
                samples = np.frombuffer(file.readframes(file.getnframes()), "<i2")
            if form != (1, 2, RATE) or len(samples) < 2:
                raise wave.Error(f"must be mono, 16 bit, {RATE} Hz and not empty")
        except FileNotFoundError:
            self.report(f"{path}: sound: there is no such file")
        except (OSError, EOFError, ValueError, wave.Error) as error:
            self.report(f"{path}: sound: {str(error) or 'the file ends too soon'}")
        else:
            return samples
        return None

    def tune(self, name: str | None) -> None:
        """Choose the tune to play; None means silence. A new tune is faded in.

        A repeated call with the current tune costs little.
        """
        if not self.silent_because:
            self.player.tune(name)

    def jingle(self, name: str) -> None:
        """Play the jingle `name` once, and start it immediately. The chosen tune starts after the jingle."""
        if not self.silent_because:
            self.player.jingle(name)

    def pause(self) -> None:
        """Pause the music. Effects that are playing continue to their end."""
        if not self.silent_because:
            self.player.pause()

    def resume(self) -> None:
        """Continue the music after pause(), at the position at which it was paused."""
        if not self.silent_because:
            self.player.resume()

    def step(self, seconds: float) -> None:
        """Advance the music's fades and the lowering of its volume. seconds: time since the last call [s]."""
        if self.silent_because:
            return
        try:
            self.player.step(seconds, self.music * self.master)
        except pygame.error as error:
            self._lose(error)


def pan(x: float | None) -> tuple[float, float]:
    """Return the (left, right) volumes, 0..1, of a sound at canvas position `x`. None is the centre.

    The total power of both sides is the same for every position.
    """
    side = 0.0 if x is None else max(-1.0, min(1.0, 2.0 * x / CANVAS_SIZE[0] - 1.0)) * PAN_WIDTH
    angle = (side + 1.0) * math.pi / 4.0
    return math.cos(angle), math.sin(angle)


def resampled(samples: np.ndarray, speed: float) -> np.ndarray:
    """Return sound samples resampled for playback at `speed` times the original speed, and thus at a higher pitch."""
    if speed == 1.0:
        return samples
    places = np.arange(0.0, len(samples) - 1, speed)
    return np.round(np.interp(places, np.arange(len(samples)), samples)).astype(np.int16)


def stereo(samples: np.ndarray) -> bytes:
    """Return mono samples as the bytes of a stereo buffer, equal on both sides."""
    return np.repeat(samples, 2).tobytes()
