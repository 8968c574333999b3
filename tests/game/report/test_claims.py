"""Claims of the report: no verdict without a measurement, and no text that the chart's own rows refute."""

import json
from pathlib import Path

import pytest

from game.report.charts import broadphases, chaos
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
        ("the sweep at 2,000 and more", "all move", 10_000, ("sweep",)),
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
