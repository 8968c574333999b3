"""Counts against the reference tier equal those of single calls of collide() on every pair, in the shooter."""

from itertools import combinations

import pytest

import physics
from game.measure.reference_tier import ReferenceTier
from game.run.session import Session
from game.run.sources import BotSource
from physics import TIERS, collide, fit
from tests.lockstep import make_scene

QUIET, ASKED = 500, 6  # steps before anything is asked; moments then
pytestmark = pytest.mark.skipif(not physics.JIT, reason="hundreds of steps of a whole game")


def slow_verdict(bodies, filters, tier):
    """Return the set of id pairs that collide at a tier. Every pair is tested.

    filters: {id: (category, mask)}.
    """
    shapes = {body.id: fit(body.shapes[0], tier) if body.tier else body.shapes for body in bodies}
    met = set()
    for a, b in combinations(bodies, 2):
        (own, others), (theirs, ours) = filters[a.id], filters[b.id]
        if not own & ours or not theirs & others or a.sensor or b.sensor:
            continue
        poses = [(body.position.x, body.position.y, body.angle) for body in (a, b)]
        found = [collide(s, poses[0], t, poses[1]) for s in shapes[a.id] for t in shapes[b.id]]
        if any(len(each) and min(each.separations.tolist()) <= 0.0 for each in found):
            met.add((a.id, b.id))
    return met


@pytest.fixture(scope="module")
def asked():
    """Return (reference, {tier: (hits, wrong, missed)}) after some moments of the shooter.

    reference: the ReferenceTier that counted at these moments. The numbers in the dict come from tests of every pair at
    the same moments.
    """
    scene = make_scene("shooter")
    session, reference = Session(scene, BotSource()), ReferenceTier("aabb")
    met = {tier: set() for tier in TIERS}
    for _ in range(QUIET):
        session.step()
    while reference.moments < ASKED:
        bodies = list(scene.world)
        filters = {body.id: (body.filter.membership, body.filter.mask) for body in bodies}
        for tier in TIERS:
            met[tier] |= slow_verdict(bodies, filters, tier)
        while not reference.ask(scene.world):
            session.step()  # the moment that is being judged stays as it was taken
        session.step()
        while not len(scene.world.contacts):
            session.step()
    true = met["mask"]
    return reference, {tier: (len(hits), len(hits - true), len(true - hits)) for tier, hits in met.items()}


def test_every_tier_is_counted_as_a_slow_look_counts(asked):
    reference, counts = asked
    for tier in reference.tiers:
        wrong, missed = reference.wrong[tier], reference.missed[tier]
        assert (wrong.total, wrong.count, missed.count) == counts[tier], tier
    assert set(reference.tiers) == set(TIERS) - {"mask"} and reference.wrong["circle"].count > 0


def test_what_the_lit_tier_reported_wrongly_is_there_to_be_drawn():
    scene = make_scene("shooter")
    session, reference = Session(scene, BotSource()), ReferenceTier("circle")
    for _ in range(QUIET):
        session.step()
    before = 0
    for _ in range(900):
        session.step()
        if reference.ask(scene.world):
            wrong = reference.wrong["circle"].count - before
            drawn = sum(false_hit for false_hit, _ in reference.seen)
            assert drawn >= wrong and all(outlines for _, outlines in reference.seen), (
                "a pair is drawn as often as seen"
            )
            before += wrong
    assert before > 0
