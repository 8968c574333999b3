"""Chart 14, single questions: two masks, and a ray among many bodies, beside pygame and pymunk.

All ways are asked the same questions and must give the same answers; a difference raises RuntimeError. pymunk's ray is
a segment query. The number of bodies is swept.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from game.measure.timing import timed_in_turns
from game.report.chart import Axis, Panel, panel_is, time, value
from game.report.claim import TIE, Claim, ratio_of, region
from game.report.job import Job, Row, spread
from game.report.pygame_sprites import mask_in_pygame
from game.report.pymunk_piles import library
from game.report.sprites import mask_of
from physics import Circle, Effects, PixelMask, World, collide

MASKS, RAYS = 200, 500  # questions in a run
COUNTS = (100, 1000, 10_000)  # bodies that a ray may hit
RADIUS, SPACING, LENGTH = 6.0, 40.0, 300.0  # [px] of the discs, their mean distance, and the length of a ray
EVEN_PRICE = (0.0, 1.1)  # ratio of times at which a question costs no more than the peer's
MASK_PANEL, RAY_PANEL = "a question: do two masks overlap?", "a question: what does a ray hit first?"
OURS, BATCH, PEER = "ours: ray_cast", "ours: ray_casts, one call", "pymunk: segment_query_first"
PYGAME, COLLIDE, BODIES = "pygame: Mask.overlap", "ours: collide(mask, mask)", "ours: a step of both as bodies"


def measure_masks() -> list[Row]:
    """Return a row for each way to ask whether two upright sprites share a pixel, at whole pixels."""
    made = PixelMask(mask_of("planes", "player").solid, origin=(0, 0))
    mask, chance = mask_in_pygame(made), np.random.default_rng(15)
    width, height = mask.get_size()
    offsets = np.column_stack([chance.integers(-width, width, MASKS), chance.integers(-height, height, MASKS)]).tolist()
    world = World(Effects.detection())
    world.add_body(made, kind="kinematic", tier="pixels")
    other = world.add_body(made, kind="kinematic", tier="pixels")

    def step(offset):
        other.position = offset
        world.step()
        return bool(len(world.touching()))

    ways = {
        PYGAME: lambda offset: mask.overlap(mask, offset) is not None,
        COLLIDE: lambda offset: len(collide(made, (0, 0), made, offset).points) > 0,
        BODIES: step,
    }
    return _rows(
        MASK_PANEL, 2, {name: lambda ask=ask: [ask(each) for each in offsets] for name, ask in ways.items()}, MASKS
    )


def measure_rays(count: int) -> list[Row]:
    """Return a row for each way to ask which of `count` discs a ray hits first. Without pymunk, a row names it."""
    chance = np.random.default_rng(16)
    side = SPACING * count**0.5
    places = chance.uniform(0.0, side, (count, 2))
    starts, angle = chance.uniform(0.0, side, (RAYS, 2)), chance.uniform(0.0, 2.0 * np.pi, RAYS)
    clear = np.array([np.hypot(*(places - start).T).min() > RADIUS for start in starts])  # the ray begins outside
    starts, ways = starts[clear], LENGTH * np.stack([np.cos(angle), np.sin(angle)], axis=1)[clear]
    world = World(Effects.detection())
    world.add_bodies(Circle(RADIUS), places, kind="static")
    world.step()
    asked = list(zip(map(tuple, starts.tolist()), map(tuple, ways.tolist()), strict=True))
    works: dict[str, Callable[[], Sequence[bool]]] = {
        OURS: lambda: [world.ray_cast(start, way) is not None for start, way in asked],
        BATCH: lambda: (world.ray_casts(starts, ways)["body"] >= 0).tolist(),
    }
    missing = ""
    try:
        works[PEER] = _pymunk_rays(places.tolist(), asked)
    except ModuleNotFoundError as error:
        missing = str(error)
    absent = [{"series": PEER, "label": missing, "panel": RAY_PANEL}] if missing else []
    return _rows(RAY_PANEL, count, works, len(asked)) + absent


def _pymunk_rays(places, asked) -> Callable[[], Sequence[bool]]:
    pymunk: Any = library()
    space = pymunk.Space()
    for place in places:
        space.add(pymunk.Circle(space.static_body, RADIUS, place))
    space.step(1.0 / 60.0)
    both, all_of = [(start, (start[0] + way[0], start[1] + way[1])) for start, way in asked], pymunk.ShapeFilter()
    return lambda: [space.segment_query_first(a, b, 0.0, all_of) is not None for a, b in both]


def _rows(panel: str, count: int, works: Mapping[str, Callable[[], Sequence[bool]]], pieces: int) -> list[Row]:
    """Time the ways, and return their rows. works: functions that return the answers; pieces: number of questions.

    Raises RuntimeError if two ways differ in an answer, because their times would mean nothing.
    """
    answers = {name: list(work()) for name, work in works.items()}
    first = next(iter(answers))
    for name, found in answers.items():
        if found != answers[first]:
            differ = sum(a != b for a, b in zip(found, answers[first], strict=True))
            raise RuntimeError(f"{name} and {first} differ in {differ} of {pieces} answers")
    costs = timed_in_turns(works, dict.fromkeys(works, pieces))
    return [
        {
            "series": name,
            "label": f"{name}, {count:,} bodies",
            "panel": panel,
            "n": count,
            "hits": [sum(answers[name]), pieces],
            "cost": spread(cost),
        }
        for name, cost in costs.items()
    ]


def jobs(quick: bool) -> list[Job]:
    """Return the jobs. quick: True asks a ray among 1,000 bodies only."""
    counts = COUNTS[1:2] if quick else COUNTS
    return [
        Job("peers/masks", f"{__name__}:measure_masks", {}, 1.0),
        *(Job(f"peers/rays-{count}", f"{__name__}:measure_rays", {"count": count}, 2.0) for count in counts),
    ]


def claims(rows: Sequence[Row]) -> list[Claim]:
    """Return the claims about the price of a question. rows: rows of the chart."""
    words, found = "no dearer//dearer", []
    masks = {row["series"]: row["cost"] for row in rows if row["panel"] == MASK_PANEL}
    if PYGAME in masks:
        ratios = {name: ratio_of(masks[name], masks[PYGAME]) for name in (COLLIDE, BODIES)}
        found.append(
            region("a question about two masks costs no more than pygame's Mask.overlap", ratios, EVEN_PRICE, words)
        )
    rays = {(row["series"], row["n"]): row["cost"] for row in rows if row["panel"] == RAY_PANEL and "cost" in row}
    for name, text in ((OURS, "a single ray"), (BATCH, "a ray of a batch")):
        ratios = {
            f"{n:,} bodies": ratio_of(rays[name, n], rays[PEER, n])
            for n in COUNTS
            if (name, n) in rays and (PEER, n) in rays
        }
        if ratios:
            found.append(region(f"{text} costs no more than pymunk's", ratios, EVEN_PRICE, words))
    missing = [row["label"] for row in rows if row["panel"] == RAY_PANEL and "cost" not in row]
    return found + [Claim("a ray: beside pymunk", each, TIE) for each in dict.fromkeys(missing)]


def panels() -> list[Panel]:
    """Return the panels: time of a question over the number of bodies."""
    return [
        Panel(name, Axis("bodies", value("n")), Axis("us a question", time("cost")), panel_is(name), line="series")
        for name in (MASK_PANEL, RAY_PANEL)
    ]
