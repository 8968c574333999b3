"""The report's piles of boxes in pymunk, for comparison.

Without pymunk, a ModuleNotFoundError names the pip extra that installs it.
"""

from typing import Any

from game import startup
from game.report.piles import BOX, FRICTION, GRAVITY, Pile

SLOP = 0.1  # [px] pymunk's default overlap of bodies
ITERATIONS = 10  # pymunk's default


def library() -> Any:
    """Return the module pymunk. If it is missing, raise ModuleNotFoundError, which names the extra that installs it."""
    try:
        import pymunk
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(f"pymunk is not installed; it comes with: {startup.install('bench')}") from error
    return pymunk


def space_of(pile: Pile, iterations: int = ITERATIONS) -> Any:
    """Return a pymunk space with the pile's boxes, all of the same density, on a wide ground.

    iterations: iterations of pymunk's solver.
    """
    pymunk = library()
    space = pymunk.Space()
    space.gravity, space.iterations, space.collision_slop = (0.0, GRAVITY), iterations, SLOP
    width = max(abs(x) for x, _ in pile.places) + 20.0 * BOX
    ground = pymunk.Poly(space.static_body, [(-width, 0), (width, 0), (width, 64), (-width, 64)])
    ground.friction = FRICTION
    space.add(ground)
    for x, y in pile.places:
        body = pymunk.Body(BOX * BOX, pymunk.moment_for_box(BOX * BOX, (BOX, BOX)))
        body.position = x, y
        shape = pymunk.Poly.create_box(body, (BOX, BOX))
        shape.friction = FRICTION
        space.add(body, shape)
    return space


def overlap_in(space: Any) -> float:
    """Return the depth [px] of the deepest contact point that pymunk reports at the current poses."""
    found = 0.0
    for shape in space.shapes:
        if shape.body is not space.static_body:
            for each in space.shape_query(shape):
                found = max([found, *(-point.distance for point in each.contact_point_set.points)])
    return found
