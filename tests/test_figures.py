"""Every figure of speed, size or error in the documents equals the value in a stored JSON file.

The sentences with figures are generated here and must occur in the documents word for word. A figure in no such
sentence fails too. The figures of docs/accuracy.md, docs/stability.md and docs/coverage.md are checked by the tests of
the code that writes these pages.
"""

import json
import re
from functools import cache
from pathlib import Path

import pytest

from game.invariants.watch import all_invariants
from game.report.charts import peers
from physics.joints.kinds import KINDS
from scenes import SCENES
from scenes.lab.gallery.pages import PAGES
from tests import coverage
from tests.accuracy.page import total_seconds

ROOT = Path(__file__).resolve().parents[1]
KEPT = ROOT / "docs"
# A number with a unit of measure, or so many times as much.
FIGURE = re.compile(r"\b\d[\d.,]*\s?(?:ms|us|µs|ns|MB|kB|%|min|minutes|times|mm|s)\b")
NUMBERS = {
    3: "three",
    11: "eleven",
    12: "twelve",
    22: "twenty-two",
    24: "twenty-four",
    25: "twenty-five",
    26: "twenty-six",
    29: "twenty-nine",
}  # as counted
# Figures that are chosen, not measured: (page, words that hold them).
CHOSEN = (
    ("docs/manual.md", "without window, sound and waiting: N steps of 1/60 s"),
    ("CONTRIBUTING.md", "`update` is one step of 1/60 s"),
)


@cache
def kept(path):
    return json.loads((KEPT / path).read_text())


def ratios(bench, pattern):
    """Return the stored ratios of one benchmark whose names match a pattern, {groups: ratio}.

    bench: name of the benchmark; pattern: regular expression for the whole name of a ratio; groups: tuple of the texts
    that match the groups of the pattern.
    """
    found = {}
    for name, value in kept("bench/0.1.0.json")["ratios"][bench].items():
        match = re.fullmatch(pattern, name)
        if match:
            found[match.groups()] = value
    assert found, f"{bench} has no ratio like {pattern!r}"
    return found


def words(text):
    return " ".join(text.split())


def sweeps_lead():
    """Return a sentence on the lead of sweep and prune if all bodies move.

    The lead is the time of the next best broad phase divided by that of sweep and prune.
    """
    shipped = ratios("broadphase", r"(\d+) bodies (.*), all moving: (sweep|hash|tree) / brute")
    leads = {}
    for place in {(size, layout) for size, layout, _ in shipped}:
        others = min(shipped[*place, name] for name in ("hash", "tree"))
        leads[place] = others / shipped[*place, "sweep"]
    case = max(leads, key=leads.__getitem__)
    assert case[1] == "along the ground", f"the sweep leads most on {case}"
    least, most = min(leads.values()), max(leads.values())
    return (
        f"everything moves: {least:.1f} to {most:.1f} times as fast as the next from 1,000 bodies on, most along a line"
    )


def pyramids():
    """Return a sentence on the time of a step of awake pyramids.

    Times with four substeps are relative to pymunk, and a time with substeps by load is relative to four substeps.
    """
    default, four = (
        {int(boxes): value for (boxes,), value in ratios("solvers", rf"(\d+) boxes, soft_step {some} / pymunk").items()}
        for some in ("auto", "4")
    )
    reported = ", ".join(f"{four[boxes]:.2f}" for boxes in (55, 210, 1035, 5050))
    return (
        f"With four substeps pyramids of 55, 210, 1,035 and 5,050 boxes take {reported} of pymunk's time at its ten "
        f"iterations; the awake one of 1,035 takes {default[1035] / four[1035]:.1f} times as long by load as with four"
    )


def moving():
    """Return a sentence on the time of a step of three moving scenes relative to pymunk.

    Hitbox runs with substeps by load and with four substeps.
    """
    some = {
        name: [ratios("moving", rf"({name}.*), substeps {each} / pymunk").popitem()[1] for each in ("auto", "4")]
        for name in ("rain of 1,500", "pyramid", "tumbler")
    }
    (auto, four), hit, tumbler = (some[name] for name in some)
    return (
        f"`python -m tests.bench moving` measures {auto:.1f} times its time by load and {four:.1f} with four substeps "
        f"in a rain of 1,500 boxes, {hit[0]:.1f} and {hit[1]:.1f} where a ball hits a pyramid, {tumbler[0]:.1f} and "
        f"{tumbler[1]:.1f} in a tumbler"
    )


def at_equal_overlap():
    """Return a sentence on the time of a step of pyramids relative to pymunk at equal overlap.

    Each engine has the cheapest of its settings with an overlap of at most 0.1 px.
    """
    rows, ratios = kept("accuracy.json")["rows"]["peers"], []
    for boxes in (55, 210, 1035):
        best = peers.cheapest(rows, f"pyramid of {boxes}", 0.1)
        ours, pymunk = (best[engine]["cost"]["seconds"][1] for engine in ("ours", "pymunk"))
        ratios.append(f"{ours / pymunk:.2f}")
    return (
        "With an overlap of at most 0.1 px and pymunk's best slop, iterations and substeps, pyramids of 55, 210 and "
        f"1,035 boxes take {', '.join(ratios)} of its time"
    )


