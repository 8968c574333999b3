"""The sound effects. Each is a function that returns its samples, which are written to assets/sounds/<name>.wav.

The sounds are short and share a style: pulse waves for the player and rewards, noise for damage, sine and saw for
enemies.
"""

from assets.audio import breaking_sounds, lander_sounds
from assets.craft.synth import envelope, finish, low_pass, mixed, soft_clip, to_wav, voice


def laser():
    """Return the sound of the player's shot: a falling pulse that thins out, soft enough for eight shots a second."""
    body = voice("pulse", 1150, 240, envelope(0.001, 0.03, 0.12, 0.2), duty=(0.5, 0.18))
    click = voice("noise", 420, 160, envelope(0, 0.004, 0.02), seed=4)
    return low_pass(mixed((0, 0.8, body), (0, 0.35, click)), 7_500, 1_800)


def enemy_shot():
    """Return the sound of an enemy's shot, rounder and lower than the player's: a falling sine with a little growl."""
    body = voice("sine", 820, 230, envelope(0.002, 0.04, 0.14, 0.3))
    growl = voice("saw", 410, 115, envelope(0.002, 0.02, 0.10))
    return mixed((0, 1.0, body), (0, 0.22, growl))


def hit():
    """Return the sound of a bullet on armour: a tick of noise over a metallic pair of tones."""
    tick = voice("noise", 190, 60, envelope(0, 0.012, 0.08, 0.5), seed=7)
    ring = voice("triangle", 1480, 1320, envelope(0, 0.005, 0.07))
    return low_pass(mixed((0, 1.0, tick), (0, 0.35, ring)), 6_000, 2_200)


def explosion():
    """Return the sound of an explosion: noise that falls and darkens, over a falling deep tone."""
    roar = low_pass(voice("noise", 55, 7, envelope(0, 0.10, 0.72, 0.7, 1.6), seed=11), 6_000, 400)
    boom = voice("sine", 95, 32, envelope(0.002, 0.08, 0.40, 0.2))
    crack = voice("noise", 300, 120, envelope(0, 0.010, 0.05), seed=12)
    return soft_clip(mixed((0, 1.6, roar), (0, 0.9, boom), (0, 0.5, crack)), 1.4)


def big_explosion():
    """Return the sound of the gunship's explosion: two blasts and a long rumble."""
    first = low_pass(voice("noise", 60, 6, envelope(0, 0.16, 1.15, 0.6, 1.5), vibrato=(0.2, 7), seed=21), 5_000, 260)
    second = low_pass(voice("noise", 48, 8, envelope(0, 0.10, 0.80, 0.5, 1.6), seed=22), 4_000, 320)
    boom = voice("sine", 80, 26, envelope(0.002, 0.16, 0.70, 0.2))
    return soft_clip(mixed((0, 1.6, first), (0.16, 1.2, second), (0, 1.0, boom)), 1.5)


def coin():
    """Return the sound of a coin: two notes, a fourth apart, which ring out."""
    lead = voice("pulse", 988, 988, envelope(0.001, 0.03, 0.34, 0.3), duty=(0.5, 0.5), steps=((0.07, 1.335),))
    glint = voice("triangle", 1976, 1976, envelope(0.001, 0.02, 0.22), steps=((0.07, 1.335),))
    return low_pass(mixed((0, 0.8, lead), (0, 0.4, glint)), 8_000, 3_500)


def powerup():
    """Return the sound of a power-up: a rising arpeggio with vibrato."""
    steps = ((0.07, 1.25), (0.14, 1.2), (0.21, 1.3333), (0.28, 1.25))
    lead = voice("pulse", 392, 400, envelope(0.002, 0.30, 0.26), duty=(0.25, 0.5), vibrato=(0.012, 13), steps=steps)
    under = voice("triangle", 196, 200, envelope(0.002, 0.30, 0.26), steps=steps)
    return low_pass(mixed((0, 0.8, lead), (0, 0.7, under)), 7_000, 4_000)


def jump():
    """Return the sound of a jump: a quick upward chirp."""
    body = voice("pulse", 250, 620, envelope(0.001, 0.07, 0.11), duty=(0.42, 0.22))
    return low_pass(body, 6_500, 3_000)


def hurt():
    """Return the sound of the hurt player: a buzzing fall with a thud."""
    buzz = voice("saw", 430, 85, envelope(0.001, 0.06, 0.20, 0.3), vibrato=(0.05, 28))
    thud = voice("noise", 60, 18, envelope(0, 0.02, 0.10, 0.3), seed=31)
    return soft_clip(low_pass(mixed((0, 0.9, buzz), (0, 0.7, thud)), 5_000, 1_200), 2.5)


