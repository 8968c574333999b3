"""A bomb is carried, thrown and explodes; the pixels of a wall become rubble that falls, rests,
is pushed and climbed.
"""

import copy

import numpy as np
import pytest

from game.input.inputs import InputFrame
from game.run.digest import scene_digest
from game.run.session import Session
from game.run.sources import ScriptSource
from scenes.platformer.blasting import BACK, BURNS, CARRIED, GONE, THROWN, WAITING
from scenes.platformer.feel import HEIGHT, RUN_SPEED, steps
from scenes.platformer.scene import Platformer


class Cave:
    """The game's own level, with the hero beside the bomb."""

    def __init__(self, kind=Platformer):
        self.scene = kind(seed=1)
        self.keys = []
        self.session = Session(self.scene, self)
        (self.bomb,), (self.wall,) = self.scene.things.bombs, self.scene.things.walls
        self.floor = self.wall.top + self.wall.size[1]
        self.put(self.bomb.home[0])

    def next(self, scene):
        return InputFrame(frozenset(self.keys))

    def put(self, x):
        self.scene.hero.place((x, self.floor - HEIGHT / 2))

    def run(self, keys="", count=1):
        self.keys = keys.split()
        for _ in range(count):
            self.session.step()

    def until(self, met, keys="", most=300):
        for _ in range(most):
            if met():
                return
            self.run(keys)
        raise AssertionError(f"not within {most} steps; the bomb is {self.bomb.phase} at {self.bomb.place}")

    def blow(self):
        """Throw the bomb from a position from which it reaches the wall, and wait until all rubble sleeps."""
        self.run("", 2)
        right = self.wall.left + self.wall.size[0]
        self.until(lambda: self.scene.hero.character.position[0] < right + 62, "left")
        self.run("left focus")
        self.until(lambda: self.bomb.phase == GONE, "right")
        self.run("", 150)
        self.until(lambda: not any(piece.body.awake for piece in self.scene.things.rubble))


class Over:
    """Source of input that runs to a position and jumps over obstacles."""

    held = 0

    def __init__(self, x):
        self.x = x

    def next(self, scene):
        way = -1 if scene.hero.character.position[0] > self.x else 1
        self.held = 14 if scene.hero.wall == way and scene.hero.grounded and not self.held else max(self.held - 1, 0)
        keys = {"left" if way < 0 else "right"}
        return InputFrame(frozenset(keys | {"jump"} if self.held else keys))


@pytest.fixture(scope="module")
def blown():
    cave = Cave()
    cave.blow()
    return cave


def test_the_bomb_is_taken_carried_and_thrown_by_the_key():
    cave = Cave()
    assert cave.bomb.phase == WAITING
    cave.run("", 2)
    assert cave.bomb.phase == CARRIED
    cave.run("left", 20)
    x, y = cave.scene.hero.character.position
    assert cave.bomb.place == (x, y - 7.0) and cave.bomb.body is None
    cave.run("left focus")
    cave.run("", 2)
    assert cave.bomb.phase == THROWN and cave.bomb.body.velocity.x < -150.0
    cave.run("", steps(BURNS))
    assert cave.bomb.phase == GONE and cave.bomb.body is None


def test_down_lays_it_before_the_feet():
    cave = Cave()
    cave.run("right", 2)
    x = cave.scene.hero.character.position[0]
    cave.run("down focus")
    cave.run("", 40)
    assert abs(cave.bomb.place[0] - x) < 30.0


def test_wasted_it_comes_back_and_the_wall_stands():
    cave = Cave()
    pixels = cave.wall.body.shapes[0].area
    cave.run("right", 3)
    cave.run("right focus")
    cave.until(lambda: cave.bomb.phase == GONE)
    cave.put(cave.bomb.home[0] - 100)
    cave.run("", steps(BACK) + 1)
    assert cave.bomb.phase == WAITING and cave.wall.body.shapes[0].area == pixels
    assert not cave.scene.things.rubble


def test_carried_too_far_it_is_back_and_so_it_is_after_a_new_life():
    cave = Cave()
    cave.run("", 2)
    cave.put(cave.bomb.home[0] + 430)
    cave.run()
    assert cave.bomb.phase == WAITING
    cave.put(cave.bomb.home[0])
    cave.run("", 2)
    assert cave.bomb.phase == CARRIED
    cave.scene._lose()
    cave.until(lambda: cave.scene.phase == "playing" and cave.scene.since > 2, most=200)
    assert cave.bomb.phase == WAITING