def best_program():
    """Return a sentence on the time of a frame relative to the best pygame program.

    The sprites of both programs move by whole pixels.
    """
    found = ratios("masks", r"([0-9]+) sprites, (.*) / the best pygame program")
    recipe, move, step = (
        " and ".join(f"{found[count, name]:.2f}" for count in ("300", "2000"))
        for name in ("the docs' recipe", "move, step, touching", "step")
    )
    return (
        f"Of the time of the best pygame program that we know, sorted along x, a frame takes {recipe} with 300 and "
        f"with 2,000 sprites; with arrays of ids and positions {move}; a step of bodies with velocities {step}"
    )


def crater():
    (share,) = ratios("masks", r"(carve of a terrain / pygame's erase)").values()
    return (
        f"A crater of 24 px in 4,096 x 1,024 px takes {100 * share:.0f} % of the time of pygame's `erase` and "
        "`connected_components`"
    )


def sinks():
    """Return two phrases on overlaps.

    The first is about a heavy body on a light one, with substeps by load. The second is about a high column, with four
    substeps.
    """
    rows = kept("study.json")["rows"]
    heavy, column = (rows["ratio_1000_on_1"]["engines"]["auto"], rows["crooked_40"]["engines"]["hb4"])
    assert heavy["fell"] is None and column["stood"] == column["seeds"] > 1
    return [
        f"a body 1,000 times as heavy as its support sinks in by {heavy['figure']:.1f} mm",
        f"with four, columns 2 cm askew stand forty high, {column['figure']:.0f} mm in one another",
    ]


def study():
    found = kept("study.json")["rows"]
    met = {name: sum(row["engines"][name]["met"] for row in found.values()) for name in ("auto", "hb4", "pymunk")}
    return (
        f"runs {len(found)} of the hard cases beside the peers that pip installs: by load {met['auto']} are within "
        f"their limits, with four substeps {met['hb4']}, in pymunk {met['pymunk']}"
    )


def disk():
    return f"It takes about {round(kept('bench/0.1.0.json')['installed_mb'], -1)} MB of disk"


def suite_takes():
    minutes = kept("minutes.json")
    warm, cold = (minutes[f"the README's test command{where}"] for where in ("", ", with an empty cache"))
    return f"That takes {warm:.1f} minutes on two cores, {cold:.1f} where no kernel has been compiled yet"


def all_checks_take():
    return f"everything without numba on the oldest pygame, in {kept('minutes.json')['run in all']:.0f} min"


def reports_take():
    return [
        f'tables and raw data (`pip install -e ".[bench]"`): {total_seconds(kept("accuracy.json")) / 60:.0f} minutes',
        f"makes the report smaller and less certain: {kept('minutes.json')['quick report']:.1f} minutes",
    ]


def covered():
    return f"lines of `physics/` that tests run, kernels as Python: {coverage.share(coverage.kept()):.1f} %"


def scenes_and_labs():
    labs = sum(name.startswith("lab/") for name in SCENES)
    return f"{NUMBERS[len(SCENES) - labs]} games and {NUMBERS[labs]} labs"


def gallery_pages():
    return [f"`lab/gallery` | {len(PAGES)} hard cases", f"`lab/gallery` shows {NUMBERS[len(PAGES)]} of them"]


def tasks():
    count = len(re.findall("^## ", (KEPT / "cookbook.md").read_text(), re.MULTILINE))
    return f"{NUMBERS[count]} tasks with their code"


def of_this_version():
    """Return the phrases with counts that the changelog must contain."""
    labs, joints = sum(name.startswith("lab/") for name in SCENES), (KEPT / "stability.md").read_text()
    return [
        f"{NUMBERS[labs].capitalize()} labs",
        f"`lab/gallery` shows {NUMBERS[len(PAGES)]} hard cases",
        f"Joints of {NUMBERS[len(KINDS)]} kinds",
        f"{NUMBERS[len(all_invariants())].capitalize()} invariants",
        f"{len(re.findall(r'^[|] N[0-9]+ [|]', joints, re.M))} scenes of them",
    ]


SENTENCES = {
    "CHANGELOG.md": (of_this_version,),
    "README.md": (
        pyramids,
        at_equal_overlap,
        moving,
        sinks,
        study,
        disk,
        suite_takes,
        all_checks_take,
        scenes_and_labs,
        gallery_pages,
        tasks,
    ),
    "CONTRIBUTING.md": (covered,),
    "docs/manual.md": (reports_take,),
    "docs/physics_alone.md": (sweeps_lead, best_program, crater, tasks),
}


def sentences(function):
    said = function()
    return [words(each) for each in ([said] if isinstance(said, str) else said)]


@pytest.mark.parametrize(
    ("page", "function"),
    [pytest.param(page, each, id=each.__name__) for page, some in SENTENCES.items() for each in some],
)
def test_the_page_says_what_was_measured(page, function):
    text = words((ROOT / page).read_text())
    for each in sentences(function):
        assert each in text, f"{page} does not say: {each}"


@pytest.mark.parametrize(
    "page", ["README.md", "CONTRIBUTING.md", "docs/cookbook.md", "docs/manual.md", "docs/physics_alone.md"]
)
def test_no_figure_stands_without_its_source(page):
    text = words(re.sub(r"```.*?```", "", (ROOT / page).read_text(), flags=re.DOTALL))
    held = [each for function in SENTENCES.get(page, ()) for each in sentences(function)]
    for each in [*held, *(said for where, said in CHOSEN if where == page)]:
        text = text.replace(each, "")
    loose = [text[max(0, each.start() - 60) : each.end() + 20] for each in FIGURE.finditer(text)]
    assert not loose, f"{page}: figures that no kept measurement is named for here: {loose}"
