"""One row of the stability suite: a hard case, what is measured of it, and how far that may go."""

import math
from dataclasses import dataclass, replace

SENSES = ("<=", ">=", "==")
TWICE = 2.0  # greatest factor between a value and the one on record
NOTHING = 1e-3  # share of a limit below which a value counts as none


@dataclass(frozen=True)
class Limit:
    """A figure by name, and what it has to be."""

    figure: str
    sense: str
    value: float
    unit: str = ""

    def met(self, measured):
        """Return whether a measured value is within the limit; nan never is."""
        if self.sense == "<=":
            return measured <= self.value
        return measured >= self.value if self.sense == ">=" else measured == self.value

    def worse(self, one, two):
        """The worse of two measured values."""
        if math.isnan(one) or math.isnan(two):
            return math.nan
        if self.sense == "==":
            return max(one, two, key=lambda each: abs(each - self.value))
        return max(one, two) if self.sense == "<=" else min(one, two)

    def near(self, recorded):
        """Return a limit at twice a recorded value, or this limit if it is nearer.

        Values of up to a thousandth of the limit do not count: most of them are rounding.
        """
        if not recorded > 0.0 or self.sense == "==":
            return self
        if self.sense == "<=":
            return replace(self, value=min(self.value, max(TWICE * recorded, NOTHING * self.value)))
        return replace(self, value=max(self.value, recorded / TWICE))

    def margin(self, measured):
        """Return the factor by which the value could grow before the limit; None if only one value is right."""
        if self.sense == "==" or self.value == 0.0:
            return "exact" if measured == self.value else "–" if self.met(measured) else "outside"
        if not self.met(measured):
            return "outside"
        room, used = (self.value, measured) if self.sense == "<=" else (measured, self.value)
        if used <= 0.0 or room / used >= 1e3:
            return "> 1000×"
        return f"{room / used:.3g}×"


def at_most(figure, value, unit=""):
    """The limit of a figure that may be no greater."""
    return Limit(figure, "<=", value, unit)


def at_least(figure, value, unit=""):
    """The limit of a figure that may be no less."""
    return Limit(figure, ">=", value, unit)


def exactly(figure, value, unit=""):
    """The limit of a figure of which one value is right."""
    return Limit(figure, "==", value, unit)


@dataclass(frozen=True)
class Row:
    """A hard case.

    limits: limits of the measured figures; none if `absent` gives the reason why the case does not apply to this
    engine. defaults: other limits of figures under the default settings. fault: a known figure outside its limit, and
    the reason; its test is expected to fail. peer: the best figure of another engine that a source quotes.
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
        """The limit of a figure by its name, with 4 substeps or under the default settings."""
        for each in (*(self.defaults if by_default else ()), *self.limits):
            if each.figure == figure:
                return each
        raise KeyError(f"{self.id} has no figure {figure!r}, but {[each.figure for each in self.limits]}")


@dataclass(frozen=True)
class Section:
    """The rows of one letter, whose tests are in one file. numbers: numbers of its rows in the catalogue, in order."""

    letter: str
    title: str
    numbers: tuple[int, ...]
    rows: tuple[Row, ...]

    @property
    def ids(self):
        """Ids of the catalogue's rows in this section."""
        return [f"{self.letter}{number}" for number in self.numbers]
