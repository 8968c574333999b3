"""docs/coming_from.md: every code fragment for Hitbox runs, every count matches its table, and names occur once."""

import ast
import math
import pickle
import re
from collections import Counter
from pathlib import Path

import pygame
import pytest

from physics import Circle, Effects, Polygon, World, collide
from tests.reference.examples import prepared

PAGE = Path(__file__).resolve().parent.parent / "docs" / "coming_from.md"
TEXT = PAGE.read_text(encoding="utf-8")
CELLS = re.compile(r"(?<!\\)\|")
SPAN = re.compile(r"`([^`]+)`")
TODAY = ("yes", "partly", "no")


def rows(heading):
    """Return the rows of the first table below a heading as lists of cells, without the table's header."""
    section = re.search(rf"^##+ {re.escape(heading)}\n(.*?)(?=^##|\Z)", TEXT, re.S | re.M)
    assert section, f"no heading {heading}"
    lines = [line for line in section.group(1).split("\n") if line.startswith("|")]
    return [[cell.strip() for cell in CELLS.split(line)[1:-1]] for line in lines[2:]]


def fragments():
    """Return (line of the page, code) of each code span in the last column of the tables about names and habits."""
    found = []
    for heading in ("What is different", "From pymunk", "From Box2D", "From pygame"):
        for row in rows(heading):
            line = TEXT[: TEXT.index(row[-1])].count("\n") + 1
            found += [(line, code) for code in SPAN.findall(row[-1])]
    return found


def ready():
    """Return the names of a prepared world, plus those that the page's first code block defines."""
    names = prepared()
    block = re.search(r"^```python\n(.*?)^```", TEXT, re.S | re.M)
    assert block
    exec(block.group(1), names)
    return names


@pytest.mark.parametrize(("line", "code"), fragments(), ids=lambda value: str(value)[:60])
def test_a_fragment_runs(line, code):
    names = ready()
    try:
        tree = ast.parse(code, mode="eval")
    except SyntaxError:
        exec(compile(code, f"docs/coming_from.md:{line}", "exec"), names)
    else:
        value = eval(compile(tree, f"docs/coming_from.md:{line}", "eval"), names)
        if isinstance(tree.body, ast.Compare):  # a statement about this physics, which has to hold
            holds = value if isinstance(value, bool) else value.dtype == bool
            assert holds, f"docs/coming_from.md:{line}: {code} does not hold"


def test_there_are_fragments_in_most_rows():
    for heading in ("What is different", "From pymunk", "From Box2D", "From pygame"):
        table = rows(heading)
        without = [row[0] for row in table if not SPAN.search(row[-1])]
        assert len(without) <= 2, f"{heading}: no code beside {without}"
    assert len(fragments()) > 200


LEAST_ROWS = {"From pymunk": 70, "From Box2D": 80, "From pygame": 30}
LOOKED_FOR = {
    "From pymunk": "add_collision_handler ShapeFilter cpBodySleep collision_type segment_query_first damping",
    "From Box2D": "b2World_CastRayClosest b2ContactBeginTouchEvent b2ContactHitEvent b2MouseJoint groupIndex",
    "From pygame": "collide_mask overlap( collidelist( groupcollide kill() from_surface clock.tick Vector2",
}


@pytest.mark.parametrize("heading", LEAST_ROWS)
def test_what_is_looked_for_has_a_row(heading):
    table = rows(heading)
    names = [row[0] for row in table]
    missing = [word for word in LOOKED_FOR[heading].split() if not any(word in name for name in names)]
    assert len(table) >= LEAST_ROWS[heading] and not missing, (len(table), missing)
    assert len(set(names)) == len(names), "a name has two rows"


def counts_in(pattern):
    """Return the integers that the groups of a pattern match in the page."""
    match = re.search(pattern, TEXT)
    assert match, pattern
    return [int(each) for each in match.groups()]


def test_the_examples_of_pymunk_are_counted():
    table = rows("The 34 examples of pymunk")
    names, today = [row[0] for row in table], Counter(row[1] for row in table)
    assert len(set(names)) == len(names) == 34 and names == sorted(names)
    assert set(today) == set(TODAY)
    said = counts_in(r"version 7\.3: (\d+) can be built, (\d+) partly, (\d+) not")
    assert said == [today[each] for each in TODAY]
    assert all(row[2] for row in table if row[1] != "yes"), "what is missing has to be said"


def samples(cell):
    """Return the comma-separated names in a table cell, without text in brackets."""
    return [each for each in re.sub(r" \([^)]*\)", "", cell).split(", ") if each]


def test_the_samples_of_box2d_are_counted():
    table, total, names = rows("The 140 samples of Box2D"), Counter(), []
    for category, number, *cells in table:
        found = [samples(cell) for cell in cells]
        assert sum(map(len, found)) == int(number), f"{category} has {number} samples"
        total.update(dict(zip(TODAY, map(len, found), strict=True)))
        names += [(category, name) for each in found for name in each]
        for cell in cells[1:]:
            assert len(samples(cell)) == cell.count("("), f"{category}: say why, of each of {samples(cell)}"
    assert len(set(names)) == len(names) == sum(total.values()) == 140
    assert counts_in(r"by category: (\d+) can be built, (\d+) partly, (\d+) not") == [total[each] for each in TODAY]


def test_statements_about_masks_boxes_and_copies_hold():
    """Statements of the page hold: a box half a pixel smaller acts as Rect.colliderect, a World can be pickled, damping
    is drag.
    """
    for dx in range(-25, 26):
        rects = pygame.Rect(0, 0, 20, 20), pygame.Rect(dx, 7, 20, 20)
        box = Polygon.box(19.5, 19.5)
        assert bool(len(collide(box, (10, 10), box, (10 + dx, 17)))) == bool(rects[0].colliderect(rects[1]))
    world = World(Effects(response=True, drag=True), drag=-math.log(0.9))
    ball = world.add_body(Circle(5), velocity=(100, 0))
    other = pickle.loads(pickle.dumps(world))
    for _ in range(60):
        world.step()
        other.step()
    assert ball.velocity.x == pytest.approx(90.0, abs=0.1) and other.digest() == world.digest()
