"""The instruments of the tunes, at four times the sample rate of the file: pulses, triangles and drums.

Edges are averaged over one sample, and the sum is filtered before every fourth sample is kept. Both prevent aliasing.
Only elementwise arithmetic and rounded tables are used, as in synth.py, so that the bytes are the same on every
machine.
"""

import math

import numpy as np

from assets.craft.synth import sine, triangle

RATE = 22_050  # [Hz] of the files
OVERSAMPLING = 4
FINE = RATE * OVERSAMPLING
DUTY = {"pulse12": 0.125, "pulse25": 0.25, "pulse50": 0.5}
VIBRATO_HERTZ, VIBRATO_DELAY, VIBRATO_RISE = 5.6, 0.20, 0.25  # [Hz], [s], [s]
SLIDE = 0.07  # [s] from one note to the next
ARPEGGIO = 1 / 30  # [s] each tone of a rapid arpeggio: two frames of an old television
DUTY_SWAY = 0.035  # a pulse's width varies a little, so that held notes are not static
FALL_REACH, FALL_STEPS = 8, 1024  # table of an exponential fall: its time constants, and its steps
FALL = np.array([round(math.exp(-FALL_REACH * i / FALL_STEPS), 9) for i in range(FALL_STEPS + 1)])
TAPS, CORNER = 63, 9_000  # [samples], [Hz] of the filter before decimation


def hertz(midi):
    """Return the frequency [Hz] of a MIDI pitch. midi: the pitch; 69 is 440 Hz."""
    return round(440.0 * math.pow(2.0, (midi - 69) / 12), 6)


def falling(seconds, constant):
    """Return exp(-seconds / constant) from a table, for an array of times; 0 beyond the end of the table."""
    place = np.minimum(seconds * (FALL_STEPS / FALL_REACH / constant), FALL_STEPS - 1)
    left = place.astype(np.int64)
    return (FALL[left] + (FALL[left + 1] - FALL[left]) * (place - left)) * (place < FALL_STEPS - 1)


def tone(instrument, pitches, seconds, slide_from=None, vibrato=None):
    """Return the samples of one note at the rate FINE, followed by its release.

    pitches: MIDI numbers, several for an arpeggio; seconds: length without the release; slide_from: MIDI pitch from
    which the note slides to its own pitch, or None for no slide; vibrato: depth [cents], or None for the instrument's
    depth.
    """
    count = int((seconds + instrument.release) * FINE)
    time = np.arange(count) / FINE
    phase = np.cumsum(_pitch_curve(instrument, pitches, time, slide_from, vibrato)) / FINE
    shape = np.minimum(time / instrument.attack, 1.0)
    shape = shape * (instrument.sustain + (1 - instrument.sustain) * falling(time, instrument.decay))
    shape = shape * np.clip((seconds + instrument.release - time) / instrument.release, 0.0, 1.0)
    return low_pass(_oscillate(instrument.wave, phase, time), instrument.bright) * shape


def _pitch_curve(instrument, pitches, time, slide_from, vibrato):
    if len(pitches) > 1:
        table = np.array([hertz(each) for each in pitches])
        return table[(time / ARPEGGIO).astype(np.int64) % len(table)]
    target = hertz(pitches[0])
    curve = np.full(len(time), target)
    if slide_from is not None:
        curve = curve + (hertz(slide_from) - target) * np.clip(1 - time / SLIDE, 0.0, 1.0)
    cents = instrument.vibrato if vibrato is None else vibrato
    if cents:
        depth = cents / 1200 * math.log(2) * np.clip((time - VIBRATO_DELAY) / VIBRATO_RISE, 0.0, 1.0)
        curve = curve * (1 + depth * sine(time * VIBRATO_HERTZ))
    return curve


def _oscillate(wave, phase, time):
    if wave == "triangle":
        return triangle(phase)
    if wave == "soft":
        return 1 - 4 * np.abs((phase + 0.25) % 1.0 - 0.5)
    duty = DUTY[wave] * (1 + DUTY_SWAY * 2 * sine(time * 0.9))
    step = np.diff(phase, append=phase[-1] + (phase[-1] - phase[-2]))
    away = np.abs((phase - duty / 2 + 0.5) % 1.0 - 0.5)  # of the middle of the high part, in turns
    level = np.clip((duty / 2 - away) / step + 0.5, 0.0, 1.0)  # the share of this sample that is high
    return (level - duty) * (1.4 - 0.4 * DUTY[wave] / 0.5)  # narrow pulses are raised to equal loudness