def test_the_wall_stops_him_until_it_is_blown_and_its_gem_is_behind_it(blown):
    cave = Cave()
    right = cave.wall.left + cave.wall.size[0]
    cave.put(right + 30)
    cave.run("left", 60)
    assert cave.scene.hero.box[0] == right
    gem = min(cave.scene.things.of("secret"), key=lambda each: abs(each.x - cave.wall.left))
    assert cave.wall.left - 120 < gem.x < cave.wall.left
    other = copy.deepcopy(blown.scene)
    session = Session(other, Over(gem.x))
    while other.secrets == 0 and other.frame < blown.scene.frame + 300:
        session.step()
    assert other.secrets == 1


def test_pieces_could_not_turn_without_rotation():
    stiff = type("Stiff", (Platformer,), {"effects": Platformer.effects.with_(rotation=False)})
    with pytest.raises(ValueError, match="needs the effect rotation"):
        Cave(stiff).blow()


def test_rubble_is_the_walls_own_pixels_and_comes_to_rest(blown):
    pieces = blown.scene.things.rubble
    assert len(pieces) >= 4 and blown.wall.body is None and blown.scene.feats.done["walls blown"] == 1
    found = np.zeros(blown.wall.size[::-1], int)
    for piece in pieces:
        (mask,) = piece.body.shapes
        height, width = mask.solid.shape
        found[piece.top : piece.top + height, piece.left : piece.left + width] += mask.solid
        assert not piece.body.awake, "all of it sleeps"
        assert piece.body.bounds[3] <= blown.floor + 0.6
    assert found.max() == 1 and 400 < found.sum() < blown.wall.size[0] * blown.wall.size[1]


def test_rubble_is_walked_on_and_pushed(blown):
    scene = copy.deepcopy(blown.scene)
    pieces = scene.things.rubble
    largest = max(pieces, key=lambda each: each.body.mass)
    left, top, right, _ = largest.body.bounds
    scene.hero.place(((left + right) / 2, top - 30))
    session = Session(scene, ScriptSource([]))
    for _ in range(60):
        session.step()
    hero = scene.hero
    assert hero.grounded and hero.box[3] < blown.floor - 4, "he stands on it, not in it"
    assert hero.riding is not None and hero.riding.user == "rubble"

    scene = copy.deepcopy(blown.scene)
    outer = max(scene.things.rubble, key=lambda each: each.body.bounds[2])
    before = outer.body.position.x
    scene.hero.place((outer.body.bounds[2] + 12, blown.floor - HEIGHT / 2))
    session = Session(scene, ScriptSource([["left"]] * 60))
    pushed = False
    for _ in range(60):
        session.step()
        pushed = pushed or scene.hero.pushing
    assert pushed and outer.body.position.x < before - 4.0
    assert abs(scene.hero.vx) <= RUN_SPEED


def test_a_burst_flattens_enemies_and_throws_him_back_without_hurting():
    cave = Cave()
    cave.run("", 2)
    enemy = next(iter(cave.scene.things.enemies.values()))
    cave.run("down focus")
    cave.run("", steps(BURNS) - 12)
    enemy.character.move_to((cave.bomb.place[0] + 40, cave.floor - enemy.size[1] / 2))
    thrown = False
    for _ in range(20):
        cave.run()
        thrown = thrown or "thrown" in cave.scene.hero.news or cave.scene.hero.vy < -150.0
    assert thrown and cave.scene.phase == "playing" and cave.scene.deaths == 0
    assert enemy.body.id not in cave.scene.things.enemies


def test_a_graze_only_chips_the_wall():
    cave = Cave()
    x, y = cave.wall.left + cave.wall.size[0] + 24, cave.floor - 20
    loose, hit = cave.scene.things.blast(x, y)
    assert hit and cave.wall.body is not None and not loose
    assert 0 < cave.wall.size[0] * cave.wall.size[1] - cave.wall.body.shapes[0].area < 200
    assert cave.scene.things.blast(x + 200, y) == ([], False)


def test_a_copy_made_while_rubble_falls_goes_on_alike():
    cave = Cave()
    cave.run("", 2)
    cave.put(cave.wall.left + cave.wall.size[0] + 60)
    cave.run("left")
    cave.run("left focus")
    cave.until(lambda: cave.scene.things.rubble)
    twin = copy.deepcopy(cave.scene)
    for scene in (cave.scene, twin):
        session = Session(scene, ScriptSource([["right"]] * 40))
        for _ in range(60):
            session.step()
    assert scene_digest(twin) == scene_digest(cave.scene)
