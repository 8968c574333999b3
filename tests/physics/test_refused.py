"""Errors for rejected input that no other test covers: each names the argument, its value and the allowed values."""

import numpy as np
import pytest

import physics
from game.measure.pair_batch import PairBatch
from game.measure.shape_traces import sat_axes
from physics import Character, Circle, Effects, Polygon, TileGrid, World, checks
from physics.jit.plain import view_of
from physics.settings import POSITION_LIMIT

PILES = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True)
TILES = TileGrid(np.ones((1, 1), bool), 16)


def walker():
    world = World(PILES)
    return Character(world, Polygon.box(8, 8), (0, 0)).body


REFUSED = {
    "ids that are no numbers": (TypeError, "rows must be whole numbers (got [0.5])", lambda: checks.ids("rows", [0.5])),
    "an id beyond all": (KeyError, "must be a Body or the id of one", lambda: World(PILES).remove_body(2**62)),
    "places far out": (
        ValueError,
        "positions[0] must lie within",
        lambda: World(PILES).add_bodies(Circle(1), [(POSITION_LIMIT, 0.0)]),
    ),
    "fewer poses": (
        ValueError,
        "poses_b must have as many rows as poses_a, 2 (got 1)",
        lambda: PairBatch([Circle(1)], [(0, 0, 0)] * 2, [Circle(1)], [(0, 0, 0)]),
    ),
    "no shape": (
        TypeError,
        "shapes_a must be shapes such as Circle(8) (got 8)",
        lambda: PairBatch([8], [(0, 0, 0)], [Circle(1)], [(0, 0, 0)]),
    ),
    "axes of tiles": (
        TypeError,
        "shape_a must be a Circle, Capsule, Segment, Polygon or Bounds of one",
        lambda: sat_axes(TILES, (0, 0), Circle(1), (0, 0)),
    ),
    "another shape for a character": (
        ValueError,
        "must stay: it is a Character's, who walks by its shape",
        lambda: walker().set_shapes(Circle(4)),
    ),
    "a piece of no name": (
        KeyError,
        "no piece 'rafts'; there are circles",
        lambda: physics.warmup(PILES, pieces=("rafts",)),
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_it_is_refused_by_name(what):
    kind, told, wrong = REFUSED[what]
    with pytest.raises(kind) as refusal:
        wrong()
    assert told in str(refusal.value)


def test_a_view_knows_its_rows():
    rows = view_of(np.zeros(3, [("x", np.float64)]))
    with pytest.raises(IndexError, match="row 3 of a table of 3"):
        rows[3]
