"""A claim: a sentence that the measurements confirm, contradict, or leave undecided."""

from collections.abc import Mapping
from typing import NamedTuple

from game.measure.pareto_front import cheaper

HOLDS, FAILS, TIE = "holds", "does not hold", "a tie"


class Claim(NamedTuple):
    """One claim about the measured figures, with a verdict.

    text: the claim as a sentence; figure: the measured value as text; verdict: HOLDS, FAILS or TIE; source: paper or
    manual that makes the claim, "" for none.
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
    low, middle, high = ratio
    verdict = HOLDS if low >= limit else FAILS if high < limit else TIE
    return Claim(text, f"{middle:.3g} {unit} ({low:.3g} to {high:.3g})", verdict, source)


def at_most(text: str, ratio: tuple[float, float, float], limit: float, source: str = "", unit: str = "x") -> Claim:
    """Return the claim that a measured ratio is at most `limit`.

    The verdict is HOLDS if the whole interval is at most `limit`, FAILS if the whole interval is above `limit`, and
    otherwise TIE. text: the claim as a sentence; ratio: (low, middle, high); source: paper that makes the claim, or "";
    unit: text after the ratio.
    """
    low, middle, high = ratio
    verdict = HOLDS if high <= limit else FAILS if low > limit else TIE
    return Claim(text, f"{middle:.3g} {unit} ({low:.3g} to {high:.3g})", verdict, source)


def ratio_of(a: Mapping, b: Mapping) -> tuple[float, float, float]:
    """Return (low, middle, high) of the ratio a / b of two costs. a, b: costs in the form of job.spread()."""
    first, second = a["seconds"], b["seconds"]
    return first[0] / second[2], first[1] / second[1], first[2] / second[0]


def pair(cost: Mapping) -> tuple[float, float]:
    """Return (least, median) [s] of a cost in the form of job.spread()."""
    return cost["seconds"][0], cost["seconds"][1]
