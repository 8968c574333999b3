"""What a lane of a lab costs, as far as it was measured beside the game: seconds, and text for the picture."""

UNKNOWN = "-"  # never a zero: nobody knows yet


def cost_of(scene, name):
    """The median of the seconds that a step of a lane took; None while it was not run often enough."""
    figures = scene.figures.get(name)
    return figures.cost.median if figures is not None and figures.sure else None


def cost_text(scene, name):
    """The same in microseconds, "-" while it is not known."""
    seconds = cost_of(scene, name)
    return UNKNOWN if seconds is None else microseconds(seconds)


def microseconds(seconds):
    """Seconds as text in microseconds, three digits of those below 100."""
    return f"{1e6 * seconds:,.{0 if seconds >= 99.95e-6 else 1}f} us"
