"""Charts 1 and 3: cost per pair, error rate, memory and fit of each tier (kind of collision shape) of a sprite.

Two sets of relative poses are measured, because all rates depend on the share of hits and on their depth. In the first
set, the second sprite is anywhere around the first, and about half of the poses are hits. In the second set, the
sprites are within two pixels of touching, where tiers differ.
"""

from collections.abc import Sequence

import numpy as np

from game.measure.rates import Rate
from game.measure.tiers import Poses, TierFigures, measure_at, poses_around
from game.report.chart import Axis, Chart, Panel, panel_is, percent, time, value
from game.report.charts import tier_steps
from game.report.claim import FAILS, HOLDS, TIE, Claim, ordering, pair
from game.report.job import Job, ReportScope, Row, counted, spread
from game.report.sprites import FEW, SPRITES, mask_of
from physics import PixelMask, distance, fit

BAND = 2.0  # [px] apart or deep: where tiers differ
VISIBLE = 1.0  # [px]
TRIED, TRIED_QUICK = 2000, 500  # random poses, of which those within the band are used
LEAST_EACH = 20  # least number of hits, and of misses, in a set of poses
AROUND, NEAR = "poses all around", "within 2 px of touching"


def poses_near(first: PixelMask, second: PixelMask, tried: int) -> Poses:
    """Return random poses of two sprites (PixelMasks) that are nearly touching.

    The sprites are less than BAND apart, or overlap by less than BAND, by the exact distance. tried: number of poses
    that are drawn; those outside the band are discarded. Raises ValueError if fewer than LEAST_EACH hits or misses are
    left.
    """
    poses = poses_around(first, second, tried, seed=1)
    a, b = fit(first, "mask")[0], fit(second, "mask")[0]
    gaps = np.array(
        [distance(a, tuple(p), b, tuple(q)).distance for p, q in zip(*map(np.ndarray.tolist, poses[:2]), strict=True)]
    )
    near = np.abs(gaps) < BAND
    found = Poses(poses.first[near], poses.second[near], poses.met[near])
    hits = int(found.met.sum())
    if min(hits, len(found.met) - hits) < LEAST_EACH:
        raise ValueError(f"too few poses near touching: {hits} hits of {len(found.met)}")
    return found


def measure(atlas: str, name: str, tried: int) -> list[Row]:
    """Return the rows of a sprite: one for each tier (kind of collision shape) and each of the two sets of poses.

    The sprite is tested against a copy of itself. atlas: name of the sprite's atlas; name: name of the sprite in the
    atlas; tried: see poses_near().
    """
    mask, rows = mask_of(atlas, name), []
    for panel, poses in ((AROUND, poses_around(mask, mask)), (NEAR, poses_near(mask, mask, tried))):
        measure_at(mask, mask, poses, lambda figures, panel=panel: rows.append(_row(name, panel, figures)))
    return rows


def _row(name, panel, figures: TierFigures) -> Row:
    fitted = figures.fit
    return {
        "series": figures.tier,
        "label": f"{figures.tier}, {name}",
        "panel": panel,
        "sprite": name,
        "shapes": figures.shapes,
        "wrong": counted(figures.wrong),
        "missed": counted(figures.missed),
        "bytes": fitted.bytes,
        "lost": 1.0 - fitted.iou,
        "hausdorff": fitted.hausdorff,
        "area_error": fitted.area_error,
        "center_error": fitted.center_error,
        "inertia_error": fitted.inertia_error,
        "hit_cost": spread(figures.hit),
        "miss_cost": spread(figures.miss),
        "build_cost": spread(figures.build),
    }


def _jobs(scope: ReportScope) -> list[Job]:
    chosen, tried = (FEW, TRIED_QUICK) if scope.quick else (SPRITES, TRIED)
    return [
        Job(
            f"tiers/{name}",
            f"{__name__}:measure",
            {"atlas": atlas, "name": name, "tried": tried},
            4.0 if scope.quick else 15.0,
        )
        for atlas, name in chosen
    ] + tier_steps.jobs(scope)


