"""A claim: a sentence that the measurements confirm, contradict, or leave undecided."""

from collections.abc import Mapping
from typing import NamedTuple

from game.measure.pareto_front import cheaper
from game.measure.timing import UNSURE, UNSURE_CELL

HOLDS, FAILS, TIE, PART = "holds", "does not hold", UNSURE_CELL, "holds in part"


class Claim(NamedTuple):
    """One claim about the measured figures, with a verdict.

    text: the claim as a sentence; figure: the measured value as text; verdict: HOLDS, FAILS, TIE, or PART of a claim
    about a swept parameter; source: paper or manual that makes the claim, "" for none.
    """

    text: str
    figure: str
    verdict: str
    source: str = ""
    order: tuple[str, ...] = ()  # from ordering(): the cheapest name; all that may be the cheapest if it is a tie
    about: str = ""  # from ordering(): the subject of the claim, without the cheapest name


def ordering(what: str, costs: Mapping[str, tuple[float, float]], unit: float = 1e6, word: str = "us") -> Claim:
    """Return the claim that one of several methods is the cheapest.

    The verdict is HOLDS if this is certain, otherwise TIE. A TIE names all methods that may be the cheapest. what:
    subject of the sentence; costs: {name: (least, median) [s]}. Two costs tie if their intervals overlap or they differ
    by less than 10 %. unit, word: factor and name of the printed unit. Raises ValueError for fewer than two costs.
    """
    if len(costs) < 2:
        raise ValueError(f"an ordering needs two costs at least (got {len(costs)})")
    ordered = sorted(costs, key=lambda name: costs[name][1])
    best = ordered[0]
    alike = [name for name in ordered if name == best or not cheaper(costs[best], costs[name])]
    reported = ", ".join(f"{name} {costs[name][1] * unit:.3g} {word}" for name in ordered[:3])
    if len(alike) > 1:
        return Claim(f"{what}: {' and '.join(alike)} are the cheapest", reported, TIE, "", tuple(sorted(alike)), what)
    return Claim(f"{what}: {best} is the cheapest", reported, HOLDS, "", (best,), what)


def at_least(text: str, ratio: tuple[float, float, float], limit: float, source: str = "", unit: str = "x") -> Claim:
    """Return the claim that a measured ratio is at least `limit`.

    The verdict is HOLDS if the whole interval is at least `limit`, FAILS if the whole interval is below `limit`, and
    otherwise TIE. text: the claim as a sentence; ratio: (low, middle, high); source: paper that makes the claim, or "";
    unit: text after the ratio.
    """
    low, _, high = ratio
    verdict = HOLDS if low >= limit else FAILS if high < limit else TIE
    return Claim(text, _figure(ratio, unit), verdict, source)


def at_most(text: str, ratio: tuple[float, float, float], limit: float, source: str = "", unit: str = "x") -> Claim:
    """Return the claim that a measured ratio is at most `limit`.

    The verdict is HOLDS if the whole interval is at most `limit`, FAILS if the whole interval is above `limit`, and
    otherwise TIE. text: the claim as a sentence; ratio: (low, middle, high); source: paper that makes the claim, or "";
    unit: text after the ratio.
    """
    low, _, high = ratio
    verdict = HOLDS if high <= limit else FAILS if low > limit else TIE
    return Claim(text, _figure(ratio, unit), verdict, source)


def region(
    text: str, ratios: Mapping[str, tuple[float, float, float]], band: tuple[float, float], words: str, source: str = ""
) -> Claim:
    """Return the claim that a ratio lies in a band at every value of a swept parameter.

    ratios: {value of the parameter, as text: (low, middle, high)}. band: (least, most) of the ratio. words: the words
    for a ratio in the band, below it and above it, separated by slashes, as "faster//no faster".

    The figure names the region of each word, with the least and the greatest of its ratios. The verdict is HOLDS or
    FAILS if the whole interval is in the band, or outside it, at every value. It is PART if this differs from value to
    value, and TIE if no interval is certainly in the band and some are unsure. Raises ValueError without a ratio.
    """
    if not ratios:
        raise ValueError("a region needs a ratio")
    inside, below, above = words.split("/")
    least, most = band
    regions: dict[str, list[str]] = {word: [] for word in (inside, below, above, UNSURE)}
    for name, (low, _, high) in ratios.items():
        is_inside = least <= low and high <= most
        word = inside if is_inside else below if high < least else above if low > most else UNSURE
        regions[word].append(name)
    figure = "; ".join(
        _reported(word, [(name, ratios[name]) for name in names]) for word, names in regions.items() if names
    )
    sure = len(regions[inside])
    verdict = HOLDS if sure == len(ratios) else PART if sure else TIE if regions[UNSURE] else FAILS
    return Claim(text, figure, verdict, source)


def _reported(word, members):
    """Return a region as text. members: (value of the parameter, ratio) of its members."""
    middles = [ratio[1] for _, ratio in members]
    low, high = (f"{each:.2g}" if each < 10.0 else f"{each:,.0f}" for each in (min(middles), max(middles)))
    return f"{word} at {', '.join(name for name, _ in members)} ({low if low == high else f'{low} to {high}'} x)"


def _figure(ratio, unit):
    """Return a ratio (low, middle, high) as text, with its interval if it has one."""
    low, middle, high = ratio
    return f"{middle:.3g} {unit}" + (f" ({low:.3g} to {high:.3g})" if low < high else "")


def ratio_of(a: Mapping, b: Mapping) -> tuple[float, float, float]:
    """Return (low, middle, high) of the ratio a / b of two costs. a, b: costs in the form of job.spread()."""
    first, second = a["seconds"], b["seconds"]
    return first[0] / second[2], first[1] / second[1], first[2] / second[0]


def pair(cost: Mapping) -> tuple[float, float]:
    """Return (least, median) [s] of a cost in the form of job.spread()."""
    return cost["seconds"][0], cost["seconds"][1]
