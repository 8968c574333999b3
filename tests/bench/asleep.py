"""Time of a step with 100,000 sleeping boxes, and with one body awake among them, relative to a step of an empty
world.
"""

import statistics
from time import perf_counter

import numpy as np

from physics import Circle, Polygon, World

BOXES, SIZE, STEPS = 100_000, 16.0, 300
HIGH = 10  # boxes of a stack


def empty() -> World:
    """Return a world with the default effects and no body."""
    return World()


def apart(count: int) -> World:
    """Return a world with `count` boxes that lie apart from each other on a wide floor."""
    return _boxes(count, 1)


def stacked(count: int) -> World:
    """Return a world with `count` boxes in stacks of ten."""
    return _boxes(count, HIGH)


def _boxes(count, high):
    world = World()
    columns = count // high
    wide = int(np.ceil(np.sqrt(columns)))
    x, y = np.arange(columns) % wide * 3.0 * SIZE, np.arange(columns) // wide * (high + 3.0) * SIZE
    for row in range(int(np.ceil(columns / wide))):
        floor = Polygon.box(3.0 * SIZE * (wide + 1), SIZE)
        world.add_body(floor, position=(1.5 * SIZE * wide, row * (high + 3.0) * SIZE + SIZE), kind="static")
    for level in range(high):
        world.add_bodies(Polygon.box(SIZE, SIZE), np.column_stack([x, y - SIZE * level]))
    return world


def put_to_sleep(world: World, most: int = 400) -> int:
    """Step until all bodies sleep, and return the number of steps.

    Raises RuntimeError if a body is awake after `most` steps.
    """
    for number in range(most):
        world.step()
        if not world.awake.dynamic.size:
            return number + 1
    raise RuntimeError(f"{world.awake.dynamic.size} bodies are awake after {most} steps")


def median_steps(worlds: dict, steps: int = STEPS) -> dict:
    """Return {name: median time of a step [ms]}; the worlds {name: world} are stepped in turns."""
    spent = {name: [] for name in worlds}
    for _ in range(steps):
        for name, world in worlds.items():
            started = perf_counter()
            world.step()
            spent[name].append(1e3 * (perf_counter() - started))
    return {name: statistics.median(each) for name, each in spent.items()}


def measure(count: int = BOXES, steps: int = STEPS) -> dict:
    """Measure a step with no body awake and with one, as multiples of a step of an empty world.

    Returns {layout: {"none": multiple, "one": multiple, "empty_ms": time of the empty world's step}}.
    """
    found = {}
    for name, build in (("apart", apart), ("stacked", stacked)):
        world = build(count)
        put_to_sleep(world)
        blank = empty()
        none = median_steps({"empty": blank, "full": world}, steps)
        world.add_body(Circle(4.0), position=(-1e4, 0.0), velocity=(20.0, 0.0), gravity_scale=0.0)
        one = median_steps({"empty": blank, "full": world}, steps)
        found[name] = {
            "none": none["full"] / none["empty"],
            "one": one["full"] / one["empty"],
            "empty_ms": none["empty"],
        }
    return found


def main():
    """Measure, and print the multiples."""
    for name, row in measure().items():
        print(
            f"{BOXES} boxes asleep, {name:8} an empty world's step is {row['empty_ms']:.3f} ms; "
            f"none awake {row['none']:.2f} x, one awake {row['one']:.2f} x"
        )


if __name__ == "__main__":
    main()
