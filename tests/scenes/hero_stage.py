"""A small level made of letters with the platformer's hero in it, for tests of the hero's moves."""

import numpy as np

from game.drawing.tilemap import Thing, TileMap
from game.input.inputs import InputFrame, InputState
from physics import World
from scenes.platformer.bridge import Bridge
from scenes.platformer.feel import GRAVITY, HEIGHT
from scenes.platformer.hero import Hero
from scenes.platformer.level import Level
from scenes.platformer.scene import Platformer, others
from scenes.platformer.things import Belt, Crate, Crumble, Platform, Trigger

TILES = {"#": 0, "-": 1, "/": 2, "\\": 3, "1": 4, "2": 5}
PROPERTIES = {
    0: {"kind": "solid"},
    1: {"kind": "one_way"},
    2: {"kind": "slope", "left": 0.0, "right": 1.0},
    3: {"kind": "slope", "left": 1.0, "right": 0.0},
    4: {"kind": "slope", "left": 0.0, "right": 0.5},
    5: {"kind": "slope", "left": 0.5, "right": 1.0},
}


class Stage:
    """A small level made of letters with a hero in it; run(keys, steps) plays it."""

    def __init__(self, text, x, things=()):
        rows = text.strip("\n").split("\n")
        numbers = np.array([[TILES.get(letter, -1) for letter in row] for row in rows])
        empty = np.full_like(numbers, -1)
        self.level = Level(
            TileMap(
                "stage",
                numbers.shape[1],
                numbers.shape[0],
                16,
                {"solid": numbers, "decor": empty},
                {},
                PROPERTIES,
                "",
                1,
                tuple(things),
                {},
            )
        )
        self.world = World(Platformer.effects, gravity=(0.0, GRAVITY))
        self.level.add_to(self.world)
        floor = next(row for row in range(len(rows)) if rows[row][x] in "#-") * 16
        self.hero = Hero(self.world, self.level, (x * 16 + 8, floor - HEIGHT / 2))
        made = {
            kind: [cls(self.world, one) for one in things if one.kind == kind]
            for kind, cls in (
                ("platform", Platform),
                ("crate", Crate),
                ("belt", Belt),
                ("crumble", Crumble),
                ("ladder", Trigger),
                ("bridge", Bridge),
            )
        }
        self.platforms, self.crates, self.belts, self.crumbles, ladders, self.bridges = made.values()
        self.ladders = {ladder.body.id: ladder for ladder in ladders}
        self.inputs = InputState()
        self.frame = 0
        self.news = []
        self.run("", 2)
        self.news.clear()

    def run(self, keys, count=1):
        """Play `count` steps while keys are held. keys: names of actions, separated by spaces."""
        for _ in range(count):
            self.inputs.set(InputFrame(frozenset(keys.split())))
            for platform in self.platforms:
                platform.aim(self.frame)
            for crumble in self.crumbles:
                crumble.step()
            self.hero.crates = self.crates
            self.hero.solids = tuple(each.box for each in (*self.crates, *self.platforms, *self.belts, *self.crumbles))
            self.hero.bridges = self.bridges
            self.hero.step(self.inputs)
            self.news += self.hero.news
            self.world.step()
            self._read_ladders()
            self.frame += 1
        return self.hero

    def _read_ladders(self):
        me, events = self.hero.character.body.id, self.world.events
        for identity in others(events.sensor_end, me):
            self.hero.ladders.pop(identity, None)
        for identity in others(events.sensor_begin, me) & self.ladders.keys():
            self.hero.ladders[identity] = self.ladders[identity]

    def until(self, keys, met, most=200):
        """Hold keys until met(hero) is true, and return the hero. Fails if it is not true within `most` steps."""
        for _ in range(most):
            self.run(keys)
            if met(self.hero):
                return self.hero
        raise AssertionError(f"not within {most} steps of {keys!r}: {self.hero.box}")


def thing(kind, x, y, width, height, **properties):
    """Return an object of the level (`Thing`), without a name."""
    return Thing(kind, "", x, y, width, height, properties)
