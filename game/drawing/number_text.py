"""Times, points, counts and names as text, in one format for the whole program."""


def clock(seconds: float) -> str:
    """Return a time [s] as text: 1:05.32 for 65.32 s. Hours are shown from one hour on."""
    hundredths = round(seconds * 100)
    minutes, rest = divmod(hundredths, 6000)
    hours, minutes = divmod(minutes, 60)
    text = f"{minutes}:{rest // 100:02}.{rest % 100:02}"
    return f"{hours}:{minutes:02}:{rest // 100:02}" if hours else text


def short_clock(seconds: float) -> str:
    """Return a time [s] as text, rounded down to whole seconds: 1:05 for 65.9 s."""
    whole = int(seconds)
    hours, rest = divmod(whole, 3600)
    return f"{hours}:{rest // 60:02}:{rest % 60:02}" if hours else f"{rest // 60}:{rest % 60:02}"


def points_text(points: int) -> str:
    """Return a number of points as text, in groups of three digits: 12 345 678."""
    return f"{points:,}".replace(",", " ")


def plain_name(name: str) -> str:
    """Return the name of a solver, stage or counter with spaces: "sequential impulse" for sequential_impulse."""
    return name.replace("_", " ")


def count_text(number: int, what: str) -> str:
    """Return a number with its noun in the singular or plural: "1 plane", "2 planes".

    what: the noun in the singular.
    """
    return f"{number} {what}{'s' if number != 1 else ''}"


def amount_text(value: float) -> str:
    """Return a number as text with three significant digits and a letter for its power of a thousand: "3.14M", "-20k".

    From a thousand up the letters are k, M, G and T. Numbers below a millionth, and beyond T, have an exponent.
    """
    size = abs(value)
    for power, letter in ((1e3, ""), (1e6, "k"), (1e9, "M"), (1e12, "G"), (1e15, "T")):
        if size < 0.9995 * power:
            scaled = float(f"{value * 1e3 / power:.3g}") + 0.0  # no "-0"
            return f"{scaled:g}{letter}"
    return f"{value:.3g}"


def percent_text(share: float) -> str:
    """Return a share as text in percent: "41 %". Small shares are "less than 1 %", large ones "over 1,000 %"."""
    if share > 10.0:
        return "over 1,000 %"
    return "less than 1 %" if 0.0 < share < 0.01 else f"{100 * share:.0f} %"
