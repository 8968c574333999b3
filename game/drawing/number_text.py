"""Times, points, counts and names as text, the same everywhere."""


def clock(seconds: float) -> str:
    """1:05.32 for 65.32 s; hours when there are any."""
    hundredths = round(seconds * 100)
    minutes, rest = divmod(hundredths, 6000)
    hours, minutes = divmod(minutes, 60)
    text = f"{minutes}:{rest // 100:02}.{rest % 100:02}"
    return f"{hours}:{minutes:02}:{rest // 100:02}" if hours else text


def short_clock(seconds: float) -> str:
    """1:05 for 65.9 s."""
    whole = int(seconds)
    hours, rest = divmod(whole, 3600)
    return f"{hours}:{rest // 60:02}:{rest % 60:02}" if hours else f"{rest // 60}:{rest % 60:02}"


def points_text(points: int) -> str:
    """12 345 678: groups of three."""
    return f"{points:,}".replace(",", " ")


def plain_name(name: str) -> str:
    """A solver, a stage or a counter as the screen shows it: sequential_impulse is "sequential impulse"."""
    return name.replace("_", " ")


def count_text(number: int, what: str) -> str:
    """ "1 plane", "2 planes"."""
    return f"{number} {what}{'s' if number != 1 else ''}"
