"""Three points of each of five charts of docs/accuracy.md, computed again without any code of this project.

    python -m tests.accuracy.independent

Only NumPy, Shapely and pygame's image loader are used, and the poses come from other random numbers. A point is (its
name, the value in docs/accuracy.json, the value computed here, the greatest difference allowed). Rates are compared by
Wilson's intervals, closed forms to four digits, the precision of the file.
"""

import json
import math
import sys
from collections.abc import Iterator
from functools import cache
from itertools import islice
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pygame
import shapely
from shapely import affinity

ROOT = Path(__file__).resolve().parents[2]
SPRITES = ("gunship_0", "player", "saucer_0")
POSES = 1500
SIGMAS = 3.3  # of an interval: one of a thousand true points lies outside


class Point(NamedTuple):
    """A value of a chart, the value computed here, and the greatest difference allowed."""

    name: str
    kept: float
    here: float
    most: float

    @property
    def agrees(self) -> bool:
        """Return whether the two values differ by at most `most`."""
        return abs(self.kept - self.here) <= self.most


@cache
def kept() -> dict:
    """Return the rows of docs/accuracy.json by chart."""
    return json.loads((ROOT / "docs/accuracy.json").read_text(encoding="utf-8"))["rows"]


def row(chart: str, **values) -> dict:
    """Return the only row of a chart with these column values."""
    (found,) = [each for each in kept()[chart] if all(each.get(name) == value for name, value in values.items())]
    return found


@cache
def pixels(sprite: str) -> np.ndarray:
    """Return the solid pixels of a sprite of the shooter, (rows, columns) bool: those with an alpha over 127."""
    sheet = ROOT / "assets/images/planes.png"
    place = json.loads(sheet.with_suffix(".json").read_text(encoding="utf-8"))["frames"][sprite]
    picture = pygame.image.load(sheet).subsurface((place["x"], place["y"], place["w"], place["h"]))
    return pygame.surfarray.array_alpha(picture).T > 127


@cache
def outline(sprite: str) -> shapely.Geometry:
    """Return the union of the squares of a sprite's pixels, with the origin at the middle of its picture."""
    solid = pixels(sprite)
    height, width = solid.shape
    squares = [shapely.box(x, y, x + 1, y + 1) for y, x in np.argwhere(solid)]
    return affinity.translate(shapely.union_all(squares), -width / 2, -height / 2)


def disc(radius: float) -> shapely.Geometry:
    """Return the union of the squares of the pixels whose centres lie in a disc around the origin."""
    at = np.arange(int(2 * radius)) + 0.5 - radius
    return shapely.union_all(
        [shapely.box(x - 0.5, y - 0.5, x + 0.5, y + 0.5) for x in at for y in at if x * x + y * y <= radius * radius]
    )


def interval(count: int, total: int) -> tuple[float, float]:
    """Return Wilson's interval of a rate of `count` in `total`, as (middle, half width)."""
    z2, share = SIGMAS * SIGMAS, count / total
    middle = (share + z2 / (2 * total)) / (1 + z2 / total)
    half = SIGMAS / (1 + z2 / total) * math.sqrt(share * (1 - share) / total + z2 / (4 * total * total))
    return middle, half