def _claims(rows: Sequence[Row]) -> list[Claim]:
    found = tier_steps.claims(rows)
    for sprite in dict.fromkeys(row["sprite"] for row in rows if row["panel"] == AROUND):
        mine = [row for row in rows if row["panel"] == AROUND and row["sprite"] == sprite]
        for kind in ("hit", "miss"):
            costs = {row["series"]: pair(row[f"{kind}_cost"]) for row in mine}
            found.append(ordering(f"{sprite}, a {kind}", costs, 1e9, "ns"))
    boxes = [Rate(*row["wrong"]) for row in rows if row["series"] == "aabb" and row["panel"] == AROUND]
    if boxes:
        wrong = Rate(sum(rate.count for rate in boxes), sum(rate.total for rate in boxes))
        low, high = wrong.interval
        found.append(
            Claim(
                "boxes say hit where pixels do not",
                f"{100 * wrong.share:.1f} % of their hits ({100 * low:.1f} to {100 * high:.1f})",
                HOLDS if low > 0.0 else FAILS,
                "why pygame.mask exists",
            )
        )
    return found


def _fit_claims(rows: Sequence[Row]) -> list[Claim]:
    """Return claims about the tiers that fit every sprite within a pixel: the least memory, and the fastest to build.

    A tier is a kind of collision shape. rows: rows of the chart.
    """
    rows = [row for row in rows if row["panel"] == AROUND]
    fits = {}
    for row in rows:
        fits.setdefault(row["series"], []).append(row["hausdorff"])
    close = [tier for tier, found in fits.items() if max(found) <= VISIBLE]
    if len(close) < 2:
        return []
    weights = {tier: sum(row["bytes"] for row in rows if row["series"] == tier) for tier in close}
    ordered = sorted(weights, key=lambda tier: weights[tier])
    found = [
        Claim(
            f"of what fits every sprite within a pixel, {ordered[0]} is the lightest",
            ", ".join(f"{tier} {weights[tier] / 1024.0:.3g} kB" for tier in ordered)
            + f" ({len(fits[ordered[0]])} sprites)",
            HOLDS if weights[ordered[0]] < weights[ordered[1]] else TIE,
        )
    ]
    for sprite in dict.fromkeys(row["sprite"] for row in rows):
        costs = {
            row["series"]: pair(row["build_cost"]) for row in rows if row["sprite"] == sprite and row["series"] in close
        }
        found.append(ordering(f"{sprite}, to be made within a pixel", costs))
    return found


def _rates(kind, wrong, word, panel):
    return Panel(
        f"{word}, {panel}",
        Axis(f"ns per pair that is a {kind}", time(f"{kind}_cost", "ns")),
        Axis(f"{word} [%]", percent(wrong), log=False),
        panel_is(panel),
        "medians",
    )


_built = panel_is(AROUND)  # memory and fit do not depend on the poses
CHART = Chart(
    1,
    "tiers",
    "Tiers: wrong verdicts over the time of a pair",
    "How often does a cheaper shape report a false hit or miss a true one, and how much time does it save?",
    "the exact test of the sprites' pixel squares at their poses, rotated and between pixels",
    tuple(
        _rates(kind, wrong, word, panel)
        for panel in (AROUND, NEAR)
        for kind, wrong, word in (("hit", "wrong", "wrong hits"), ("miss", "missed", "missed hits"))
    )
    + tier_steps.STEP_PANELS,
    _jobs,
    _claims,
)
FIT_CHART = Chart(
    3,
    "fit",
    "Tiers: memory and fit",
    "How close is a shape, for its bytes and its time to build?",
    "the union of the sprite's pixel squares; areas, centres, moments and distances by exact geometry",
    (
        Panel(
            "area not shared",
            Axis("bytes", value("bytes")),
            Axis("1 - IoU [%]", value("lost", 100.0)),
            _built,
            "medians",
        ),
        Panel(
            "area not shared", Axis("us to make", time("build_cost")), Axis("1 - IoU [%]", value("lost", 100.0)), _built
        ),
        Panel(
            "largest distance",
            Axis("bytes", value("bytes")),
            Axis("Hausdorff [px]", value("hausdorff"), mark=1.0),
            _built,
        ),
        Panel(
            "centre of area",
            Axis("bytes", value("bytes")),
            Axis("off by [px]", value("center_error"), mark=1.0),
            _built,
        ),
        Panel(
            "moment of inertia",
            Axis("bytes", value("bytes")),
            Axis("off by [%]", value("inertia_error", 100.0)),
            _built,
        ),
    ),
    lambda scope: [],
    _fit_claims,
    of="tiers",
)
