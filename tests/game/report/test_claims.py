"""Claims of the report: no verdict without a measurement, and no text that the chart's own rows refute."""

import json
from pathlib import Path

import pytest

from game.measure.rates import Rate
from game.measure.timing import Cost
from game.report.charts import broadphases, chaos, continuous, left_out, papers
from game.report.claim import FAILS, HOLDS, PART, TIE, at_least, at_most, ordering, pair, region
from game.report.plots import dots_of, shown
from scenes.lab.broadphases import __doc__ as lab_text

ROWS = json.loads((Path(__file__).resolve().parents[3] / "docs" / "accuracy.json").read_text("utf-8"))["rows"]
END = chaos.LENGTH


def of(label, *parted):
    return {"series": label, "label": label, "panel": "chaos", "parted": list(parted), "cost": {"seconds": [1e-4] * 3}}


# ---- chart 11 --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "rows, text, figure, verdict",
    [
        ([of("a", END, END, END), of("b", 1.0, 1.5, 2.0)], "a can", "more than 3.00 s, then b 1.50 s", HOLDS),
        ([of("a", 2.5, END, END), of("b", 1.0, 1.5, 2.6)], "a can", "more than 3.00 s (2.50 s to more than", TIE),
        ([of("a", END, END, END), of("b", END, END, END)], "a and b can", "each more than 3.00 s, the length", TIE),
        ([of("a", 2.0, 2.2, 2.4), of("b", 1.0, 1.5, 1.9)], "a can", "2.20 s (2.00 s to 2.40 s), then b 1.50 s", HOLDS),
    ],
)
def test_the_length_of_a_run_is_no_time_of_parting(rows, text, figure, verdict):
    (claim,) = chaos._claims(rows)
    assert claim.text.startswith(text) and claim.figure.startswith(figure) and claim.verdict == verdict
    assert "3.00 to 3.00" not in claim.figure


def test_a_dot_at_the_end_of_a_run_is_shown_as_more_than_it():
    panel = chaos.PANELS[0]
    dots = dots_of(panel, (of("a", 2.5, END, END), of("a", END, END, END)))
    reported = [shown(dot, panel)[panel.y.label] for dot in dots]
    assert reported == ["more than 3 (2.5 to more than 3)", "more than 3"]


# ---- chart 8 ---------------------------------------------------------------------------------------------------------


def phase(name, tests, seconds=1e-4):
    return {
        "series": name,
        "layout": "even",
        "moving": "all move",
        "panel": "even, all move",
        "n": 1000,
        "candidates": 1000,
        "possible": 499_500,
        "tests": tests,
        "cost": {"seconds": [seconds] * 3},
    }


@pytest.mark.parametrize(
    "name, tests, verdict", [("sweep", 7000.0, HOLDS), ("tree", 49_000.0, FAILS), ("brute", 150_000.0, None)]
)
def test_pairs_left_out_are_those_that_are_not_tested(name, tests, verdict):
    """Brute force is not praised for pairs that it tests: all have as many candidates."""
    found = [claim for claim in broadphases._claims([phase(name, tests)]) if "5 %" in claim.text]
    assert [claim.verdict for claim in found] == ([] if verdict is None else [verdict])
    assert not any("leaves out" in claim.text for claim in broadphases._claims(ROWS["broadphases"]))


@pytest.mark.parametrize(
    "text, moving, n, cheapest",
    [
        ("the hash is the cheapest at 300 bodies", "all move", 300, ("hash",)),
        ("the hash and the sweep at 1,000 and more", "all move", 1_000, ("hash", "sweep")),
        ("the hash and the sweep at 1,000 and more", "all move", 10_000, ("hash", "sweep")),
        ("the hash and the tree cannot be told apart up to 1,000", "one in twenty moves", 1000, ("hash", "tree")),
        ("at 5,000 the hash is cheaper", "one in twenty moves", 10_000, ("hash",)),
    ],
)
def test_the_lab_teaches_what_the_rows_of_chart_8_say(text, moving, n, cheapest):
    assert lab_text is not None and text in " ".join(lab_text.split())
    costs = {
        row["series"]: pair(row["cost"])
        for row in ROWS["broadphases"]
        if (row["layout"], row["moving"], row["n"]) == ("even", moving, n)
        and row["series"] in ("sweep", "hash", "tree")
    }
    assert ordering("", costs).order == cheapest


