"""Table of the study: each row has a scene, the figure computed from it, and the limit for Hitbox.

Sources of the limits: ISSUE is a goal of the work on stability. If there is no such goal, BEST is the figure of the
best peer: the quoted one of AVBD or the measured one of pymunk. quoted: figures from the study of 2026-11-22, on scenes
of the same kind; a dash if not measured. The engines are Box2D 3.2 (native C, 4 substeps), Rapier 0.21 and AVBD (10
iterations).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial

from tests.stability.study import measures, motions, stacks, structures
from tests.stability.study.recording import Run
from tests.stability.study.scene import Scene
from tests.stability.study.toppling import fall_time

ISSUE, BEST = "issue", "best peer"
INSIDE, OUTSIDE = 0.95, 1.05  # of the analytic limit
LATE = 1.25  # times the rigid part's time
SEEDS = 5
SLIDING = 0.105  # [%] of the way to rest: what soft_step with 4 substeps showed when the study began
EXACT = 1e-9  # [%] of the turn, that showed rounding alone


@dataclass(frozen=True)
class Row:
    """A row of the table. Its figure is that of the worst seed, the one with the greatest absolute value."""

    name: str
    scene: Callable[[int], Scene]  # of a seed
    measure: Callable[[Run], float]
    limit: float | None  # the figure is at most this; None: told, not judged
    unit: str
    quoted: str = "-"
    source: str = ISSUE
    stands: bool = False  # what falls misses the limit whatever is measured
    seeds: int = 1
    low: float | None = None  # and at least this; None: its size is at most the limit

    def met(self, value):
        """Return whether a figure is within the limits; NaN is not. Without a limit, every figure is."""
        if self.limit is None:
            return True
        return (-self.limit if self.low is None else self.low) <= value <= self.limit


def _crooked():
    quoted = {
        15: "-",
        20: "Box2D 5/5, Rapier stands, AVBD 3/5",
        40: "Box2D 4/5, Rapier stands, AVBD 0/5",
        80: "Box2D 2/5, Rapier X13, AVBD 0/5",
    }
    for count, peers in quoted.items():
        build, limit = partial(stacks.crooked, count), 2.0 if count == 80 else 1.0
        options = {"stands": True, "seeds": SEEDS, "quoted": peers}
        yield Row(f"crooked_{count}", build, measures.overlap_at_end, limit, "mm", **options)
        yield Row(f"crooked_{count}_sway", build, measures.sway, 30.0, "mm", **options)


def _towers():
    for kind, places, counts in (
        ("offset", stacks.offset_places, (5, 10, 20, 30, 40)),
        ("harmonic", stacks.harmonic_places, (4, 8, 16, 24, 32)),
    ):
        for count in counts:
            inside, outside = places(count, INSIDE), places(count, OUTSIDE)
            yield Row(
                f"{kind}_{count}_in",
                lambda _, at=tuple(inside): stacks.standing(at),
                measures.overlap_at_end,
                None,
                "mm",
                stands=True,
            )
            theory = fall_time(outside)
            yield Row(
                f"{kind}_{count}_out",
                lambda _, at=tuple(outside), most=2.0 * theory: stacks.turning(at, most),
                partial(measures.fall_over_theory, theory=theory),
                LATE,
                "x",
            )
    yield Row(
        "leaning_10",
        lambda _: stacks.standing(stacks.offset_places(10, 0.8)),
        measures.overlap_at_end,
        0.6,
        "mm",
        quoted="Box2D 10.3, Rapier 10.3, AVBD X2.9",
        source=BEST,
        stands=True,
    )


def _ratios():
    for count, ratio, limit, quoted in (
        (1, 100, 1.0, "Box2D 35, Rapier 35, AVBD 0.5"),
        (1, 400, 3.0, "Box2D 142, Rapier 141, AVBD 1.3"),
        (1, 1000, 6.0, "-"),
        (5, 1000, 20.0, "Box2D X1.5, Rapier 923, AVBD 12"),
    ):
        yield Row(
            f"ratio_{ratio}_on_{count}",
            lambda _, count=count, ratio=ratio: stacks.heavy_on(count, ratio, 10.0 if count == 1 else 15.0),
            measures.overlap_at_end,
            limit,
            "mm",
            quoted=quoted,
            stands=True,
        )
    yield Row(
        "heavy_taken_away",
        lambda _: stacks.heavy_taken_away(),
        partial(measures.rise, index=2),
        1.0,
        "mm",
        quoted="Box2D 40, Rapier -1, AVBD 46",
        low=-math.inf,
    )
    yield Row(
        "dropped_300",
        lambda _: stacks.dropped_on_pyramid(300),
        measures.overlap_at_end,
        5.0,
        "mm",
        quoted="Box2D 44, Rapier X0.9, AVBD 18",
        stands=True,
    )


def _piles():
    yield Row(
        "aligned_15",
        lambda _: stacks.aligned(15),
        measures.overlap_at_end,
        0.8,
        "mm",
        quoted="Box2D 9.9, Rapier 9.8, AVBD 0.8",
        source=BEST,
        stands=True,
    )
    awake = partial(stacks.pyramid, 20)
    quoted = "Box2D 3.7, Rapier 3.6, AVBD 1.6"
    yield Row("pyramid_20", lambda _: awake(), measures.overlap_at_end, 0.5, "mm", quoted=quoted, stands=True)
    yield Row(
        "pyramid_20_asleep",
        lambda _: stacks.pyramid(20, sleeping=True),
        measures.asleep_after,
        0.7,
        "s",
        quoted="Box2D 1.45, Rapier 1.05",
    )
    yield Row(
        "pyramid_20_ms",
        lambda _: awake(),
        measures.milliseconds,
        None,
        "ms",
        quoted="Box2D 0.08, Rapier 0.38, AVBD 2.0",
    )
    yield Row(
        "card_house",
        lambda _: structures.card_house(4),
        measures.lean,
        3.3,
        "mm",
        quoted="Box2D 60, Rapier 13, AVBD X1.6",
        source=BEST,
        stands=True,
    )
    yield Row(
        "arch",
        lambda _: structures.arch(),
        measures.overlap_at_end,
        0.75,
        "mm",
        quoted="Box2D 12.4, Rapier 12.4",
        source=BEST,
        stands=True,
    )


def _friction():
    yield Row("plate_slips", lambda _: motions.plate(1.0, motions.PLATE_FRICTION), measures.slips_late, 2.0, "deg")
    yield Row(
        "plate_tips",
        lambda _: motions.plate(2.0, 2.0),
        measures.tips_late,
        4.0,
        "deg",
        quoted="Box2D 9.0, Rapier 8.9, AVBD 2.4",
    )
    yield Row(
        "slope_slides",
        lambda _: motions.slope(0.99, 5.0),
        partial(measures.slide_error, share=0.99),
        0.5,
        "%",
        quoted="Box2D 13, Rapier 0, AVBD 70",
    )
    yield Row("slope_holds", lambda _: motions.slope(1.01, 10.0), measures.creep, 0.01, "mm", quoted="AVBD 437")
    quoted = "Box2D -61, Rapier -80, AVBD 19"
    yield Row("seams", motions.seams, measures.stop_error, 1.0, "%", quoted=quoted, seeds=SEEDS)
    yield Row("seams_hop", motions.seams, measures.hop, 0.1, "mm", seeds=SEEDS)
    yield Row("sliding", lambda _: motions.slide(), measures.stop_error, SLIDING, "%")


def _bounces():
    for name, restitution, seconds, limit, quoted in (
        ("bounce_1", 1.0, 25.0, 1.0, "Box2D -17, Rapier -17 after 20"),
        ("bounce_0.9", 0.9, 15.0, 3.0, "Box2D -59, Rapier -92 after 20"),
    ):
        yield Row(
            name,
            lambda _, e=restitution, s=seconds: motions.bounce(e, s),
            partial(measures.bounce_error, restitution=restitution),
            limit,
            "%",
            quoted=quoted,
        )
    yield Row(
        "oblique_worst",
        lambda _: motions.oblique(),
        measures.oblique_worst,
        0.03,
        "v",
        quoted="Box2D .217, Rapier .217",
    )
    yield Row("oblique_mean", lambda _: motions.oblique(), measures.oblique_mean, 0.006, "v")
    yield Row("free_spin", lambda _: motions.free_spin(), measures.spin_error, EXACT, "%")


def _tumbler():
    for name, measure, limit, unit, quoted in (
        ("tumbler_median", partial(measures.overlap_share, share=50), 13.0, "mm", "Box2D 62, Rapier 61"),
        ("tumbler_p95", partial(measures.overlap_share, share=95), 30.0, "mm", "Box2D 128, Rapier 102"),
        ("tumbler_out", measures.out_of_room, 0.0, "", "-"),
    ):
        yield Row(name, lambda _: motions.tumbler(), measure, limit, unit, quoted=quoted)


@cache
def table():
    """Return {name: row} in the order of the study."""
    groups = (_crooked, _towers, _ratios, _piles, _friction, _bounces, _tumbler)
    return {row.name: row for group in groups for row in group()}
