"""Costs of runs: step times that the measuring process has found for a lab, as seconds and as text."""

from typing import NamedTuple

from game.measure.timing import UNSURE_CELL

UNKNOWN = "-"  # never a zero for an unknown cost


class Difference(NamedTuple):
    """Difference of the step times of two runs [s], and the noise of this difference [s]."""

    seconds: float
    noise: float

    @property
    def counts(self):
        """True if the difference exceeds the noise."""
        return abs(self.seconds) > self.noise

    def exceeds(self, other):
        """Return whether this difference is greater than `other` by more than the noise of both."""
        return self.seconds - self.noise > other.seconds + other.noise

    def text(self):
        """Return the difference as text in microseconds with its sign; UNSURE_CELL if it is within the noise."""
        return f"{1e6 * self.seconds:+,.0f}" if self.counts else UNSURE_CELL


def difference_of(scene, name, other):
    """Return the Difference of the step times of the runs `name` and `other`, or None while measurements are missing.

    The least times are subtracted, because other load of the machine only adds time. The noise of a run is its median
    minus its least time. The noise of the difference is the sum for both runs.
    """
    both = [scene.figures.get(each) for each in (name, other)]
    if any(figures is None or not figures.sure for figures in both):
        return None
    first, second = (figures.cost for figures in both)
    return Difference(first.least - second.least, first.median - first.least + second.median - second.least)


def cost_of(scene, name):
    """Return the median time of a step [s] of the run `name`, or None before there are enough measurements."""
    figures = scene.figures.get(name)
    return figures.cost.median if figures is not None and figures.sure else None


def cost_text(scene, name):
    """Return the median time of a step of the run `name` as text in microseconds; "-" while it is unknown."""
    seconds = cost_of(scene, name)
    return UNKNOWN if seconds is None else microseconds(seconds)


def microseconds(seconds):
    """Return a time given in seconds as text in microseconds, with one decimal below 100 us."""
    return f"{1e6 * seconds:,.{0 if seconds >= 99.95e-6 else 1}f} us"
