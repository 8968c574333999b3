"""Chart 14, single questions: all ways give the same answers, and their price is judged over the number of bodies."""

import pytest

from game.report.charts import peer_queries, peers
from game.report.claim import FAILS, HOLDS, PART
from game.report.plots import dots_of


def test_all_ways_agree_about_masks():
    rows = peer_queries.measure_masks()
    assert {row["series"] for row in rows} == {peer_queries.PYGAME, peer_queries.COLLIDE, peer_queries.BODIES}
    assert len({tuple(row["hits"]) for row in rows}) == 1 and 50 < rows[0]["hits"][0] < peer_queries.MASKS


@pytest.mark.parametrize("missing", [False, True])
def test_all_ways_agree_about_rays_and_a_missing_pymunk_is_named(missing, monkeypatch):
    if missing:
        monkeypatch.setitem(__import__("sys").modules, "pymunk", None)
    else:
        pytest.importorskip("pymunk")
    rows = peer_queries.measure_rays(100)
    asked = [row for row in rows if "cost" in row]
    assert len(asked) == 3 - missing and len({tuple(row["hits"]) for row in asked}) == 1 and asked[0]["hits"][0] > 100
    assert [row["label"] for row in rows if "pymunk is not installed" in row["label"]] == [
        row["label"] for row in rows if "cost" not in row
    ]
    panel = next(panel for panel in peers._panels(rows) if panel.title == peer_queries.RAY_PANEL)
    assert len(dots_of(panel, rows)) == len(asked)
    named = [claim for claim in peers._claims(rows) if "pymunk is not installed" in claim.figure]
    assert len(named) == missing


def test_ways_that_answer_differently_are_not_compared():
    with pytest.raises(RuntimeError, match="b and a differ in 1 of 2 answers"):
        peer_queries._rows("p", 1, {"a": lambda: [True, True], "b": lambda: [True, False]}, 2)


def row(panel, series, n, us):
    return {"panel": panel, "series": series, "n": n, "cost": {"seconds": [1e-6 * us] * 3}}


@pytest.mark.parametrize(
    "ours, verdict, figure",
    [
        ((1.0, 1.0), HOLDS, "no dearer at 100 bodies, 1,000 bodies (0.5 x)"),
        ((1.0, 30.0), PART, "no dearer at 100 bodies (0.5 x); dearer at 1,000 bodies (15 x)"),
        ((30.0, 500.0), FAILS, "dearer at 100 bodies, 1,000 bodies (15 to 250 x)"),
    ],
)
@pytest.mark.parametrize("way", [peer_queries.OURS, peer_queries.BATCH])
def test_the_price_of_a_ray_is_judged_over_the_number_of_bodies(way, ours, verdict, figure):
    rows = [row(peer_queries.RAY_PANEL, peer_queries.PEER, n, 2.0) for n in (100, 1000)]
    rows += [row(peer_queries.RAY_PANEL, way, n, us) for n, us in zip((100, 1000), ours, strict=True)]
    (claim,) = peers._claims(rows)
    assert (claim.verdict, claim.figure) == (verdict, figure)


def test_a_question_about_masks_is_judged_beside_pygame():
    costs = {peer_queries.PYGAME: 0.2, peer_queries.COLLIDE: 100.0, peer_queries.BODIES: 60.0}
    (claim,) = peers._claims([row(peer_queries.MASK_PANEL, name, 2, us) for name, us in costs.items()])
    assert claim.verdict == FAILS and "(300 to 500 x)" in claim.figure
