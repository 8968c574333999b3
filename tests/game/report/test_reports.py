"""A report from the command line: stored job by job, resumed, refused with a reason, and
written as one complete page.
"""

import csv
import json
import os
import re
from html.parser import HTMLParser

import pytest

from game.command_line import run
from game.errors import UsageError
from game.measure.timing import Cost
from game.registry import Registry
from game.report.answer import WAITS, answer_of
from game.report.chart import Axis, Chart, Panel, time, value
from game.report.charts.tiers import AROUND
from game.report.claim import FAILS, HOLDS, TIE, at_least, at_most, ordering
from game.report.job import Job, ReportScope, spread
from game.report.page import PAGE, QUESTIONS, _claims, as_csv
from game.report.pygame_sprites import BOXES, STEP
from game.report.store import Store
from scenes import SCENES

pytest.importorskip("matplotlib")
WORK = "tests.game.report.work"
REGISTRY = Registry(SCENES)


def small(jobs):
    """Return the charts of a report: a single chart with these jobs."""
    panel = Panel("of all", Axis("n", value("n")), Axis("us", time("cost")))
    return (Chart(1, "fall", "Falling <b>", "How long?", "none & all", (panel,), lambda scope: list(jobs)),)


@pytest.fixture
def charts(monkeypatch):
    def put(jobs):
        monkeypatch.setattr("game.report.run.CHARTS", small(jobs))

    put([Job(f"fall/{n}", f"{WORK}:fall", {"bodies": n}) for n in (1, 2, 4)])
    return put


def report(*arguments):
    return run(["--report", *map(str, arguments)], REGISTRY)


class Reader(HTMLParser):
    """HTML parser that collects the references of a page to other files, and the ids of its elements."""

    def __init__(self):
        super().__init__()
        self.elsewhere, self.ids = [], []

    def handle_starttag(self, tag, attributes):
        for name, text in attributes:
            if name in ("src", "href", "xlink:href", "data") and not (text or "").startswith("#"):
                self.elsewhere.append((tag, name, text))
            if name == "id":
                self.ids.append(text)


def test_the_page_is_whole_and_needs_nothing_else(charts, tmp_path, capsys):
    folder = tmp_path / "new" / "report"
    assert report(folder, "--quick") == 0
    assert "3 jobs, 0 failed" in capsys.readouterr().out
    page = (folder / "index.html").read_text()
    reader = Reader()
    reader.feed(page)
    assert not reader.elsewhere and len(set(reader.ids)) == len(reader.ids) and "{{" not in page
    assert "Falling &lt;b&gt;" in page and "none &amp; all" in page
    dots = json.loads(re.search(r'id="dots">(.*?)</script>', page).group(1))
    assert len(dots) == 3 and set(dots) <= set(reader.ids), "every dot that is told of can be pointed at"
    assert {dot["again"] for dot in dots.values()} == {
        f"python main.py --report {folder} --quick --only fall/{n}" for n in (1, 2, 4)
    }
    assert "prefers-color-scheme: dark" in page and "var(--ink)" in page and "#010203" not in page
    rows = json.loads((folder / "data" / "fall.json").read_text())
    lines = list(csv.DictReader((folder / "data" / "fall.csv").open()))
    assert [row["n"] for row in rows] == [1, 2, 4] == [int(line["n"]) for line in lines]
    assert [float(line["cost_median"]) for line in lines] == [row["cost"]["seconds"][1] for row in rows]


def test_it_opens_with_the_answer_and_ends_with_the_claims(charts, tmp_path):
    assert report(tmp_path / "r", "--quick") == 0
    page = (tmp_path / "r" / "index.html").read_text()
    parts = ("<h1>", 'class="answer"', "<nav>", "class=question", 'id="claims"', 'class="machine"')
    order = [page.index(part) for part in parts]
    assert order == sorted(order)
    assert WAITS in page, "without its chart there is no answer"


def test_the_five_questions_hold_every_chart():
    from game.report.charts import CHARTS

    assert len(QUESTIONS) == 5
    assert sorted(key for _, keys in QUESTIONS for key in keys) == sorted(chart.key for chart in CHARTS)


