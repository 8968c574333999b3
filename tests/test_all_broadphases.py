"""A world that compares all broad phases gives the results of a normal one, and names a wrong
broad phase and the pair.
"""

import copy

import numpy as np
import pytest

from physics import BROADPHASES, Circle, Effects, Polygon, World
from tests.all_broadphases import StrategiesDisagree, asking_all, scene_asking_all
from tests.game.arena import Arena

STRATEGIES = [*BROADPHASES]


def crowd(strategy, seed=1, effects=None):
    """Return a world of flying discs and boxes that collide, whose broad phase compares itself with the others."""
    rng = np.random.default_rng(seed)
    world = World(effects or Effects(response=True, rotation=True), asking_all(BROADPHASES[strategy]()), gravity=(0, 0))
    for k in range(40):
        shape = Circle(float(rng.uniform(2, 12))) if k % 2 else Polygon.box(*rng.uniform(4, 20, 2).tolist())
        world.add_body(shape, position=rng.uniform(0, 160, 2).tolist(), velocity=rng.uniform(-90, 90, 2).tolist())
    return world


def miss(query):
    """Return a query that omits the last pair."""
    return lambda pairs, work: max(0, query(pairs, work) - 1)


def twice(query):
    """Return a query that reports the first pair twice, in place of the last."""

    def wrong(pairs, work):
        count = query(pairs, work)
        if 1 < count <= len(pairs):
            pairs[count - 1] = pairs[0]
        return count

    return wrong


def too_many(query):
    """Return a query that reports one pair too many."""

    def wrong(pairs, work):
        count = query(pairs, work)
        if count < len(pairs):
            pairs[count] = (0, 0)
        return count + 1

    return wrong


@pytest.mark.parametrize("effects", [Effects(), Effects(response=True, rotation=True), Effects.rigid_bodies()])
@pytest.mark.parametrize("strategy", STRATEGIES)
def test_a_world_that_asks_all_goes_on_as_under_one(strategy, effects):
    world, plain = crowd(strategy, effects=effects), crowd(strategy, effects=effects)
    plain.broadphase = BROADPHASES[strategy]()
    met = 0
    for step in range(120):
        for each in (world, plain):
            if step == 30:
                each.remove_bodies([3, 4, 5])
            if step == 60:
                each.add_body(Polygon.box(300, 4), position=(80, 200), kind="static")
            each.step()
            each.query_aabb((20, 20), (90, 70))
        assert world.digest() == plain.digest()
        met += len(world.contacts)
    assert met > 0 and world.profile.counters == plain.profile.counters, "what the others count is not the world's"


@pytest.mark.parametrize("wrong", [miss, twice, too_many])
@pytest.mark.parametrize("used", STRATEGIES)
@pytest.mark.parametrize("errs", STRATEGIES)
def test_a_strategy_that_errs_is_named_with_the_pair(errs, used, wrong, monkeypatch):
    world = crowd(used)
    world.step()
    query = BROADPHASES[errs].query
    monkeypatch.setattr(BROADPHASES[errs], "query", lambda strategy, arena: wrong(query(strategy, arena)))
    with pytest.raises(StrategiesDisagree, match=rf"\w+ finds \d+ pairs, {used} \d+: only \w+ \["):
        for _ in range(30):
            world.step()


@pytest.mark.parametrize("used", STRATEGIES)
@pytest.mark.parametrize("errs", STRATEGIES)
def test_a_strategy_that_misses_a_box_in_a_query_is_named(errs, used, monkeypatch):
    world = crowd(used)
    world.step()
    near = BROADPHASES[errs].query_box
    monkeypatch.setattr(BROADPHASES[errs], "query_box", lambda *asked: near(*asked) - 1)
    with pytest.raises(StrategiesDisagree, match=rf"slots near .*, {used} \d+: only"):
        for x in range(20, 160, 20):
            world.query_aabb((x - 30, 0), (x, 160))


@pytest.mark.parametrize("used", STRATEGIES)
def test_a_world_and_its_copies_keep_asking(used, monkeypatch):
    """A world still compares all broad phases after it is copied or restored, and when its effects or broad phase
    change.
    """
    world = crowd(used, effects=Effects.rigid_bodies())
    world.step()
    before = world.snapshot()
    world.step()
    copied = copy.deepcopy(world)
    world.restore(before)
    world.set_effects(world.effects.with_(sleeping=False))
    scene = scene_asking_all(Arena)(seed=1, broadphase=used)
    switched = scene_asking_all(Arena)(seed=1)
    switched.change("broadphase", used)
    for each in (scene, switched):
        assert [w.broadphase.name for w in each.worlds] == [used] and len(each.world.broadphase.others) == 3
    for each in (world, copied):
        each.step()
        assert each.broadphase.name == used and len(each.broadphase.others) == 3
    errs = next(name for name in STRATEGIES if name != used)
    query = BROADPHASES[errs].query
    monkeypatch.setattr(BROADPHASES[errs], "query", lambda strategy, arena: miss(query(strategy, arena)))
    for each in (world, copied):
        with pytest.raises(StrategiesDisagree):
            for _ in range(30):
                each.step()