def low_pass(samples, corner, rate=FINE, around=False):
    """Return samples after a one-pole low-pass filter along the last axis, exact to a millionth.

    corner: corner frequency [Hz]; rate: samples per second; around: whether the samples are a loop, whose end precedes
    its start. The filter is computed in a few whole-array steps: (1 + az)(1 + a^2 z^2)(1 + a^4 z^4) ...
    """
    share = round(math.exp(-2 * math.pi * corner / rate), 9)
    out, shift = samples * (1 - share), 1
    while share**shift > 1e-6 and shift < out.shape[-1]:
        if around:
            out = out + share**shift * np.roll(out, shift, axis=-1)
        else:
            later = out.copy()
            later[..., shift:] += share**shift * out[..., :-shift]
            out = later
        shift *= 2
    return out


def decimated(samples):
    """Return every fourth sample of a loop, after a filter that removes frequencies too high for the lower sample
    rate.
    """
    half = TAPS // 2
    taps = []
    for i in range(-half, half + 1):
        x = 2 * CORNER / FINE * i
        window = 0.54 + 0.46 * math.cos(math.pi * i / half)
        taps.append(round((1.0 if i == 0 else math.sin(math.pi * x) / (math.pi * x)) * window, 9))
    total = sum(taps)
    padded = np.concatenate([samples[-half:], samples, samples[:half]])
    out = np.zeros(-(-len(samples) // OVERSAMPLING))
    for i, tap in enumerate(taps):
        out += tap / total * padded[i : i + len(samples) : OVERSAMPLING]
    return out


def drum(name, seed=0):
    """Return the samples of one stroke on a drum at the rate FINE. Each seed gives a slightly different stroke.

    name: k, s, h, o, t or c for kick, snare, hat, open hat, tom or crash.
    """
    return {"k": _kick, "s": _snare, "h": _hat, "o": _open_hat, "t": _tom, "c": _crash}[name](seed)


def _time(seconds):
    return np.arange(int(seconds * FINE)) / FINE


def _noise(seed, time, rate):
    """Return random levels (-1..1) at the times `time` [s].

    Each level is held for 1 / rate [s], which determines the pitch of the noise. seed: seed of the random numbers.
    """
    place = (time * rate).astype(np.int64)
    return np.random.default_rng(seed).random(int(place[-1]) + 1)[place] * 2 - 1


def _faded(samples):
    """Return the samples with the last 5 ms faded out."""
    count = int(0.005 * FINE)
    samples[-count:] *= np.linspace(1, 0, count)
    return samples


def _drop(time, start, end, constant):
    """Return a sine at the times `time` [s] whose frequency falls exponentially from `start` to `end` [Hz].

    constant: time constant of the fall [s].
    """
    return sine(np.cumsum(end + (start - end) * falling(time, constant)) / FINE)


def _kick(seed):
    time = _time(0.26)
    body = _drop(time, 190, 48, 0.028) * falling(time, 0.085) * np.minimum(time / 0.002, 1.0)
    click = low_pass(_noise(seed + 100, time, 9000), 3200) * falling(time, 0.006)
    return _faded(body + 0.35 * click)


def _snare(seed):
    time = _time(0.22)
    body = _drop(time, 280, 176, 0.02) * falling(time, 0.045)
    rattle = _noise(seed + 200, time, 12000)
    rattle = low_pass(rattle - low_pass(rattle, 700), 5200) * falling(time, 0.062)
    return _faded((0.55 * body + 0.95 * rattle) * np.minimum(time / 0.001, 1.0))


def _hiss(seed, seconds, constant):
    time = _time(seconds)
    noise = _noise(seed, time, 21000)
    noise = low_pass(noise - low_pass(noise, 5000), 7500)
    return _faded(noise * falling(time, constant) * np.minimum(time / 0.001, 1.0))


def _hat(seed):
    return 0.62 * _hiss(seed + 300, 0.07, 0.016)


def _open_hat(seed):
    return 0.55 * _hiss(seed + 400, 0.28, 0.085)


def _crash(seed):
    time = _time(1.3)
    low = _noise(seed + 500, time, 9000)
    low = low_pass(low - low_pass(low, 1500), 5000) * falling(time, 0.26)
    return _faded((0.42 * low + 0.3 * _hiss(seed + 510, 1.3, 0.3)) * np.minimum(time / 0.002, 1.0))


def _tom(seed):
    time = _time(0.28)
    start = 250 - 45 * (seed % 3)
    body = _drop(time, start, start * 0.55, 0.06) * falling(time, 0.09) * np.minimum(time / 0.002, 1.0)
    skin = low_pass(_noise(seed + 600, time, 7000), 2500) * falling(time, 0.02)
    return _faded(body + 0.25 * skin)
