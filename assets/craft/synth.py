"""A small synthesiser similar to sfxr: an oscillator whose pitch glides, an envelope, a filter, and a finish.

The oscillator runs at 4 times the sample rate. Sines come from a rounded table and powers from `math`, so the samples
do not depend on NumPy's vector instructions: the same script writes the same bytes on every machine.
"""

import io
import math
import wave

import numpy as np

RATE = 44_100  # [Hz]
OVERSAMPLING = 4
PEAK = 10 ** (-3 / 20)  # -3 dB of full scale: headroom for several voices at once
FADE = 0.002  # [s] at both ends, against clicks
KNOTS = 256  # linear segments of a glide
SINE_STEPS = 4096  # of the table, which repeats its first entry at the end
SINE = np.array([round(math.sin(2 * math.pi * i / SINE_STEPS), 9) for i in range(SINE_STEPS + 1)])


def sine(phase):
    """Return the sine of a phase in turns, from the table with linear interpolation."""
    place = (phase % 1.0) * SINE_STEPS
    left = np.minimum(place.astype(np.int64), SINE_STEPS - 1)
    return SINE[left] + (SINE[left + 1] - SINE[left]) * (place - left)


def triangle(phase):
    """Return a triangle wave in 15 steps, like that of an 8-bit console's sound chip. phase: in turns."""
    return np.round((1 - 4 * np.abs(phase % 1.0 - 0.5)) * 7.5) / 7.5


def sweep(start, end, count):
    """Return `count` pitches that glide exponentially from `start` to `end`, an array. Both must be greater than 0."""
    ratio = end / start
    knots = [start * math.pow(ratio, i / KNOTS) for i in range(KNOTS + 1)]
    return np.interp(np.linspace(0, KNOTS, count), np.arange(KNOTS + 1), np.round(knots, 6))


def envelope(attack, sustain, decay, punch=0.0, curve=2.0):
    """Return an envelope at RATE: it rises for `attack`, holds for `sustain` and decays for `decay` seconds.

    punch: amount above 1 at which the hold starts; it falls back to 1. curve: power of the decay, 1 for a straight
    line.
    """
    rise, hold, fall = (max(1, int(seconds * RATE)) for seconds in (attack, sustain, decay))
    tail = np.linspace(1, 0, fall)
    tail = tail * tail if curve == 2 else np.round([math.pow(value, curve) for value in tail], 9)
    return np.concatenate([np.linspace(0, 1, rise), 1 + punch * np.linspace(1, 0, hold), tail])


def voice(kind, start, end, shape, duty=(0.5, 0.5), vibrato=(0.0, 0.0), steps=(), seed=0):
    """Return the samples of one note at RATE.

    kind: pulse, saw, triangle, sine or noise; start, end: pitch in Hz; shape: an envelope; duty: duty cycle of a pulse
    at the start and at the end; vibrato: (depth as a share of the pitch, Hz); steps: ((seconds, factor), ...), times at
    which the pitch jumps by a factor; seed: seed of the noise.
    """
    count = len(shape) * OVERSAMPLING
    time = np.arange(count) / (RATE * OVERSAMPLING)
    pitch = sweep(start, end, count)
    if vibrato[0]:
        pitch = pitch * (1 + vibrato[0] * sine(time * vibrato[1]))
    for at, factor in steps:
        pitch = np.where(time >= at, pitch * factor, pitch)
    phase = np.cumsum(pitch) / (RATE * OVERSAMPLING)
    wave_form = _oscillate(kind, phase, np.linspace(duty[0], duty[1], count), seed)
    parts = [wave_form[i::OVERSAMPLING] for i in range(OVERSAMPLING)]
    return (parts[0] + parts[1] + parts[2] + parts[3]) / OVERSAMPLING * shape


def _oscillate(kind, phase, duty, seed):
    if kind == "pulse":
        return np.where(phase % 1.0 < duty, 1.0, -1.0)
    if kind == "saw":
        return 2 * (phase % 1.0) - 1
    if kind == "triangle":
        return triangle(phase)
    if kind == "sine":
        return sine(phase)
    if kind == "noise":  # 32 random levels a period, held: the rate of new levels is the pitch of the noise
        level = np.floor(phase * 32).astype(np.int64)
        return np.random.default_rng(seed).random(int(level[-1]) + 2)[level] * 2 - 1
    raise ValueError(f"no oscillator {kind!r}; choose one of pulse, saw, triangle, sine, noise")


def low_pass(samples, start, end):
    """Return the samples after a one-pole low-pass filter, whose corner frequency glides from `start` to `end` [Hz]."""
    corners = sweep(start, end, KNOTS + 1)
    shares = [1 - math.exp(-2 * math.pi * hertz / RATE) for hertz in corners]
    share = np.interp(np.linspace(0, KNOTS, len(samples)), np.arange(KNOTS + 1), np.round(shares, 9))
    out, level = np.empty_like(samples), 0.0
    for i, (value, part) in enumerate(zip(samples.tolist(), share.tolist(), strict=True)):
        level += part * (value - level)
        out[i] = level
    return out


def remove_dc(samples, corner=30.0):
    """Return the samples without their constant part, by a one-pole high-pass filter. corner: corner frequency [Hz]."""
    share = round(1 - math.exp(-2 * math.pi * corner / RATE), 9)
    out, level = np.empty_like(samples), 0.0
    for i, value in enumerate(samples.tolist()):
        level += share * (value - level)
        out[i] = value - level
    return out


def mixed(*layers):
    """Return the sum of several layers, each given as (start [s], gain, samples)."""
    length = max(int(at * RATE) + len(samples) for at, _, samples in layers)
    total = np.zeros(length)
    for at, gain, samples in layers:
        first = int(at * RATE)
        total[first : first + len(samples)] += gain * samples
    return total


def soft_clip(samples, drive):
    """Return samples multiplied by `drive` and then limited by x / (1 + |x|)."""
    pushed = samples * drive
    return pushed / (1 + np.abs(pushed))


def finish(samples):
    """Return finished int16 samples: without a constant part, with faded ends, and with a peak of -3 dB."""
    samples = remove_dc(samples)
    fade = np.linspace(0, 1, int(FADE * RATE))
    samples[: len(fade)] *= fade
    samples[-len(fade) :] *= fade[::-1]
    inner = np.ones(len(samples))
    inner[0] = inner[-1] = 0.0
    samples = (samples - samples.mean() * len(samples) / inner.sum()) * inner  # the fades must not restore DC
    return np.round(samples / np.abs(samples).max() * PEAK * 32767).astype(np.int16)


def to_wav(samples, rate=RATE):
    """Return the bytes of a mono WAV file of int16 samples. rate: samples per second."""
    buffer = io.BytesIO()
    with wave.open(buffer, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(rate)
        file.writeframes(samples.astype("<i2").tobytes())
    return buffer.getvalue()
