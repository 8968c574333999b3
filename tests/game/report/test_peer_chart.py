"""Chart 14: every program plays the same frames with correct hits, and engines are compared at equal overlap."""

import numpy as np
import pytest

from game.measure.timing import Cost
from game.report.charts import peers
from game.report.claim import HOLDS, TIE
from game.report.plots import dots_of
from game.report.pygame_sprites import BEST, FASTEST, FRAMES, MOVE, PLAIN, RECIPE, STEP, WAYS, Traffic, programs

EXACT = (PLAIN, BEST, "pygame: groupcollide", STEP, MOVE, RECIPE, "ours: step, tree")


@pytest.fixture(scope="module")
def traffic():
    return Traffic(60)


def test_the_path_is_closed_and_no_step_is_longer_than_the_fastest(traffic):
    places = [*traffic.arrays, traffic.arrays[0]]
    steps = np.abs(np.diff(places, axis=0))
    assert len(traffic.arrays) == FRAMES and steps.max() == FASTEST and (steps.max(axis=(1, 2)) > 0).all()


@pytest.mark.parametrize("name", sorted(WAYS))
def test_a_program_finds_the_hits_of_every_frame(traffic, name):
    """Each program finds the hits of every frame, over two rounds.

    Exact programs find the hits of a test of every pair; the others find at least these.
    """
    program, hits = dict(programs(traffic))[name], 0
    for frame in [*range(1, FRAMES), 0, *range(1, FRAMES)]:
        program.play()
        truth, found = traffic.truth(frame), program.found()
        assert found == truth if name in EXACT else found >= truth, frame
        hits += len(truth)
    assert hits > FRAMES * 10


def test_a_world_that_tests_no_pair_is_not_measured(monkeypatch):
    """A world whose broad phase tests no pair is not measured, but raises an error.

    The sprites of the test stand still. In a faulty chart they did so because their speeds were reversed in each step.
    """

    class Standing(Traffic):
        def __init__(self, count):
            super().__init__(count)
            self.motions[:] = 0
            self.arrays, self.positions = [self.arrays[0]] * FRAMES, [self.positions[0]] * FRAMES

    monkeypatch.setattr(peers, "Traffic", Standing)
    with pytest.raises(RuntimeError, match="the broad phase of 20 moving sprites tested no pair"):
        peers.measure_sprites(20)


def row(engine, overlap, least, median):
    cost = {"seconds": [least, median, 1.1 * median], "runs": 5, "pieces": 20}
    label = f"{engine} {overlap} {median}"
    return {"series": engine, "label": label, "panel": "pyramid of 55", "overlap": overlap, "cost": cost}


ROWS = [row("ours", 0.04, 9e-5, 1e-4), row("ours", 0.009, 1.1e-4, 1.2e-4), row("ours", 0.05, 2e-4, 2.1e-4)]
PEER = [row("pymunk", 0.09, 4e-5, 4.2e-5), row("pymunk", 0.02, 9.5e-5, 1.25e-4)]


@pytest.mark.parametrize(
    "most, order, verdict, text",
    [
        (1.0, ("pymunk",), HOLDS, "overlap of at most 1 px: pymunk is the cheapest"),
        (0.05, ("ours", "pymunk"), TIE, "ours and pymunk are the cheapest"),
        (0.01, (), HOLDS, "overlap of at most 0.01 px: ours alone reaches it"),
        (0.001, (), HOLDS, "no setting reaches it"),
    ],
)
def test_engines_are_compared_at_equal_overlap_each_at_its_best(most, order, verdict, text):
    claim = peers._at_overlap("pyramid of 55", most, [*ROWS, *PEER])
    assert (claim.order, claim.verdict) == (order, verdict) and text in claim.text


def test_the_curve_of_an_engine_holds_only_settings_that_no_other_beats():
    found = peers.fronts([*ROWS, *PEER], "pyramid of 55")
    assert {engine: [each["overlap"] for each in rows] for engine, rows in found.items()} == {
        "ours": [0.04, 0.009],
        "pymunk": [0.09, 0.02],
    }


def test_pymunk_is_measured_over_slop_iterations_and_substeps():
    """pymunk is measured over slop, iterations and substeps; Hitbox over fixed numbers of substeps and by load."""
    pytest.importorskip("pymunk")
    rows = peers.measure_piles(3)
    settings = {(row["slop"], row["iterations"], row["substeps"]) for row in rows if row["series"] == "pymunk"}
    assert settings == {(s, i, d) for s in (0.1, 0.03, 0.01) for i in (5, 10, 20, 40) for d in (1, 2, 4)}
    assert {row["substeps"] for row in rows if row["series"] == "ours"} == {1, 2, 4, 8, "auto"}
    assert all(0.0 <= row["overlap"] < 1.0 for row in rows)


@pytest.mark.parametrize("rows", [2, 3])
def test_a_missing_pymunk_is_named_in_the_chart_and_our_rows_stay(rows, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pymunk", None)
    found = peers.measure_piles(rows)
    assert [row["series"] for row in found] == ["ours"] * len(peers.SUBSTEPS) + ["pymunk"]
    panel = f"pyramid of {rows * (rows + 1) // 2}"
    (claim,) = peers._claims(found)
    assert claim.text == f"{panel} boxes: beside pymunk" and "pymunk is not installed" in claim.figure
    drawn = next(each for each in peers._panels(found) if each.title == panel)
    assert len(dots_of(drawn, found)) == len(peers.SUBSTEPS)


@pytest.mark.parametrize("boxes, its, mine", [(55, 33.0, 80.0), (210, 118.0, 217.0), (1035, 465.0, 733.0)])
def test_figures_of_box2d_are_quoted_with_machine_and_version(boxes, its, mine):
    """Quoted times are compared with each other alone. No claim mixes them with measured ones."""
    rows = [row for row in peers.quote_box2d() if row["boxes"] == boxes]
    assert {row["series"]: row["quoted_us"] for row in rows if "pymunk" not in row["series"]} == {
        "Box2D v3, elsewhere": pytest.approx(its),
        "Hitbox, elsewhere": pytest.approx(mine),
    }
    assert all("cost" not in row and "617d32a" in row["label"] and "Linux x86-64" in row["label"] for row in rows)
    (claim,) = peers._claims([*ROWS, *PEER, *rows])[len(peers.ALIKE) :]
    assert claim.verdict == HOLDS and "quoted from elsewhere" in claim.text and "617d32a" in claim.figure
    (panel,) = [each for each in peers._panels(rows) if each.title == peers.ELSEWHERE]
    assert len(dots_of(panel, rows)) == 3
    assert "617d32a" in peers.CHART.truth and "not measured here" in peers.CHART.truth


def test_a_pair_that_lasts_is_one_encounter(monkeypatch):
    """A rate counts pairs, not pairs times frames: its total does not grow with the frames that are looked at."""
    totals = []
    for looks in (1, 4):
        monkeypatch.setattr(peers, "LOOKS", looks)
        monkeypatch.setattr(peers, "timed_steps", lambda steps, count: one_call(steps))
        row = next(row for row in peers.measure_sprites(60) if row["series"] == STEP)
        assert row["wrong"][0] == row["missed"][0] == 0
        totals.append(row["wrong"][1])
    assert totals[0] <= totals[1] < 2 * totals[0]


def one_call(steps):
    for step in steps.values():
        for _ in range(FRAMES):
            step()
    return {name: Cost(1.0, 1.0, 1.0, 1, 1) for name in steps}
