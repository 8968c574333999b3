"""The lander's sounds: an engine, a gun against rock, alarms, a claw, and the tune of a landing."""

from assets.craft.synth import envelope, low_pass, mixed, soft_clip, voice


def thrust():
    """Return the sound of the engine, which swells and fades.

    The game repeats it every eighth of a second, so that the repetitions form one continuous sound.
    """
    roar = low_pass(voice("noise", 26, 22, envelope(0.07, 0.06, 0.12), seed=91), 900, 620)
    hiss = low_pass(voice("noise", 160, 140, envelope(0.06, 0.05, 0.11), seed=92), 3_200, 2_400)
    hum = voice("triangle", 58, 56, envelope(0.06, 0.07, 0.11))
    return mixed((0, 1.0, roar), (0, 0.16, hiss), (0, 0.5, hum))


def blast():
    """Return the sound of a shell that hits rock: a crack, a thump, falling stones."""
    crack = low_pass(voice("noise", 240, 60, envelope(0, 0.010, 0.09, 0.5), seed=93), 6_500, 1_400)
    roar = low_pass(voice("noise", 52, 8, envelope(0, 0.06, 0.46, 0.6, 1.6), seed=94), 3_800, 260)
    thump = voice("sine", 120, 34, envelope(0.001, 0.05, 0.26, 0.3))
    stones = [
        low_pass(voice("noise", 40 - 5 * i, 14, envelope(0, 0.008, 0.06), seed=95 + i), 2_400, 700) for i in range(3)
    ]
    falls = [(0.20 + 0.09 * i, 0.5 - 0.13 * i, stone) for i, stone in enumerate(stones)]
    return soft_clip(mixed((0, 0.8, crack), (0, 1.4, roar), (0, 1.0, thump), *falls), 1.6)


def clank():
    """Return the sound of a knock on the hull: two plates that ring out of tune."""
    plate = voice("triangle", 310, 285, envelope(0, 0.008, 0.20, 0.4))
    other = voice("pulse", 467, 440, envelope(0, 0.006, 0.12), duty=(0.3, 0.2))
    thud = voice("sine", 105, 52, envelope(0, 0.02, 0.13, 0.3))
    tick = low_pass(voice("noise", 220, 70, envelope(0, 0.006, 0.05, 0.4), seed=99), 5_000, 1_500)
    return soft_clip(
        low_pass(mixed((0, 0.7, plate), (0, 0.35, other), (0, 0.9, thud), (0, 0.8, tick)), 5_500, 1_200), 1.8
    )


def alarm():
    """Return the alarm of a fast descent: one short call of two tones, the second a fourth below the first."""
    body = voice("pulse", 784, 784, envelope(0.004, 0.11, 0.05), duty=(0.3, 0.3), steps=((0.07, 0.749),))
    return low_pass(body, 4_200, 2_600)


def low_fuel():
    """Return the sound of low fuel: two soft high beeps."""
    beep = voice("triangle", 1_047, 1_047, envelope(0.004, 0.05, 0.05))
    return mixed((0, 1.0, beep), (0.13, 0.8, beep))


def hook():
    """Return the sound of the lander's line: a line that runs out, then a claw that closes."""
    whirr = low_pass(voice("noise", 120, 260, envelope(0.01, 0.05, 0.05), seed=103), 4_000, 2_500)
    click = voice("triangle", 900, 620, envelope(0, 0.004, 0.05))
    return mixed((0, 0.5, whirr), (0.09, 1.0, click), (0.12, 0.5, click))


def touchdown():
    """Return the tune of a landing: up a fifth, up a fourth, and a held major chord."""
    steps = ((0.11, 1.4983), (0.22, 1.33484), (0.36, 1.2599), (0.50, 1.18921))
    lead = voice("pulse", 294, 294, envelope(0.002, 0.66, 0.60), duty=(0.25, 0.45), vibrato=(0.006, 6), steps=steps)
    low = voice("triangle", 147, 147, envelope(0.002, 0.66, 0.60), steps=((0.36, 1.33484), (0.50, 1.4983)))
    third = voice("pulse", 740, 740, envelope(0.01, 0.20, 0.60), duty=(0.125, 0.125))
    return low_pass(mixed((0, 0.7, lead), (0, 0.8, low), (0.5, 0.32, third)), 6_800, 3_200)


SOUNDS = {function.__name__: function for function in (thrust, blast, clank, alarm, low_fuel, hook, touchdown)}