@pytest.mark.parametrize("claim_of", [at_least, at_most])
def test_a_count_has_no_interval(claim_of):
    assert claim_of("", (2.0, 2.0, 2.0), 3.0, unit="%").figure == "2 %"
    assert claim_of("", (1.0, 2.0, 3.0), 3.0, unit="x").figure == "2 x (1 to 3)"


@pytest.mark.parametrize(
    "ratios, verdict, figure",
    [
        ({"1": (0.4, 0.5, 0.6), "2": (0.5, 0.7, 0.8)}, HOLDS, "faster at 1, 2 (0.5 to 0.7 x)"),
        ({"1": (0.4, 0.5, 0.6), "2": (1.0, 1.1, 1.2)}, PART, "faster at 1 (0.5 x); no faster at 2 (1.1 x)"),
        (
            {"1": (0.8, 0.9, 1.1), "2": (1.0, 1.1, 1.2)},
            TIE,
            "no faster at 2 (1.1 x); cannot be told apart at 1 (0.9 x)",
        ),
        ({"1": (1.0, 1.1, 1.2)}, FAILS, "no faster at 1 (1.1 x)"),
    ],
)
def test_a_verdict_over_a_swept_parameter_is_a_region(ratios, verdict, figure):
    claim = region("", ratios, (0.0, 0.9), "faster//no faster")
    assert (claim.verdict, claim.figure) == (verdict, figure)


def test_a_region_needs_a_ratio():
    with pytest.raises(ValueError, match="a region needs a ratio"):
        region("", {}, (0.0, 1.0), "a/b/c")


def swept(speed, **us):
    return [
        {"panel": broadphases.OVER_SPEED, "layout": broadphases.OVER_SPEED, "n": 1000, "series": name, "speed": speed}
        | {"moving": "all move", "cost": {"seconds": [1e-6 * each, 1e-6 * each, 1e-6 * each]}}
        for name, each in us.items()
    ]


@pytest.mark.parametrize(
    "slow, fast, verdicts", [((100, 100), (400, 1100), (FAILS, PART)), ((50, 100), (50, 100), (HOLDS, HOLDS))]
)
def test_the_sweep_is_judged_over_the_speed(slow, fast, verdicts):
    rows = [row for v in (6.0, 60.0) for row in swept(v, sweep=slow[0], hash=slow[1])]
    rows += swept(3000.0, sweep=fast[0], hash=fast[1])
    found = [claim for claim in broadphases._claims(rows) if "sweep" in claim.text]
    assert tuple(claim.verdict for claim in found) == verdicts


def test_the_speeds_are_measured_on_bodies_that_the_broad_phase_tests():
    rows = broadphases.measure_speed(3000.0)
    assert {row["series"] for row in rows} == {"sweep", "hash", "tree"} and all(row["tests"] > 1000 for row in rows)


@pytest.mark.parametrize("word", ["the tree suits few movers", "the grid suits one size"])
def test_claims_about_layouts_are_made_over_the_number_of_bodies(word):
    (claim,) = [claim for claim in broadphases._claims(ROWS["broadphases"]) if claim.text.startswith(word)]
    assert all(f"{n} bodies" in claim.figure for n in ("100", "1,000", "10,000"))


# ---- charts 7 and 15 -------------------------------------------------------------------------------------------------


def sweeps(share, off, toi):
    return [
        {"panel": continuous._density(share), "series": name, "ratio": ratio, "cost": {"seconds": [1e-6 * us] * 3}}
        for ratio in continuous.SWEPT
        for name, us in (("off", off), ("toi", toi if ratio < 5.0 else 3.0 * off))
    ]


@pytest.mark.parametrize(
    "toi, verdict, figure",
    [
        (300, HOLDS, "2 to 5 x at 0.3, 1, 3, 10 (3 x)"),
        (110, PART, "2 to 5 x at 10 (3 x); less at 0.3, 1, 3 (1.1 x)"),
        (600, PART, "2 to 5 x at 10 (3 x); more at 0.3, 1, 3 (6 x)"),
    ],
)
def test_the_price_of_sweeps_is_judged_over_speed_for_each_share_that_hits(toi, verdict, figure):
    (claim,) = continuous._time_claims(sweeps(0.5, 100, toi))
    assert (claim.verdict, claim.figure) == (verdict, figure) and "50 % hit" in claim.text


