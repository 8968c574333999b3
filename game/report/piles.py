"""Piles of bodies whose correct behaviour is known: the bodies do not move and do not overlap."""

from collections.abc import Callable, Sequence
from math import atan2, cos, radians, sin
from typing import NamedTuple

import numpy as np

from physics import Capsule, Circle, Effects, Material, Polygon, World
from physics.annotations import SolverName, Substeps

BOX, GRAVITY, FRICTION = 32.0, 320.0, 0.6  # [px], [px/s2], -
EFFECTS = Effects(response=True, gravity=True, rotation=True, friction=True, restitution=True, stacking=True)
SHARED = 0.25  # overlap of neighbours in a pile that starts with overlaps, as a share of a box
CARD, THICK, LEAN, PLANK = 48.0, 2.0, radians(25.0), 4.0  # [px] between a card's ends, their radius; [px] of a plank


class Pile(NamedTuple):
    """A pile: positions [px], densities, shapes and angles [rad] of its bodies.

    rests: whether the bodies should remain at rest.
    """

    places: list[tuple[float, float]]
    density: list[float]
    shapes: Sequence[Circle | Capsule | Polygon]
    angles: list[float]
    rests: bool = True

    @property
    def height(self) -> float:
        """Height of the highest body's position above the ground [px]."""
        return -min(y for _, y in self.places)


def boxes(places: list[tuple[float, float]], density: Sequence[float] = (), size: float = BOX) -> Pile:
    """Return a pile of upright boxes at the positions `places` [px]. size: side of each box [px].

    density: density of each box; if empty, every density is 1.
    """
    count = len(places)
    return Pile(places, list(density) or [1.0] * count, [Polygon.box(size, size)] * count, [0.0] * count)


def stack(count: int, size: float = BOX) -> Pile:
    """Return a column of `count` boxes. size: side of each box [px]."""
    return boxes([(0.0, -size / 2 - size * k) for k in range(count)], size=size)


def pyramid(rows: int, across: float = 1.1, up: float = 1.0) -> Pile:
    """Return a pyramid of boxes with `rows` rows. Each row has one box fewer than the row below it.

    across, up: horizontal and vertical distance between the centres of neighbours, in box sizes.
    """
    return boxes(
        [
            ((column - (rows - row - 1) / 2) * across * BOX, -BOX / 2 - up * BOX * row)
            for row in range(rows)
            for column in range(rows - row)
        ]
    )


def heavy(ratio: float) -> Pile:
    """Return a column of two boxes. The density of the upper box is `ratio` times that of the lower box."""
    return boxes(stack(2).places, [1.0, ratio])


def crooked(count: int, seed: int = 1, aside: float = 0.64) -> Pile:
    """Return a column of `count` boxes. Each box is shifted sideways by a random distance of at most `aside` [px].

    The default of `aside` corresponds to 2 cm.
    """
    shifts = np.random.default_rng(seed).uniform(-aside, aside, count)
    return boxes([(float(shifts[k]), -BOX / 2 - BOX * k) for k in range(count)])


def card_house(storeys: int) -> Pile:
    """Return a card house with `storeys` storeys.

    Pairs of cards lean against each other and support planks, as in lab/card_house.
    """
    reach, rise = CARD * sin(LEAN), CARD * cos(LEAN)
    apart, storey = 2.0 * (reach + 2.0 * THICK) + 1.0, rise + 2.0 * THICK + PLANK
    card, plank = Capsule((-CARD / 2, 0), (CARD / 2, 0), THICK), Polygon.box(apart - 0.5, PLANK)
    places, shapes, angles = [], [], []
    for level in range(storeys):
        pairs, foot = storeys - level, -storey * level
        left = -(pairs - 1) * apart / 2
        for side in (-1, 1):
            places += [(left + k * apart + side * (THICK + reach / 2), foot - THICK - rise / 2) for k in range(pairs)]
            angles += [atan2(-rise, -side * reach)] * pairs
        places += [(left + (k + 0.5) * apart, foot - rise - 2.0 * THICK - PLANK / 2) for k in range(pairs - 1)]
        angles += [0.0] * (pairs - 1)
        shapes += [card] * (2 * pairs) + [plank] * (pairs - 1)
    return Pile(places, [1.0] * len(places), shapes, angles)


PILES: dict[str, Callable[[], Pile]] = {
    "stack of 10": lambda: stack(10),
    "stack of 15": lambda: stack(15),
    "crooked 20": lambda: crooked(20),
    "pyramid of 20 rows": lambda: pyramid(20),
    "10:1": lambda: heavy(10.0),
    "100:1": lambda: heavy(100.0),
    "1000:1": lambda: heavy(1000.0),
    "card house": lambda: card_house(4),
    "ten in each other": lambda: pyramid(4, 1.0 - SHARED, 1.0 - SHARED)._replace(rests=False),
}


def world_of(
    pile: Pile, solver: SolverName, substeps: Substeps, effects: Effects = EFFECTS, away: float = 0.0
) -> World:
    """Return a world with the pile on a wide ground.

    solver, substeps, effects: settings of the world; away: x and y of the pile's origin [px].
    """
    world = World(effects, solver=solver, gravity=(0.0, GRAVITY), substeps=substeps)
    places = np.array(pile.places) + away
    width = float(np.ptp(places[:, 0])) + 40.0 * BOX
    ground = Polygon.box(width, 64.0, center=(0.0, 32.0))
    world.add_body(ground, position=(away, away), kind="static", material=Material(friction=FRICTION))
    kinds = [(id(shape), density) for shape, density in zip(pile.shapes, pile.density, strict=True)]
    for kind in dict.fromkeys(kinds):
        chosen = [k for k, each in enumerate(kinds) if each == kind]
        world.add_bodies(
            pile.shapes[chosen[0]],
            places[chosen],
            angles=[pile.angles[k] for k in chosen],
            material=Material(friction=FRICTION, density=kind[1]),
        )
    return world


def overlap(world: World) -> float:
    """Return the depth of the deepest contact [px]."""
    found = world.contacts["separation"]
    return max(0.0, -float(found.min())) if len(found) else 0.0


def sunk(world: World, pile: Pile) -> float:
    """Return how far the highest centre of mass has fallen from its initial height [px]; negative if it has risen."""
    return pile.height + float(world.bodies["center_y"][1:].min())


def energy(world: World) -> float:
    """Return the kinetic and potential energy of all bodies, relative to the ground [mass px2/s2]."""
    rows = world.bodies[1:]
    moving = rows["mass"] * (rows["vx"] ** 2 + rows["vy"] ** 2) + rows["inertia"] * rows["angular_velocity"] ** 2
    return float((0.5 * moving - rows["mass"] * GRAVITY * rows["center_y"]).sum())
