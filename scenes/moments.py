"""Twelve moments of each game, which filming.py finds while the bot plays, and which docs/moments.png shows.

A moment is defined by an event in the game, not by a frame number, so that it is found again after the game has
changed. Moments are searched for one after the other, in the order given here.

The condition of a moment is a function of the scene that returns whether the event has occurred. Each function of this
module returns such a condition.
"""

from collections.abc import Callable
from dataclasses import dataclass

SEED = 1


@dataclass(frozen=True)
class Moment:
    """An event in a game. when(scene): condition that is True once the event has occurred.

    The picture is taken `after` steps later.
    """

    caption: str
    when: Callable
    after: int = 0


def flying(kind, least):
    """Return a condition, f(scene) -> bool: there are at least `least` planes of the kind `kind` in the picture."""
    return lambda scene: (
        sum(plane.kind == kind and 16 < plane.y < 200 and 20 < plane.x < 460 for plane in scene.fleet.planes.values())
        >= least
    )


def leader(frame, bullets=0):
    """Return a condition, f(scene) -> bool: a mid-boss or boss fights, with many enemy bullets in play.

    frame: name of the leader's picture; bullets: least number of enemy bullets.
    """
    return lambda scene: (
        len(scene.incoming) >= bullets
        and any(plane.leads and plane.frame == frame and plane.mode == "fight" for plane in scene.fleet.planes.values())
    )


def falling(kind):
    """Return a condition, f(scene) -> bool: a mid-boss or boss of the kind `kind` is burning and falling."""
    return lambda scene: any(
        plane.leads and plane.kind == kind and plane.mode == "fall" for plane in scene.fleet.planes.values()
    )


def over(ground, bullets, planes=0):
    """Return a condition, f(scene) -> bool: the planes fly over a given landscape, with enough enemies in play.

    ground: name of the landscape, such as "coast"; bullets: least number of enemy bullets; planes: least number of
    enemy planes.
    """
    return lambda scene: (
        scene.director.ground == ground and len(scene.incoming) >= bullets and len(scene.fleet.planes) >= planes
    )


def bombed(frame):
    """Return a condition, f(scene) -> bool: the player has just dropped a bomb in a fight against a mid-boss or boss.

    frame: name of the picture of the mid-boss or boss.
    """
    fights = leader(frame)
    return lambda scene: scene.bomb.body is not None and scene.bomb.age < 3 and fights(scene)


def done(feat, times=1):
    """Return a condition, f(scene) -> bool: the hero has done the feat `feat` at least `times` times.

    feat: name of the feat, as in Feats.
    """
    return lambda scene: scene.feats.done[feat] >= times


def flown(act, number):
    """Return a condition, f(scene) -> bool: the lander's bot has come far enough.

    It flies to waypoint number `number` of act `act`, or to a later one.
    """
    return lambda scene: scene.pilot.act == act and scene.pilot.number >= number


def landing(name, high):
    """Return a condition, f(scene) -> bool: the lander is just above the landing site `name`.

    high: greatest height above the site [px], approximately.
    """
    return lambda scene: (
        scene.course.site.name == name
        and abs(scene.ship.x - scene.course.site.x) < 30.0
        and 16.0 < scene.course.site.y - scene.ship.y < 16.0 + high
    )


def landed(count, mode):
    """Return a condition, f(scene) -> bool: the ship has landed `count` times, and the course is in the mode `mode`."""
    return lambda scene: scene.score.landings == count and scene.course.mode == mode


MOMENTS = {
    "shooter": (
        Moment("weavers, and the first gun", flying("saucer", 6)),
        Moment("hornets from both sides", flying("hornet", 5)),
        Moment("gun platforms on the islands", flying("turret", 2), 70),
        Moment("a gunship, and more power", flying("gunship", 1), 100),
        Moment("over the coast", over("coast", 36, 5)),
        Moment("mid-boss: the heavy bomber", leader("midboss_0", 70)),
        Moment("and its end", falling("midboss"), 120),
        Moment("twin gunships in the storm", flying("gunship", 2), 90),
        Moment("the last wave", over("storm", 110, 6)),
        Moment("boss, first phase: broadside", leader("boss_a_0", 85)),
        Moment("second phase: walls of iron, and a bomb", bombed("boss_b_0"), 14),
        Moment("third phase: the eye of the storm", leader("boss_c_0", 1400)),
    ),
    "platformer": (
        Moment("push a crate", done("pushed a crate", 8)),
        Moment("a secret under the planks", lambda scene: scene.secrets == 1, 6),
        Moment("stomp the walker", done("stomps"), 4),
        Moment("ride the lift", done("lift", 60)),
        Moment("climb down into the cave", done("ladder", 60)),
        Moment(
            "bats wake",
            lambda scene: any(enemy.kind == "bat" and enemy.seen for enemy in scene.things.enemies.values()),
            40,
        ),
        Moment("stones that crumble", done("crumbled"), 2),
        Moment("belts carry heroes and crates", done("belt", 24)),
        Moment("lifts take crates along", done("lift with a crate", 60)),
        Moment("jump from wall to wall", done("wall jumps", 2), 6),
        Moment("the keep: a lift takes all that stands on it", done("lift with an enemy", 40)),
        Moment("the flag", lambda scene: scene.phase == "won", 30),
    ),
    "lander": (
        Moment("up from the base", lambda scene: scene.frame >= 40),
        Moment("cargo on the line", lambda scene: scene.line.load is not None, 70),
        Moment("down into Frost Canyon", flown(0, 8), 30),
        Moment("soft and upright", landing("canyon", 34.0)),
        Moment("the first site, and a full tank", landed(1, "landed"), 60),
        Moment("ice has closed the cave", lambda scene: scene.pilot.aiming and scene.score.fired >= 1, 12),
        Moment("shells carve their way", lambda scene: scene.pilot.aiming and scene.score.fired >= 4, 16),
        Moment("into Crystal Cave", flown(1, 9), 50),
        Moment("between teeth of stone", landing("cave", 70.0)),
        Moment(
            "out through the roof", lambda scene: scene.pilot.act == 2 and scene.pilot.aiming and scene.gun.shells, 26
        ),
        Moment("Storm Mesa in the gusts", landing("mesa", 70.0)),
        Moment("a medal", lambda scene: scene.course.mode == "won", 30),
    ),
}
