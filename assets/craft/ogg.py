"""Ogg Vorbis files of int16 samples, (frames, channels): writing, reading, and comparison with the samples.

The encoder is part of soundfile, which the extra "assets" installs; the game reads such files without it. Vorbis is
lossy, and no two encodings have the same bytes. A file is up to date if it decodes to the same number of frames and
its difference from the samples is at most LOSS.
"""

import io
import struct
from dataclasses import dataclass

import numpy as np

try:
    import soundfile
except ImportError:  # `encode` and `decode` raise for it; `frame_count` needs nothing
    soundfile = None

QUALITY = 0.4  # of Vorbis, 0..1: some 60 kbit/s for a tune; 0.6 would take 83, at three fifths of the loss
LOSS = 0.12  # greatest loss: root mean square of the difference, as a share of that of the samples
BLOCK = 8192  # frames written at a time: the encoder's stack is too small for a whole tune


def is_available():
    """Return whether soundfile is installed, so that files can be written and decoded."""
    return soundfile is not None


def _needed():
    if soundfile is None:
        raise RuntimeError("Ogg files are made and decoded by soundfile; install it with: pip install soundfile")
    return soundfile


def encode(samples, rate):
    """Return the bytes of an Ogg file with the given samples, an array (frames, channels) int16.

    rate: samples per second. Raises RuntimeError if soundfile is not installed.
    """
    buffer = io.BytesIO()
    with _needed().SoundFile(
        buffer, "w", rate, samples.shape[1], format="OGG", subtype="VORBIS", compression_level=1 - QUALITY
    ) as file:
        for start in range(0, len(samples), BLOCK):
            file.write(samples[start : start + BLOCK])
    return buffer.getvalue()


def decode(ogg):
    """Return (samples, rate) of an Ogg file given as bytes; the samples are (frames, channels) int16.

    Raises ValueError for a damaged file, RuntimeError if soundfile is not installed.
    """
    try:
        return _needed().read(io.BytesIO(ogg), dtype="int16", always_2d=True)
    except _needed().LibsndfileError as error:
        raise ValueError(f"not a whole Ogg file: {error}") from error


def frame_count(ogg):
    """Return the number of frames of an Ogg file given as bytes, read from its last page.

    Raises ValueError if the bytes are not whole Ogg pages.
    """
    at, frames = 0, 0
    while at < len(ogg):
        if ogg[at : at + 4] != b"OggS" or at + 27 > len(ogg):
            raise ValueError(f"not a whole Ogg file: no page at byte {at}")
        (frames,) = struct.unpack_from("<q", ogg, at + 6)
        segments = ogg[at + 26]
        at += 27 + segments + sum(ogg[at + 27 : at + 27 + segments])
    if at > len(ogg) or not ogg:
        raise ValueError("not a whole Ogg file: the last page is cut off")
    return frames


def loss(kept, samples):
    """Return the root mean square of `kept` - `samples`, divided by the root mean square of `samples`.

    Both are int16 arrays of the same shape.
    """
    power = float(np.mean(np.square(samples.astype(np.float64))))
    lost = float(np.mean(np.square(kept.astype(np.float64) - samples)))
    return (lost / power) ** 0.5


@dataclass(frozen=True)
class Recording:
    """Samples to be stored as an Ogg file: (frames, channels) int16 at `rate` [Hz]."""

    samples: np.ndarray
    rate: int

    def encoded(self):
        """Return the bytes of the Ogg file. Raises RuntimeError if soundfile is not installed."""
        return encode(self.samples, self.rate)

    def is_kept_in(self, ogg):
        """Return whether an Ogg file, given as bytes, contains these samples.

        The file is decoded if soundfile is installed; otherwise only its length is compared.
        """
        try:
            if frame_count(ogg) != len(self.samples):
                return False
            if not is_available():
                return True
            kept, rate = decode(ogg)
        except ValueError:
            return False
        return rate == self.rate and kept.shape == self.samples.shape and loss(kept, self.samples) <= LOSS