def spring():
    """Return the sound of a spring: a wobbling rise."""
    body = voice("triangle", 190, 760, envelope(0.001, 0.10, 0.24), vibrato=(0.16, 24))
    edge = voice("pulse", 190, 760, envelope(0.001, 0.04, 0.14), duty=(0.3, 0.2), vibrato=(0.16, 24))
    return low_pass(mixed((0, 1.0, body), (0, 0.35, edge)), 6_000, 2_500)


def land():
    """Return the sound of a landing: feet on the ground, barely audible."""
    return low_pass(voice("noise", 42, 16, envelope(0, 0.010, 0.07, 0.2), seed=41), 2_400, 700)


def stomp():
    """Return the sound of an enemy on whose head the hero jumps: a short, dull fall."""
    body = voice("triangle", 360, 90, envelope(0.001, 0.03, 0.12, 0.2))
    puff = voice("noise", 80, 30, envelope(0, 0.010, 0.09), seed=43)
    return low_pass(mixed((0, 1.0, body), (0, 0.5, puff)), 4_500, 1_500)


def blip():
    """Return the sound of the menu's cursor when it moves."""
    return low_pass(voice("pulse", 660, 700, envelope(0.001, 0.02, 0.04)), 5_000, 3_000)


def confirm():
    """Return the sound of a choice in the menu: two rising notes."""
    body = voice("pulse", 523, 523, envelope(0.001, 0.06, 0.16), duty=(0.25, 0.25), steps=((0.06, 1.5),))
    return low_pass(body, 6_000, 3_000)


def goal():
    """Return the sound of a level's end: four notes and a held fifth."""
    steps = ((0.12, 1.26), (0.24, 1.19), (0.36, 1.335))
    lead = voice("pulse", 523, 523, envelope(0.002, 0.55, 0.55), duty=(0.25, 0.4), vibrato=(0.006, 6), steps=steps)
    low = voice("triangle", 262, 262, envelope(0.002, 0.55, 0.55), steps=steps)
    high = voice("pulse", 784, 784, envelope(0.01, 0.20, 0.50), duty=(0.125, 0.125))
    return low_pass(mixed((0, 0.7, lead), (0, 0.8, low), (0.36, 0.35, high)), 7_000, 3_500)


def heavy_laser():
    """Return the sound of the player's strongest shot and of a boss's beam: a falling saw tone over a lower tone."""
    body = voice("saw", 620, 90, envelope(0.001, 0.05, 0.20, 0.3))
    under = voice("pulse", 310, 45, envelope(0.001, 0.05, 0.18), duty=(0.5, 0.3))
    spit = voice("noise", 300, 90, envelope(0, 0.006, 0.04), seed=5)
    return low_pass(mixed((0, 0.7, body), (0, 0.6, under), (0, 0.4, spit)), 6_500, 1_000)


def bomb():
    """Return the sound of the player's bomb: an intake of air, the deepest blast of all, wind with a sinking tone."""
    swell = low_pass(voice("noise", 14, 70, envelope(0.12, 0.01, 0.03), seed=51), 700, 4_500)
    roar = low_pass(voice("noise", 58, 6, envelope(0, 0.18, 1.05, 0.8, 1.5), seed=52), 2_400, 140)
    wind = low_pass(voice("noise", 30, 10, envelope(0.10, 0.20, 1.05), vibrato=(0.15, 5), seed=53), 1_200, 300)
    boom = voice("sine", 105, 27, envelope(0.002, 0.30, 0.85, 0.3))
    sink = voice("triangle", 520, 45, envelope(0.01, 0.30, 0.70), vibrato=(0.03, 11))
    return soft_clip(
        mixed((0, 0.35, swell), (0.12, 1.5, roar), (0.12, 0.5, wind), (0.12, 1.3, boom), (0.10, 0.5, sink)), 1.5
    )


def graze():
    """Return the sound of a bullet that just missed: high but soft, so that many in a row are bearable."""
    glint = voice("triangle", 1_760, 2_350, envelope(0.002, 0.008, 0.055))
    air = voice("noise", 260, 420, envelope(0.004, 0.006, 0.035), seed=61)
    return low_pass(mixed((0, 1.0, glint), (0, 0.22, air)), 6_000, 3_000)


def warning():
    """Return the warning of a boss: a horn of two tones, three times. Each call starts muffled and brightens."""
    call = voice("pulse", 220, 220, envelope(0.02, 0.22, 0.14), duty=(0.5, 0.25), steps=((0.17, 1.4142),))
    low = voice("saw", 110, 110, envelope(0.02, 0.22, 0.14), steps=((0.17, 1.4142),))
    horn = low_pass(mixed((0, 0.8, call), (0, 0.6, low)), 900, 3_200)
    return mixed((0, 0.8, horn), (0.42, 0.9, horn), (0.84, 1.0, horn))