def row_of(tier, sprite, seconds, wrong=(0, 100)):
    cost = {"seconds": [seconds, 1.1 * seconds, 1.2 * seconds]}
    return {"panel": AROUND, "series": tier, "sprite": sprite, "wrong": list(wrong), "hit_cost": cost}


def step_of(series, n, seconds, wrong=(0, 100)):
    cost = {"seconds": [seconds, 1.1 * seconds, 1.2 * seconds]}
    return {"panel": "sprites", "series": series, "n": n, "wrong": list(wrong), "cost": cost}


TIER_ROWS = [row_of("aabb", "a", 1.0, (90, 100)), row_of("mask", "a", 2.0), row_of("hull", "a", 9.0, (90, 100))]
TIER_ROWS += [row_of("aabb", "b", 1.0, (90, 100)), row_of("mask", "b", 3.0)]


@pytest.mark.parametrize(
    "pixels, wrong, text",
    [
        ((0.5, 0.8), (0, 100), "By their pixels none is, and the time of a whole step is 0.5 to 0.8 x that by boxes."),
        ((2.0, 2.0), (0, 100), "By their pixels none is, and the time of a whole step is 2.0 x that by boxes."),
        ((1.0, 1.05), (0, 100), "and the time of a whole step cannot be told apart from that by boxes."),
        ((1.0, 1.0), (1, 100), "By their pixels 1.0 are, and"),
    ],
)
def test_the_answer_is_about_pixels_in_whole_steps(pixels, wrong, text):
    """Boxes and pixels are compared in the same steps of chart 14. The exact test of turned pixels is named as such."""
    rows = [step_of(BOXES, 300, 1.0, (30, 100)), step_of(STEP, 300, pixels[0], wrong)]
    rows += [step_of(BOXES, 2000, 1.0, (10, 100)), step_of(STEP, 2000, pixels[1], wrong)]
    said = answer_of(TIER_ROWS, rows)
    assert said.startswith("Of 100 hits by the boxes of upright sprites, 20 are false (15 to 26). ") and text in said
    assert said.endswith("Rotated, by exact pixels (tier mask), the time of a hit is 2.0 to 3.0 x that by boxes.")


def test_the_answer_waits_for_both_charts():
    rows = [step_of(BOXES, 300, 1.0), step_of(STEP, 300, 1.0)]
    assert answer_of([], rows) == answer_of(TIER_ROWS, rows[:1]) == answer_of(TIER_ROWS[:1], rows) == WAITS


def test_nothing_is_wider_than_a_phone():
    """No element of the page is wider than 356 px, which is the width of a phone (400 px) without its margins.

    No fixed width is larger, words break, and wide tables scroll by themselves.
    """
    style = PAGE.read_text().split("</style>")[0]
    for rule in re.findall(r"\{([^{}]*)\}", style):
        for name, text in re.findall(r"([a-z-]+):\s*([^;]+)", rule):
            if name in ("width", "min-width", "grid-template-columns", "columns"):
                free = re.sub(r"min\([^()]*\)", "", text)
                assert all(int(size) <= 356 for size in re.findall(r"(\d+)px", free)), (name, text)
    assert "overflow-wrap: anywhere" in style and "max-width: min(420px, 90vw)" in style
    assert re.search(r"figure svg \{[^}]*width: 100%", style) and re.search(r"\.wide \{[^}]*overflow: auto", style)
    assert 'name="viewport"' in style
    assert "<div class=wide><table" in _claims([at_least("x", (1.0, 2.0, 3.0), 1.0)])


def test_what_was_done_is_not_done_again(charts, tmp_path, capsys):
    assert report(tmp_path / "r") == 0
    kept = {path: path.read_text() for path in (tmp_path / "r" / "results").iterdir()}
    capsys.readouterr()
    assert report(tmp_path / "r") == 0
    assert not capsys.readouterr().err.count("jobs, about")
    assert {path: path.read_text() for path in kept} == kept
    assert report(tmp_path / "r", "--only", "fall/2") == 0
    changed = [path.name for path, text in kept.items() if path.read_text() != text]
    assert changed == ["fall--2.json"]


