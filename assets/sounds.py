"""The sound effects: each a function that returns samples, written to assets/sounds/<name>.wav.

They are short and share one mood: pulse waves for the player and rewards, noise for damage, sine and saw for enemies.
"""

from assets.synth import envelope, finish, low_pass, mixed, soft_clip, to_wav, voice


def laser():
    """The player's shot: a falling pulse that thins out, soft enough to hear eight times a second."""
    body = voice("pulse", 1150, 240, envelope(0.001, 0.03, 0.12, 0.2), duty=(0.5, 0.18))
    click = voice("noise", 420, 160, envelope(0, 0.004, 0.02), seed=4)
    return low_pass(mixed((0, 0.8, body), (0, 0.35, click)), 7_500, 1_800)


def enemy_shot():
    """Rounder and lower than the player's: a sine drop with a little growl."""
    body = voice("sine", 820, 230, envelope(0.002, 0.04, 0.14, 0.3))
    growl = voice("saw", 410, 115, envelope(0.002, 0.02, 0.10))
    return mixed((0, 1.0, body), (0, 0.22, growl))


def hit():
    """A bullet on armour: a tick of noise over a metallic pair of tones."""
    tick = voice("noise", 190, 60, envelope(0, 0.012, 0.08, 0.5), seed=7)
    ring = voice("triangle", 1480, 1320, envelope(0, 0.005, 0.07))
    return low_pass(mixed((0, 1.0, tick), (0, 0.35, ring)), 6_000, 2_200)


def explosion():
    """Noise that falls and darkens, with a sub drop under it."""
    roar = low_pass(voice("noise", 55, 7, envelope(0, 0.10, 0.72, 0.7, 1.6), seed=11), 6_000, 400)
    boom = voice("sine", 95, 32, envelope(0.002, 0.08, 0.40, 0.2))
    crack = voice("noise", 300, 120, envelope(0, 0.010, 0.05), seed=12)
    return soft_clip(mixed((0, 1.6, roar), (0, 0.9, boom), (0, 0.5, crack)), 1.4)


def big_explosion():
    """For the gunship: two blasts and a long rumble."""
    first = low_pass(voice("noise", 60, 6, envelope(0, 0.16, 1.15, 0.6, 1.5), vibrato=(0.2, 7), seed=21), 5_000, 260)
    second = low_pass(voice("noise", 48, 8, envelope(0, 0.10, 0.80, 0.5, 1.6), seed=22), 4_000, 320)
    boom = voice("sine", 80, 26, envelope(0.002, 0.16, 0.70, 0.2))
    return soft_clip(mixed((0, 1.6, first), (0.16, 1.2, second), (0, 1.0, boom)), 1.5)


def coin():
    """Two notes, a fourth apart, ringing out."""
    lead = voice("pulse", 988, 988, envelope(0.001, 0.03, 0.34, 0.3), duty=(0.5, 0.5), steps=((0.07, 1.335),))
    glint = voice("triangle", 1976, 1976, envelope(0.001, 0.02, 0.22), steps=((0.07, 1.335),))
    return low_pass(mixed((0, 0.8, lead), (0, 0.4, glint)), 8_000, 3_500)


def powerup():
    """A rising arpeggio with vibrato."""
    steps = ((0.07, 1.25), (0.14, 1.2), (0.21, 1.3333), (0.28, 1.25))
    lead = voice("pulse", 392, 400, envelope(0.002, 0.30, 0.26), duty=(0.25, 0.5), vibrato=(0.012, 13), steps=steps)
    under = voice("triangle", 196, 200, envelope(0.002, 0.30, 0.26), steps=steps)
    return low_pass(mixed((0, 0.8, lead), (0, 0.7, under)), 7_000, 4_000)


def jump():
    """A quick upward chirp."""
    body = voice("pulse", 250, 620, envelope(0.001, 0.07, 0.11), duty=(0.42, 0.22))
    return low_pass(body, 6_500, 3_000)


def hurt():
    """A buzzing fall with a thud."""
    buzz = voice("saw", 430, 85, envelope(0.001, 0.06, 0.20, 0.3), vibrato=(0.05, 28))
    thud = voice("noise", 60, 18, envelope(0, 0.02, 0.10, 0.3), seed=31)
    return low_pass(mixed((0, 0.9, buzz), (0, 0.7, thud)), 5_000, 1_200)


def spring():
    """A boing: a wobbling rise."""
    body = voice("triangle", 190, 760, envelope(0.001, 0.10, 0.24), vibrato=(0.16, 24))
    edge = voice("pulse", 190, 760, envelope(0.001, 0.04, 0.14), duty=(0.3, 0.2), vibrato=(0.16, 24))
    return low_pass(mixed((0, 1.0, body), (0, 0.35, edge)), 6_000, 2_500)


def land():
    """Feet on the ground: barely there."""
    return low_pass(voice("noise", 42, 16, envelope(0, 0.010, 0.07, 0.2), seed=41), 2_400, 700)


def stomp():
    """A walker squashed: a short falling blob."""
    body = voice("triangle", 360, 90, envelope(0.001, 0.03, 0.12, 0.2))
    puff = voice("noise", 80, 30, envelope(0, 0.010, 0.09), seed=43)
    return low_pass(mixed((0, 1.0, body), (0, 0.5, puff)), 4_500, 1_500)


def blip():
    """The menu's cursor."""
    return low_pass(voice("pulse", 660, 700, envelope(0.001, 0.02, 0.04)), 5_000, 3_000)


def confirm():
    """The menu's yes: two rising notes."""
    body = voice("pulse", 523, 523, envelope(0.001, 0.06, 0.16), duty=(0.25, 0.25), steps=((0.06, 1.5),))
    return low_pass(body, 6_000, 3_000)


def goal():
    """The end of a level: four notes and a held fifth."""
    steps = ((0.12, 1.26), (0.24, 1.19), (0.36, 1.335))
    lead = voice("pulse", 523, 523, envelope(0.002, 0.55, 0.55), duty=(0.25, 0.4), vibrato=(0.006, 6), steps=steps)
    low = voice("triangle", 262, 262, envelope(0.002, 0.55, 0.55), steps=steps)
    high = voice("pulse", 784, 784, envelope(0.01, 0.20, 0.50), duty=(0.125, 0.125))
    return low_pass(mixed((0, 0.7, lead), (0, 0.8, low), (0.36, 0.35, high)), 7_000, 3_500)


SOUNDS = {
    function.__name__: function
    for function in (
        laser, enemy_shot, hit, explosion, coin, powerup, jump, hurt,
        big_explosion, spring, land, stomp, blip, confirm, goal,
    )
}


def sound_files(name):
    """Return {relative path: bytes} of one sound."""
    return {f"sounds/{name}.wav": to_wav(finish(SOUNDS[name]()))}
