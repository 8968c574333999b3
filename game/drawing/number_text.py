"""Times, points, counts and names as text, in one format for the whole program."""

ROUNDING = 1e-9  # relative errors, and lengths [px], below this are those of rounding
SMALLEST = 0.001  # [%, px] smaller values are not written in digits
TIER_WORDS = {"aabb": "box", "obb": "turned box", "mask": "exact"}


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


def tier_name(tier: str) -> str:
    """Return the name of a collision tier in plain words: "box" for aabb, "turned box" for obb, "exact" for mask."""
    return TIER_WORDS.get(tier, tier)


def share_text(share: float) -> str:
    """Return a share as a percentage in plain digits: "3.5 %", "0.015 %", "under 0.001 %".

    Rounding errors are "0 %".
    """
    percent = 100.0 * share
    if abs(share) < ROUNDING:
        return "0 %"
    if abs(percent) < SMALLEST:
        return f"under {SMALLEST} %"
    return f"{percent:.1f} %" if abs(percent) >= 1.0 else f"{percent:.3f}".rstrip("0").rstrip(".") + " %"


def error_text(share: float) -> str:
    """Return a relative error in words: "off by 3.5 %", or that it is too small to be told from rounding."""
    return "no error that can be told" if abs(share) < ROUNDING else f"off by {share_text(share)}"


def gap_text(pixels: float) -> str:
    """Return a difference of lengths [px] in words: "0.012 px", "under 0.001 px", "no difference that can be told"."""
    if abs(pixels) < ROUNDING:
        return "no difference that can be told"
    return f"{pixels:.3f} px" if abs(pixels) >= SMALLEST else f"under {SMALLEST} px"


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
