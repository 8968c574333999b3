"""The first sentences of the report: how often boxes give false hits, and what exact pixels cost."""

from collections.abc import Sequence

from game.measure.rates import Rate
from game.measure.timing import UNSURE
from game.report.charts.tiers import AROUND
from game.report.claim import ratio_of
from game.report.job import Row
from game.report.pygame_sprites import BOXES, STEP

BOX, EXACT = "aabb", "mask"
WAITS = "The answer comes with charts 1 and 14: their jobs are not done yet."


def answer_of(rows: Sequence[Row], stepped: Sequence[Row]) -> str:
    """Return the first sentences of the report. rows: rows of the chart "tiers"; stepped: rows of the chart "peers".

    The first two are about upright sprites that move, in whole steps of a world (chart 14): the rate of false hits of
    boxes over independent encounters, with its 95 % interval (Wilson), that of pixels, and the ratio of the times of a
    step, as a range over the numbers of sprites. The last is about sprites that turn (chart 1): the ratio of the times
    of a hit, as a range over the sprites.
    """
    moving = {(row["series"], row["n"]): row for row in stepped if row.get("panel") == "sprites"}
    counts = [n for name, n in moving if name == BOXES and (STEP, n) in moving]
    mine = [row for row in rows if row.get("panel") == AROUND]
    costs = {(row["sprite"], row["series"]): row["hit_cost"] for row in mine}
    sprites = [sprite for sprite, tier in costs if tier == BOX and (sprite, EXACT) in costs]
    if not sprites or not counts:
        return WAITS
    boxes, pixels = (_pooled([moving[name, n]["wrong"] for n in counts]) for name in (BOXES, STEP))
    low, high = (round(100 * share) for share in boxes.interval)
    steps = _times([ratio_of(moving[STEP, n]["cost"], moving[BOXES, n]["cost"]) for n in counts])
    hits = _times([ratio_of(costs[sprite, EXACT], costs[sprite, BOX]) for sprite in sprites])
    exactly = "none is" if not pixels.count else f"{100 * pixels.share:.1f} are"
    return (
        f"Of 100 hits by the boxes of upright sprites, {100 * boxes.share:.0f} are false ({low} to {high}). "
        f"By their pixels {exactly}, and the time of a whole step {steps}. "
        f"Rotated, by exact pixels (tier {EXACT}), the time of a hit {hits}."
    )


def _pooled(wrong):
    """Return the Rate of several rates together. wrong: rates as [count, total]."""
    return Rate(sum(count for count, _ in wrong), sum(total for _, total in wrong))


def _times(ratios):
    """Return ratios of times to those of boxes, (low, middle, high), as the end of a sentence."""
    if all(least <= 1.0 <= most for least, _, most in ratios):
        return f"{UNSURE} from that by boxes"
    middles = sorted(middle for _, middle, _ in ratios)
    first, last = (f"{middle:.1f}" for middle in (middles[0], middles[-1]))
    return f"is {first} x that by boxes" if first == last else f"is {first} to {last} x that by boxes"