def test_interrupted_it_keeps_what_is_done_and_goes_on(charts, tmp_path, monkeypatch, capsys):
    marks = [tmp_path / f"mark{k}" for k in range(4)]
    charts([Job(f"fall/{k}", f"{WORK}:wait", {"path": str(mark)}) for k, mark in enumerate(marks)])
    from game.report.run import Progress

    reported = Progress.__call__

    def interrupt(self, found):
        reported(self, found)
        if self.count == 2:
            raise KeyboardInterrupt

    monkeypatch.setattr(Progress, "__call__", interrupt)
    assert report(tmp_path / "r") == 130
    err = capsys.readouterr().err
    assert "2 of 4 jobs, about" in err and "the same command goes on" in err
    assert "2 jobs are not done yet" in (tmp_path / "r" / "index.html").read_text()
    for mark in marks:
        mark.unlink(missing_ok=True)
    monkeypatch.setattr(Progress, "__call__", reported)
    assert report(tmp_path / "r") == 0
    assert [mark.exists() for mark in marks] == [False, False, True, True]


def test_a_job_that_fails_is_reported_and_done_again(charts, tmp_path, capsys):
    charts([Job("fall/1", f"{WORK}:fall", {"bodies": 1}), Job("fall/bad", f"{WORK}:fail", {})])
    assert report(tmp_path / "r") == 1
    assert "1 failed" in capsys.readouterr().out
    page = (tmp_path / "r" / "index.html").read_text()
    assert "fall/bad: ValueError: nothing can be measured here" in page
    charts([Job("fall/1", f"{WORK}:fall", {"bodies": 1}), Job("fall/bad", f"{WORK}:fall", {"bodies": 2})])
    assert report(tmp_path / "r") == 0
    assert "What failed" not in (tmp_path / "r" / "index.html").read_text()


def test_a_damaged_result_is_measured_again(charts, tmp_path):
    assert report(tmp_path / "r") == 0
    path = tmp_path / "r" / "results" / "fall--2.json"
    path.write_text("{")
    assert report(tmp_path / "r") == 0
    assert json.loads(path.read_text())["name"] == "fall/2"


def test_folders_that_cannot_be_used(charts, tmp_path, monkeypatch):
    with pytest.raises(UsageError, match="is a file"):
        (tmp_path / "file").write_text("")
        Store(tmp_path / "file", False)
    other = tmp_path / "other"
    other.mkdir()
    (other / "thesis.tex").write_text("mine")
    with pytest.raises(UsageError, match="something else .thesis.tex."):
        Store(other, False)
    assert (other / "thesis.tex").read_text() == "mine" and len(list(other.iterdir())) == 1
    Store(tmp_path / "r", True)
    with pytest.raises(UsageError, match="holds a quick report"):
        Store(tmp_path / "r", False)
    with monkeypatch.context() as older:
        older.setattr("game.report.store.FORMAT", 1)
        with pytest.raises(UsageError, match="of format 3, this is 1; name another folder"):
            Store(tmp_path / "r", True)
    monkeypatch.setattr("game.report.store.VERSION", "9.9")
    with pytest.raises(UsageError, match="of version .*, this is 9.9"):
        Store(tmp_path / "r", True)
    (tmp_path / "r" / "manifest.json").write_text("[")
    with pytest.raises(UsageError, match="manifest.json is damaged"):
        Store(tmp_path / "r", True)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="nothing is forbidden to this user")
