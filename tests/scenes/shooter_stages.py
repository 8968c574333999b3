"""Short stages for tests, made from the game's own stage, and a shooter scene that a test plays step by step."""

import copy
import json
from math import pi

from game.input.inputs import InputFrame, InputState
from scenes.shooter.scene import Shooter
from scenes.shooter.stage import STAGE, Group


def own_stage():
    """Return the content of the game's own stage file as a new dict."""
    return json.loads(STAGE.read_text(encoding="utf-8"))


def leader_of(data, kind):
    """Return the event of the mid-boss or the boss in a stage. kind: "midboss" or "boss"."""
    return next(event for event in data["events"] if event["event"] == kind)


def write(path, data):
    """Write a stage to a file and return its path."""
    path.write_text(json.dumps(data), encoding="utf-8")
    return path


def boss_stage(path, phases=(0, 1, 2), **changes):
    """Write a stage that has only its boss, with some of its phases and changed fields of them. Return its path."""
    data = own_stage()
    boss = copy.deepcopy(leader_of(data, "boss"))
    boss["at"] = 0.1
    boss["phases"] = [dict(boss["phases"][number], **changes) for number in phases]
    data["events"] = [data["events"][0], boss]
    return write(path, data)


def midboss_stage(path, **changes):
    """Write a stage with a mid-boss, then the boss. changes: fields of the mid-boss's first phase. Return its path."""
    data = own_stage()
    midboss, boss = (copy.deepcopy(leader_of(data, kind)) for kind in ("midboss", "boss"))
    midboss["at"], boss["at"] = 0.1, 0.5
    midboss["phases"][0].update(changes)
    data["events"] = [data["events"][0], midboss, boss]
    return write(path, data)


class Sky:
    """A shooter without waves of enemies, in which the plane can be hit from the first step on."""

    def __init__(self, quiet=True, **chosen):
        self.scene = Shooter(seed=1, **chosen)
        self.inputs = InputState()
        if quiet:
            self.scene.director.step = lambda sky: None
        self.step(100)
        self.harm()

    def harm(self):
        """End the plane's invulnerability, and make one step."""
        self.scene.plane.safe = 0
        self.step()

    def step(self, count=1, actions=(), changes=()):
        """Make `count` steps while actions are held. changes: (name, value) pairs of settings to change."""
        for _ in range(count):
            self.inputs.set(InputFrame(frozenset(actions), changes=tuple(changes)))
            self.scene.step(self.inputs)

    def until(self, reached, most=2000, actions=()):
        """Step until reached() is true, and return the number of steps. Fails if it is not true within `most` steps."""
        for number in range(most):
            if reached():
                return number
            self.step(1, actions)
        raise AssertionError(f"not reached within {most} steps")

    def enemy(self, kind, x, y, thinks=False, **group):
        """Return a new enemy plane at (x, y). thinks: True lets it move and fire; otherwise it does neither."""
        group.setdefault("side", "left")
        made = Group(kind, (0.5,), 0.5, 0.0, "", **group)
        plane = self.scene.fleet.launch(made, 0.5)
        if not thinks:
            plane.think = lambda sky: None
        self.scene.world.body(plane.id).move_to((x, y))
        return plane

    def bullet(self, look, x, y, heading=1.5707963267948966, speed=0.0):
        """Fire an enemy bullet, and make one step, which adds it to the world. Return its id."""
        self.scene.incoming.fire(look, x, y, [heading], speed)
        self.step()
        return int(self.scene.incoming.ids[-1])


def struck_down(kind="gunship", x=240.0, y=90.0, power=0.1, **chosen):
    """Return (sky, plane): a `Sky` and an enemy plane that was just shot down. power: the enemy's health."""
    sky = Sky(**chosen)
    plane = sky.enemy(kind, x, y)
    plane.health = power
    sky.scene.shots.fire("shot", x + 6.0, y + 70.0, [-pi / 2], 560.0)
    sky.until(lambda: len(sky.scene.wreckage), 60)
    return sky, plane