def crumble():
    """Return the sound of a breaking stone block: grains, then pieces, then dust."""
    crack = low_pass(voice("noise", 85, 30, envelope(0, 0.012, 0.06, 0.5), seed=71), 4_200, 1_200)
    pieces = [
        low_pass(voice("noise", 36 - 4 * i, 12, envelope(0, 0.012, 0.075, 0.4), seed=72 + i), 2_200, 500)
        for i in range(4)
    ]
    falls = [(0.07 + 0.075 * i, 0.75 - 0.12 * i, piece) for i, piece in enumerate(pieces)]
    thud = voice("sine", 120, 55, envelope(0.001, 0.02, 0.12))
    return soft_clip(mixed((0, 1.0, crack), (0, 0.6, thud), *falls), 2.0)


def checkpoint():
    """Return the sound of a checkpoint: a fourth, then the octave, held."""
    steps = ((0.09, 1.3348), (0.18, 1.4983))
    lead = voice("pulse", 440, 440, envelope(0.002, 0.20, 0.34), duty=(0.25, 0.4), vibrato=(0.005, 6), steps=steps)
    under = voice("triangle", 220, 220, envelope(0.002, 0.20, 0.34), steps=steps)
    return low_pass(mixed((0, 0.7, lead), (0, 0.8, under)), 6_000, 3_000)


def secret():
    """Return the sound of a found secret: six quick rising notes in whole tones, with an echo."""
    steps = tuple((0.06 * i, 1.122462) for i in range(1, 6))
    lead = voice("triangle", 587, 587, envelope(0.002, 0.34, 0.24), steps=steps)
    glint = voice("pulse", 1_174, 1_174, envelope(0.002, 0.34, 0.16), duty=(0.25, 0.25), steps=steps)
    stair = low_pass(mixed((0, 1.0, lead), (0, 0.22, glint)), 6_500, 4_000)
    return mixed((0, 1.0, stair), (0.16, 0.32, stair), (0.32, 0.10, stair))


def crate():
    """Return the sound of a crate that knocks on wood or stone: a hollow double tone with a dry tick."""
    knock = voice("sine", 240, 175, envelope(0, 0.006, 0.075, 0.4))
    hollow = voice("triangle", 610, 520, envelope(0, 0.003, 0.035))
    tick = low_pass(voice("noise", 110, 40, envelope(0, 0.004, 0.03), seed=81), 3_500, 1_200)
    return mixed((0, 1.0, knock), (0, 0.35, hollow), (0, 0.6, tick))


def ladder():
    """Return the sound of one rung of a ladder: a small wooden tap, soft enough to be heard four times a second."""
    tap = voice("triangle", 430, 360, envelope(0, 0.004, 0.045))
    scuff = low_pass(voice("noise", 60, 40, envelope(0.002, 0.006, 0.03), seed=83), 2_600, 1_000)
    return mixed((0, 0.8, tap), (0, 0.5, scuff))


def back():
    """Return the sound of a step back in the menu: `confirm` reversed, and softer."""
    body = voice("pulse", 523, 523, envelope(0.001, 0.06, 0.13), duty=(0.25, 0.25), steps=((0.06, 0.6674),))
    return low_pass(body, 4_200, 2_200)


def chain_break():
    """Return the sound of the end of a score chain: two soft notes down a minor third."""
    body = voice("triangle", 494, 494, envelope(0.006, 0.09, 0.20), steps=((0.09, 0.8409),))
    air = voice("sine", 247, 200, envelope(0.006, 0.08, 0.18))
    return low_pass(mixed((0, 0.9, body), (0, 0.5, air)), 3_000, 1_500)


def life():
    """Return the sound of an extra life: a rising run of notes that ends on the octave."""
    steps = ((0.08, 1.2599), (0.16, 1.18921), (0.24, 1.33484), (0.32, 1.2599), (0.40, 0.89090), (0.48, 1.33484))
    lead = voice("pulse", 330, 330, envelope(0.002, 0.50, 0.36), duty=(0.5, 0.25), vibrato=(0.006, 7), steps=steps)
    under = voice("triangle", 165, 165, envelope(0.002, 0.50, 0.36), steps=steps)
    return low_pass(mixed((0, 0.7, lead), (0, 0.8, under)), 6_500, 3_200)


SOUNDS = (
    {
        function.__name__: function
        for function in (
            laser,
            enemy_shot,
            hit,
            explosion,
            coin,
            powerup,
            jump,
            hurt,
            big_explosion,
            spring,
            land,
            stomp,
            blip,
            confirm,
            goal,
            heavy_laser,
            bomb,
            graze,
            warning,
            crumble,
            checkpoint,
            secret,
            crate,
            ladder,
            back,
            chain_break,
            life,
        )
    }
    | lander_sounds.SOUNDS
    | breaking_sounds.SOUNDS
)


PRODUCTS = {f"sounds/{name}": (__name__, "sound_files", (name,)) for name in SOUNDS}


def sound_files(name):
    """Return {path relative to assets/: bytes} of one sound. name: name of the function that returns its samples."""
    return {f"sounds/{name}.wav": to_wav(finish(SOUNDS[name]()))}