def placed(shape: shapely.Geometry, x: float, y: float, angle: float) -> shapely.Geometry:
    """Return a shape rotated about the origin by an angle [rad] and moved to (x, y) [px]."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return affinity.affine_transform(shape, [cosine, -sine, sine, cosine, x, y])


# ---- charts ----------------------------------------------------------------------------------------------------------


def false_hits(sprite: str) -> dict[str, tuple[int, int]]:
    """Return {tier: (false hits, hits)} of a sprite against itself at random poses.

    The poses are so close that about half of the pairs share area.
    """
    chance, shape = np.random.default_rng(77), outline(sprite)
    circle, hull = shapely.minimum_bounding_circle(shape).centroid, shape.convex_hull
    radius = shapely.minimum_bounding_radius(shape)
    share, way = np.sqrt(chance.random(POSES)), chance.uniform(0, math.tau, POSES)
    turns = chance.uniform(0, math.tau, (2, POSES))

    def meeting(reach):
        for k in range(POSES):
            first = placed(shape, 0.0, 0.0, turns[0, k])
            x, y = reach * share[k] * math.cos(way[k]), reach * share[k] * math.sin(way[k])
            second = placed(shape, x, y, turns[1, k])
            yield first, second, (x, y), (turns[0, k], turns[1, k])

    low, high = 0.0, 4.0 * radius
    for _ in range(7):
        middle = 0.5 * (low + high)
        met = np.mean([first.intersection(second).area > 0.0 for first, second, _, _ in islice(meeting(middle), 300)])
        low, high = (middle, high) if met > 0.5 else (low, middle)
    found = {tier: [0, 0] for tier in ("circle", "aabb", "hull")}
    for first, second, (x, y), (turn_a, turn_b) in meeting(high):
        true = first.intersection(second).area > 0.0
        a, b = placed(circle, 0, 0, turn_a), placed(circle, x, y, turn_b)
        boxes = [shapely.box(*each.bounds) for each in (first, second)]
        said = {
            "circle": a.distance(b) < 2 * radius,
            "aabb": boxes[0].intersects(boxes[1]),
            "hull": placed(hull, 0, 0, turn_a).intersects(placed(hull, x, y, turn_b)),
        }
        for tier, hit in said.items():
            found[tier][1] += hit
            found[tier][0] += hit and not true
    return {tier: (wrong, hits) for tier, (wrong, hits) in found.items()}


def tiers() -> Iterator[Point]:
    """Yield the rates of false hits of three tiers (chart 1). Each tier is tested with another sprite."""
    for tier, sprite in zip(("circle", "aabb", "hull"), SPRITES, strict=True):
        wrong, hits = row("tiers", series=tier, sprite=sprite, panel="poses all around")["wrong"]
        mine = interval(*false_hits(sprite)[tier])
        theirs = interval(wrong, hits)
        yield Point(f"false hits of {tier}, {sprite}", theirs[0], mine[0], math.hypot(theirs[1], mine[1]))


def fits() -> Iterator[Point]:
    """Yield the error in area of three shapes that are fitted to sprites (chart 3).

    The error is the area that only the shape or only the sprite covers, divided by the area of their union.
    """
    for tier, sprite in zip(("circle", "aabb", "hull"), SPRITES, strict=True):
        shape = outline(sprite)
        area = {
            "circle": math.pi * shapely.minimum_bounding_radius(shape) ** 2,
            "aabb": shapely.box(*shape.bounds).area,
            "hull": shape.convex_hull.area,
        }[tier]
        most = 0.01 if tier == "hull" else 2e-4  # a hull keeps sixteen corners
        kept_value = row("tiers", series=tier, sprite=sprite, panel="poses all around")["lost"]
        yield Point(f"lost by {tier}, {sprite}", kept_value, 1.0 - shape.area / area, most)


def contacts() -> Iterator[Point]:
    """Yield errors of normals and depths for two pixel discs with a radius of 12 px (chart 2)."""
    radius, shape, chance = 12.0, disc(12.0), np.random.default_rng(78)
    around = shapely.minimum_bounding_radius(shape)
    name = {"panel": "disc against disc"}
    yield Point(
        "depth by circle", row("contacts", series="circle", **name)["depth_error"][1], 2 * (around - radius), 2e-3
    )
    by_aabb, by_obb = [], []
    while len(by_obb) < 4 * POSES:
        x, y = chance.uniform(-2 * radius, 2 * radius, 2)
        length = math.hypot(x, y)
        if max(abs(x), abs(y)) <= radius or not 0.0 < 2 * radius - length < 0.4 * radius:
            continue
        turns = chance.uniform(0, math.tau, 2)
        boxes = [placed(shape, *at, turn).bounds for at, turn in zip(((0.0, 0.0), (x, y)), turns, strict=True)]
        (ax0, ay0, ax1, ay1), (bx0, by0, bx1, by1) = boxes
        upright = [(ax1 - bx0, (1, 0)), (bx1 - ax0, (-1, 0)), (ay1 - by0, (0, 1)), (by1 - ay0, (0, -1))]
        turned = [way for turn in turns for way in overlaps_of_squares(x, y, turns[1] - turns[0], turn, radius)]
        for ways, errors in ((upright, by_aabb), (turned, by_obb)):
            nx, ny = min(ways)[1]
            errors.append(math.degrees(math.acos(max(-1.0, min(1.0, (nx * x + ny * y) / length)))))
    for series, errors in (("aabb", by_aabb), ("obb", by_obb)):
        wanted = row("contacts", series=series, **name)["normal_error"][1]
        yield Point(f"median error of normals by {series} [degrees]", wanted, float(np.median(errors)), 1.5)


def overlaps_of_squares(x: float, y: float, between: float, turn: float, half: float) -> list:
    """Return [(overlap [px], axis)] of two equal squares along the two axes of one of them.

    Each axis is a unit vector towards the second square. x, y: centre of the second square relative to the first [px];
    between: angle between the squares [rad]; turn: angle of the square whose axes are used [rad]; half: half the width
    of a square [px].
    """
    reach, found = half * (1.0 + abs(math.cos(between)) + abs(math.sin(between))), []
    for nx, ny in ((math.cos(turn), math.sin(turn)), (-math.sin(turn), math.cos(turn))):
        along = nx * x + ny * y
        sign = 1.0 if along >= 0.0 else -1.0
        found.append((reach - abs(along), (sign * nx, sign * ny)))
    return found


def continuous() -> Iterator[Point]:
    """Yield the numbers of discs that pass through a plate if only the poses after each step are tested (chart 6)."""
    radius, width, half, lanes = 5.0, 1.0, 11.0, 1000
    aside = np.random.default_rng(8).uniform(-1.2, 1.2, lanes) * (half + radius)
    for ratio in (1.0, 3.0, 10.0):
        step, missed = ratio * 2 * radius, 0
        meets = np.maximum(np.abs(aside) - half, 0.0) < radius
        for k in np.flatnonzero(meets):
            start = -2 * step - radius - width - step * (k + 0.5) / lanes
            x = start + step * np.arange(1, 8)
            gap = np.hypot(np.maximum(np.abs(x) - width / 2, 0.0), max(abs(aside[k]) - half, 0.0))
            missed += bool((gap > radius).all())
        wanted = row("continuous", series="off", panel="miss", ratio=ratio)["missed"]
        if wanted[1] != meets.sum():
            raise ValueError(f"the chart has {wanted[1]} discs that meet the plate, here are {meets.sum()}")
        yield Point(f"missed at {ratio:g} sizes a step", wanted[0], missed, 0.0)


def integration() -> Iterator[Point]:
    """Yield errors of a first-order integrator (chart 5). The error is half the acceleration times the time step."""
    gravity, slope = 320.0, math.radians(30.0)
    cases = (
        ("free fall", "projection", gravity),
        ("slide down 30 degrees", "sequential_impulse", gravity * (math.sin(slope) - 0.3 * math.cos(slope))),
        ("roll down 30 degrees", "sequential_impulse", gravity * math.sin(slope) * 2.0 / 3.0),
    )
    for panel, series, acceleration in cases:
        label = f"{series}, 60 steps a second"
        wanted = row("integration", panel=panel, series=series, label=label)["error"]
        yield Point(f"{panel}, {series}", wanted, 0.5 * acceleration / 60.0, 2e-3 * wanted)


CHARTS = {"tiers": tiers, "fit": fits, "contacts": contacts, "continuous": continuous, "integration": integration}


def main() -> int:
    """Print all points. Return 1 if a point does not agree, else 0."""
    wrong = 0
    for name, chart in CHARTS.items():
        for point in chart():
            wrong += not point.agrees
            sys.stdout.write(
                f"{'ok  ' if point.agrees else 'FAIL'} {name}: {point.name}: {point.kept:.4g} in the report, "
                f"{point.here:.4g} here, at most {point.most:.2g} apart\n"
            )
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
