"""Cost of the runs of a lab, as far as measured beside the game: seconds, and text for the picture."""

UNKNOWN = "-"  # never a zero for an unknown cost


def cost_of(scene, name):
    """Return the median time of a step of a run [s]; None before there are enough measurements."""
    figures = scene.figures.get(name)
    return figures.cost.median if figures is not None and figures.sure else None


def cost_text(scene, name):
    """Return the same in microseconds, "-" while unknown."""
    seconds = cost_of(scene, name)
    return UNKNOWN if seconds is None else microseconds(seconds)


def microseconds(seconds):
    """Return seconds as text in microseconds, three digits of those below 100."""
    return f"{1e6 * seconds:,.{0 if seconds >= 99.95e-6 else 1}f} us"