@pytest.mark.parametrize("ratio", [0.3, 10.0])
def test_as_many_discs_hit_as_the_sweep_is_measured_with(ratio):
    rows = {(row["series"], row["share"]): row["hits"] for row in continuous.measure_density(ratio)}
    for share in continuous.SHARES:
        assert abs(rows["toi", share] - share * continuous.DISCS) <= 0.03 * continuous.DISCS


@pytest.mark.parametrize("corners", papers.GJK_CORNERS)
@pytest.mark.parametrize("gap", papers.GAPS)
def test_iterations_are_those_of_one_call(corners, gap):
    (row,) = [row for row in ITERATED if (row["corners"], row["gap"]) == (corners, gap)]
    least, mean, most = row["iterations"]
    assert 1 <= least <= mean <= most <= 2 * corners and row["calls"] == papers.CALLS


ITERATED = papers.measure_iterations()


def timed(panel, **fields):
    us = fields.pop("us")
    return {"panel": panel, "cost": {"seconds": [1e-6 * us, 1e-6 * us, 1e-6 * us]}, **fields}


@pytest.mark.parametrize(
    "kind, box, verdict, figure",
    [
        ("hit", 2.0, HOLDS, "faster than at upright box, capsule"),
        ("hit", 0.5, PART, "faster than at capsule (0.25 x); no faster than at upright box (2 x)"),
        ("miss", 0.5, PART, "no faster than at upright box (2 x)"),
    ],
)
def test_the_disc_is_judged_over_kinds_of_shapes(kind, box, verdict, figure):
    costs = {"disc": 1.0, "upright box": box, "capsule": 4.0}
    rows = [timed("shapes", series=kind, shape=name, us=us) for name, us in costs.items()]
    (claim,) = papers._claims(rows)
    assert claim.verdict == verdict and figure in claim.figure and claim.text.endswith(kind)


def test_a_kind_of_shape_is_timed_on_pairs_that_touch_and_on_pairs_that_do_not():
    found = {(row["shape"], row["series"]) for row in papers.measure_shapes()}
    assert ("disc", "hit") in found and ("disc", "miss") in found
    assert ("upright box", "hit") in found and ("upright box", "miss") not in found


@pytest.mark.parametrize("share, saved, verdict", [(0.7, 0.3, HOLDS), (0.0, 1.0, FAILS)])
def test_filters_are_judged_over_the_share_that_they_reject(share, saved, verdict):
    names = {"filtered before the narrow phase": saved, "filtered after the narrow phase": 1.0}
    rows = [timed(left_out.FILTERED, series=name, share=share, us=us) for name, us in names.items()]
    (claim,) = left_out.claims(rows)
    assert claim.verdict == verdict and f"{100 * share:g} %" in claim.figure


@pytest.mark.parametrize("shape, count, verdict", [("upright boxes", 0, HOLDS), ("discs", 20, FAILS)])
def test_a_narrow_phase_is_left_out_only_where_no_hit_is_false(shape, count, verdict):
    rows = [
        timed(left_out.SKIPPED, series=f"{name} a narrow phase", shape=shape, wrong=[wrong, 100], us=us)
        for name, wrong, us in (("with", 0, 2.0), ("without", count, 1.0))
    ]
    saves, right = left_out.claims(rows)
    assert saves.verdict == HOLDS and right.verdict == verdict and f"{count}.0 %" in right.figure


def test_a_filter_and_a_narrow_phase_change_the_work_and_not_the_hits(monkeypatch):
    monkeypatch.setattr(left_out, "timed_steps", few_steps)
    filtered = left_out.measure_filters()
    assert [row["hits"] for row in filtered][::2] == [row["hits"] for row in filtered][1::2]
    assert filtered[0]["hits"] > 500 and filtered[-1]["hits"] == 0
    wrong = {row["shape"]: Rate(*row["wrong"]) for row in left_out.measure_skipped() if "without" in row["series"]}
    assert wrong["upright boxes"].count == 0 and all(0.1 < wrong[each].share < 0.7 for each in left_out.SHAPES[1:])


def few_steps(steps, count):
    return {name: Cost.of([float(len([step() for _ in range(2)]))], 2) for name, step in steps.items()}
