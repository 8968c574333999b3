"""Sounds of breaking and throwing: torn metal, a splash, a bomb's fuse, a throw."""

from assets.craft.synth import envelope, low_pass, mixed, soft_clip, voice


def tear():
    """Return the sound of a breaking plane: a crack, two shrieking plates, and rivets that break one by one."""
    crack = low_pass(voice("noise", 320, 90, envelope(0, 0.008, 0.07, 0.5), seed=111), 6_500, 1_800)
    shriek = voice("saw", 540, 150, envelope(0.02, 0.07, 0.26, 0.4), vibrato=(0.09, 37))
    plate = voice("triangle", 233, 120, envelope(0.004, 0.04, 0.22), vibrato=(0.05, 19))
    rivet = voice("triangle", 1_250, 820, envelope(0, 0.003, 0.03))
    rivets = [(0.06 + 0.052 * i, 0.34 - 0.05 * i, rivet) for i in range(5)]
    body = mixed((0, 0.9, crack), (0.02, 0.5, shriek), (0.02, 0.6, plate), *rivets)
    return soft_clip(low_pass(body, 5_500, 1_600), 1.6)


def splash():
    """Return the sound of a heavy splash: a slap, foam that hisses and settles, a gulp."""
    slap = low_pass(voice("noise", 150, 40, envelope(0, 0.010, 0.06, 0.4), seed=113), 4_800, 1_600)
    foam = low_pass(voice("noise", 210, 90, envelope(0.02, 0.08, 0.38, 0.4), seed=114), 3_600, 900)
    gulp = voice("sine", 150, 330, envelope(0.004, 0.03, 0.10))
    return mixed((0, 1.0, slap), (0.01, 0.7, foam), (0.05, 0.6, gulp))


def fuse():
    """Return the sound of a lit fuse: sparks, then a hiss. The game repeats it while the fuse burns."""
    spit = low_pass(voice("noise", 300, 200, envelope(0, 0.010, 0.05, 0.5), seed=115), 3_600, 2_200)
    hiss = low_pass(voice("noise", 300, 320, envelope(0.02, 0.10, 0.10), vibrato=(0.2, 31), seed=116), 3_000, 2_400)
    return mixed((0, 0.8, spit), (0.01, 0.7, hiss))


def throw():
    """Return the sound of a throw: a breath of air that rises and ends."""
    air = low_pass(voice("noise", 60, 210, envelope(0.03, 0.03, 0.09, 0.5), seed=117), 1_300, 3_000)
    tone = voice("triangle", 240, 410, envelope(0.01, 0.03, 0.08))
    return mixed((0, 1.0, air), (0.02, 0.35, tone))


SOUNDS = {function.__name__: function for function in (tear, splash, fuse, throw)}
