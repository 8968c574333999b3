"""The first sentence of the report: how often boxes give false hits, and what exact pixels cost."""

from collections.abc import Sequence

from game.measure.rates import Rate
from game.report.charts.tiers import AROUND
from game.report.claim import ratio_of
from game.report.job import Row

BOX, EXACT = "aabb", "mask"
WAITS = "The answer comes with the first chart: its jobs are not done yet."


def answer_of(rows: Sequence[Row]) -> str:
    """Return the first sentence of the report. rows: rows of the chart "tiers".

    The sentence gives two figures. The first is the rate of false hits of boxes, pooled over the sprites, with its 95 %
    interval (Wilson). The second is a ratio: the time of a hit by exact pixels, divided by the time of a hit by boxes.
    It is given as a range over the sprites. If the interval of every sprite's ratio contains 1, the sentence says that
    there is no difference.
    """
    mine = [row for row in rows if row.get("panel") == AROUND]
    costs = {(row["sprite"], row["series"]): row["hit_cost"] for row in mine}
    sprites = [sprite for sprite, tier in costs if tier == BOX and (sprite, EXACT) in costs]
    if not sprites:
        return WAITS
    rates = [Rate(*row["wrong"]) for row in mine if row["series"] == BOX]
    wrong = Rate(sum(rate.count for rate in rates), sum(rate.total for rate in rates))
    low, high = (round(100 * share) for share in wrong.interval)
    ratios = [ratio_of(costs[sprite, EXACT], costs[sprite, BOX]) for sprite in sprites]
    middles = sorted(middle for _, middle, _ in ratios)
    times = f"{middles[0]:.1f} to {middles[-1]:.1f} x the time"
    if all(least <= 1.0 <= most for least, _, most in ratios):
        times = "no more time that can be told apart"
    return (
        f"Of 100 hits by the boxes of sprites, {100 * wrong.share:.0f} are false ({low} to {high}). "
        f"By exact pixels none is, and a hit takes {times}."
    )
