"""Piles whose rest is known in closed form: how high they stand, and that nothing in them overlaps."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from physics import Effects, Material, Polygon, World

BOX, GRAVITY, FRICTION = 32.0, 320.0, 0.6  # [px], [px/s2], -
EFFECTS = Effects(response=True, gravity=True, rotation=True, friction=True, restitution=True, stacking=True)


class Pile(NamedTuple):
    """Boxes of one size, where they stand, and of what density each is."""

    places: list[tuple[float, float]]
    density: list[float]

    @property
    def height(self) -> float:
        """Of the highest box's centre over the ground [px]."""
        return -min(y for _, y in self.places)


def stack(count: int) -> Pile:
    """One upon the other."""
    return Pile([(0.0, -BOX / 2 - BOX * k) for k in range(count)], [1.0] * count)


def pyramid(rows: int) -> Pile:
    """Rows that grow shorter."""
    places = [
        ((column - (rows - row - 1) / 2) * 1.1 * BOX, -BOX / 2 - BOX * row)
        for row in range(rows)
        for column in range(rows - row)
    ]
    return Pile(places, [1.0] * len(places))


def heavy(ratio: float) -> Pile:
    """One of so many times the density on a light one."""
    return Pile(stack(2).places, [1.0, ratio])


def crooked(count: int, seed: int = 1, aside: float = 0.64) -> Pile:
    """A stack whose boxes stand by up to aside [px] beside the middle: 2 cm."""
    shifts = np.random.default_rng(seed).uniform(-aside, aside, count)
    return Pile([(float(shifts[k]), -BOX / 2 - BOX * k) for k in range(count)], [1.0] * count)


PILES: dict[str, Callable[[], Pile]] = {
    "stack of 10": lambda: stack(10),
    "stack of 15": lambda: stack(15),
    "crooked 20": lambda: crooked(20),
    "pyramid of 20 rows": lambda: pyramid(20),
    "10:1": lambda: heavy(10.0),
    "100:1": lambda: heavy(100.0),
    "1000:1": lambda: heavy(1000.0),
}


def world_of(pile: Pile, solver: str, substeps: int | str, effects: Effects = EFFECTS, away: float = 0.0) -> World:
    """The pile on a wide ground. away: how far from the origin, both ways [px]."""
    world = World(effects, solver=solver, gravity=(0.0, GRAVITY), substeps=substeps)
    places = np.array(pile.places) + away
    width = float(np.ptp(places[:, 0])) + 40.0 * BOX
    ground = Polygon.box(width, 64.0, center=(0.0, 32.0))
    world.add_body(ground, position=(away, away), kind="static", material=Material(friction=FRICTION))
    for density in dict.fromkeys(pile.density):
        chosen = [k for k, each in enumerate(pile.density) if each == density]
        world.add_bodies(Polygon.box(BOX, BOX), places[chosen], material=Material(friction=FRICTION, density=density))
    return world


def overlap(world: World) -> float:
    """The deepest that contacts tell [px]."""
    found = world.contacts["separation"]
    return max(0.0, -float(found.min())) if len(found) else 0.0
