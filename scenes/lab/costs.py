"""Costs of a lab's runs, which are timed beside the game: in seconds, and as text for the picture."""

UNKNOWN = "-"  # never a zero for an unknown cost


def cost_of(scene, name):
    """Return the median time of a step [s] of the run `name`, or None before there are enough measurements."""
    figures = scene.figures.get(name)
    return figures.cost.median if figures is not None and figures.sure else None


def cost_text(scene, name):
    """Return the median time of a step of the run `name` as text in microseconds, "-" while it is unknown."""
    seconds = cost_of(scene, name)
    return UNKNOWN if seconds is None else microseconds(seconds)


def microseconds(seconds):
    """Return a time [s] as text in microseconds, with one decimal below 100 us."""
    return f"{1e6 * seconds:,.{0 if seconds >= 99.95e-6 else 1}f} us"