def test_a_folder_that_cannot_be_written(tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(UsageError, match="cannot be written"):
        Store(tmp_path / "r", False)


def test_a_folder_where_none_can_be(charts):
    with pytest.raises(UsageError, match="cannot be written"):
        Store(__import__("pathlib").Path("/proc/nothing/here"), False)


@pytest.mark.parametrize(
    "arguments, message",
    [
        (["--quick"], "--quick needs --report"),
        (["--workers", "0"], "--workers needs --report"),
        (["--only", "x"], "--only needs --report"),
        (["--report", "r", "--workers", "0"], "--workers must be at least 1 .got 0."),
        (["--report", "r", "--workers", "2", "--dask", "tcp://x:1"], "leave out --workers"),
        (["--report", "r", "--scene", "shooter"], "leave out --scene"),
        (["--report", "r", "--only", "nonsense"], "no job is named nonsense; charts: tiers, "),
    ],
)
def test_wrong_use_is_one_line(arguments, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(arguments, REGISTRY) == 2
    assert re.search(message, capsys.readouterr().err)


def test_without_matplotlib_the_extra_is_named(tmp_path, monkeypatch, capsys):
    from game.report import plots

    plots.library.cache_clear()
    monkeypatch.setitem(__import__("sys").modules, "matplotlib", None)
    assert report(tmp_path / "r") == 2
    assert '.[bench]"' in capsys.readouterr().err and not (tmp_path / "r").exists()
    plots.library.cache_clear()


def test_without_a_scheduler_no_folder_is_made(tmp_path, monkeypatch, capsys):
    pytest.importorskip("distributed")
    monkeypatch.setattr("game.report.runners.PATIENCE", "200ms")
    assert report(tmp_path / "r", "--dask", "tcp://127.0.0.1:9") == 2
    assert "no scheduler answers at tcp://127.0.0.1:9" in capsys.readouterr().err and not (tmp_path / "r").exists()


def test_only_what_is_sure_is_claimed():
    sure = ordering("x", {"a": (1.0, 1.1), "b": (2.0, 2.1), "c": (1.9, 2.2)})
    assert sure.verdict == HOLDS and sure.order == ("a",)
    overlapping = ordering("x", {"a": (1.0, 1.6), "b": (1.5, 2.0)})
    assert overlapping.verdict == TIE and overlapping.order == ("a", "b")
    near = ordering("x", {"a": (1.0, 1.0), "b": (1.05, 1.05)})
    assert near.verdict == TIE
    with pytest.raises(ValueError, match="two costs"):
        ordering("x", {"a": (1.0, 1.0)})
    assert [at_least("", (2.0, 3.0, 4.0), limit).verdict for limit in (1.9, 2.5, 4.1)] == [HOLDS, TIE, FAILS]
    assert [at_most("", (2.0, 3.0, 4.0), limit).verdict for limit in (1.9, 2.5, 4.1)] == [FAILS, TIE, HOLDS]


def test_csv_holds_what_commas_and_lists_would_break():
    rows = [{"label": 'a,"b"', "rate": [1, 2], "cost": spread(Cost(1.0, 2.0, 3.0, 5, 9))}, {"other": 1}]
    lines = list(csv.DictReader(as_csv(rows).splitlines()))
    assert lines[0]["label"] == 'a,"b"' and json.loads(lines[0]["rate"]) == [1, 2] and lines[0]["cost_upper"] == "3.0"
    assert lines[1]["other"] == "1" and lines[1]["label"] == ""


def test_every_job_of_every_chart_can_be_handed_to_another_process():
    from game.report.charts import CHARTS

    for quick in (True, False):
        scope = ReportScope(quick, REGISTRY.listing)
        names = [job.name for chart in CHARTS for job in chart.jobs(scope)]
        assert len(set(names)) == len(names) and len({name.replace("/", "--") for name in names}) == len(names)
        for chart in CHARTS:
            for job in chart.jobs(scope):
                assert job.name.startswith(f"{chart.key}/") and not re.search(r"[\s:]", job.name)
                assert json.loads(json.dumps(job._asdict())) == job._asdict()
    keys = [chart.key for chart in CHARTS]
    assert len(set(keys)) == len(keys) and [c.number for c in CHARTS] == sorted(c.number for c in CHARTS)


def test_a_slowest_step_that_is_near_the_budget_is_no_verdict():
    from game.report.charts.latency import CHART, HALF_BUDGET

    def verdict(most):
        row = {"label": "x", "cost": {"seconds": [1e-4, 2e-4, 1e-3 * most]}}
        return CHART.claims([row])[0].verdict

    assert [verdict(share * HALF_BUDGET) for share in (0.85, 0.95, 1.05, 1.15)] == [HOLDS, TIE, TIE, FAILS]
