"""Rows of the stability suite: a row is a hard case with its measured figures and their limits."""

import math
from dataclasses import dataclass, replace

SENSES = ("<=", ">=", "==")
TWICE = 2.0  # greatest factor between a value and the one on record
NOTHING = 1e-3  # share of a limit below which a value counts as none


@dataclass(frozen=True)
class Limit:
    """Limit of a named figure: `sense` is "<=", ">=" or "==", and the figure is compared with `value`."""

    figure: str
    sense: str
    value: float
    unit: str = ""

    def met(self, measured):
        """Return whether a measured value is within the limit; NaN never is."""
        if self.sense == "<=":
            return measured <= self.value
        return measured >= self.value if self.sense == ">=" else measured == self.value

    def worse(self, one, two):
        """Return the worse of two measured values; NaN is the worst."""
        if math.isnan(one) or math.isnan(two):
            return math.nan
        if self.sense == "==":
            return max(one, two, key=lambda each: abs(each - self.value))
        return max(one, two) if self.sense == "<=" else min(one, two)

    def near(self, recorded):
        """Return a limit at twice a recorded value, or this limit if it is tighter.

        A recorded value below a thousandth of the limit counts as that thousandth: such values are mostly rounding.
        """
        if not recorded > 0.0 or self.sense == "==":
            return self
        if self.sense == "<=":
            return replace(self, value=min(self.value, max(TWICE * recorded, NOTHING * self.value)))
        return replace(self, value=max(self.value, recorded / TWICE))

    def margin(self, measured):
        """Return the factor by which the value could worsen before it reaches the limit, as text such as "2.5×".

        If only one value is allowed the text is "exact". A value outside the limit gives "outside".
        """
        if self.sense == "==" or self.value == 0.0:
            return "exact" if measured == self.value else "–" if self.met(measured) else "outside"
        if not self.met(measured):
            return "outside"
        room, used = (self.value, measured) if self.sense == "<=" else (measured, self.value)
        if used <= 0.0 or room / used >= 1e3:
            return "> 1000×"
        return f"{room / used:.3g}×"


def at_most(figure, value, unit=""):
    """Return the limit of a figure that must be at most `value`."""
    return Limit(figure, "<=", value, unit)


def at_least(figure, value, unit=""):
    """Return the limit of a figure that must be at least `value`."""
    return Limit(figure, ">=", value, unit)


def exactly(figure, value, unit=""):
    """Return the limit of a figure that must equal `value`."""
    return Limit(figure, "==", value, unit)


@dataclass(frozen=True)
class Row:
    """A hard case.

    limits: limits of the measured figures; empty if the case does not apply, for the reason given in `absent`.
    defaults: limits that differ under the default settings. fault: a figure known to be outside its limit, with the
    reason; its test is expected to fail. peer: best figure of another engine, as quoted in a source.
    """

    id: str
    case: str
    limits: tuple[Limit, ...]
    source: str
    peer: str = ""
    absent: str = ""
    fault: str = ""
    defaults: tuple[Limit, ...] = ()

    def limit(self, figure, by_default=False):
        """Return the limit of a named figure, with 4 substeps or (by_default=True) under the default settings."""
        for each in (*(self.defaults if by_default else ()), *self.limits):
            if each.figure == figure:
                return each
        raise KeyError(f"{self.id} has no figure {figure!r}, but {[each.figure for each in self.limits]}")


@dataclass(frozen=True)
class Section:
    """The rows of one letter, tested in one file. numbers: numbers of its rows in the catalogue, in order."""

    letter: str
    title: str
    numbers: tuple[int, ...]
    rows: tuple[Row, ...]

    @property
    def ids(self):
        """Return the ids of this section's rows, such as "A1"."""
        return [f"{self.letter}{number}" for number in self.numbers]
