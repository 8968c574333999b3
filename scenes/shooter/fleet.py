"""All enemies in play: this module launches, steps and removes them, and sets their shapes."""

from math import pi

from game.drawing.sprites import load_atlas
from scenes.shooter.boss import LOOKS, Leader
from scenes.shooter.cast import GROUNDED
from scenes.shooter.difficulty import EASY
from scenes.shooter.enemies import NOTCH, Dart, Gunship, Saucer
from scenes.shooter.flankers import Hornet, Turret

KINDS = {each.kind: each for each in (Dart, Saucer, Gunship, Hornet, Turret)}
DIVES = 20  # notches to either side of straight down: darts dive no flatter
SIDEWAYS = 10  # half notches to either side of straight up: side bullets lean no further
ALL_AROUND = 32  # hornets fly in all directions


class Fleet:
    """The enemies in play. planes: {body id: Enemy}, in the order of launch; tier: collision tier of their shapes."""

    def __init__(self, world, tier):
        self.world, self.tier = world, tier
        self.planes = {}
        self.longest = 0  # longest time in the sky of an enemy without a timer of its own [steps]

    def __len__(self):
        return len(self.planes)

    @property
    def leader(self):
        """The mid-boss or boss in play, or None."""
        return next((plane for plane in self.planes.values() if plane.leads), None)

    def launch(self, group, share, carries="", difficulty=EASY, wave=0, scrolled=0.0):
        """Launch one plane of a Group, and return it.

        share: position along the edge at which it enters, 0..1; carries: item that it drops, or ""; wave: number of
        its wave; scrolled: distance that the ground has moved [px].
        """
        made = KINDS[group.kind]
        plane = made(*made.entry(group, share), group, difficulty)
        if plane.side is GROUNDED:
            plane.y += scrolled % 1.0  # so that it moves from pixel to pixel together with the ground
        plane.carries, plane.wave = carries, wave
        return self._add(plane)

    def launch_leader(self, event):
        """Launch the mid-boss or boss of an Event, and return it."""
        return self._add(Leader(event))

    def _add(self, plane):
        body = self.world.add_body(
            load_atlas("planes").mask(plane.frame),
            position=(plane.x, plane.y),
            angle=plane.angle,
            kind="kinematic",
            filter=plane.side,
            tier=self.tier,
        )
        plane.id = body.id
        self.planes[body.id] = plane
        return plane

    def step(self, sky):
        """Let every plane choose its motion and fire, and write its velocity and angle into world.bodies. sky: the
        scene.
        """
        if not self.planes:
            return
        planes = list(self.planes.values())
        rows, bodies = self.world.rows(list(self.planes)), self.world.bodies
        places = zip(planes, bodies["x"][rows].tolist(), bodies["y"][rows].tolist(), strict=True)
        for plane, plane.x, plane.y in places:
            plane.age += 1
            plane.since += 1
            before, side = plane.frame, plane.side
            plane.think(sky)
            if not plane.leads:
                self.longest = max(self.longest, plane.age)
            if plane.frame != before:
                dress(self.world, plane.id, plane.frame, self.tier)
            if plane.side != side:
                self.world.body(plane.id).filter = plane.side
        bodies = self.world.bodies
        for column in ("vx", "vy", "angle"):
            bodies[column][rows] = [getattr(plane, column) for plane in planes]

    def forget(self, ids):
        """Remove the planes with the given body ids (an array) from the table."""
        for identity in ids.tolist():
            self.planes.pop(identity, None)


def dress(world, identity, frame, tier):
    """Set the mask of the picture `frame` as the shape of a plane's body.

    identity: id of the body; tier: collision tier of the shape.
    """
    body = world.body(identity)
    body.set_shapes(load_atlas("planes").mask(frame))
    body.tier = tier


def draw_turned():
    """Rotate the masks of all planes and bullets that turn, to cache them before the first step (1.7 ms each)."""
    planes, effects = load_atlas("planes"), load_atlas("effects")
    for frames, notches in ((("dart_0", "dart_1"), DIVES), (("hornet_0",), ALL_AROUND)):
        for notch in range(-notches, notches + 1):
            for frame in frames:
                planes.mask(frame).turned(notch * NOTCH)
    for notch in range(-DIVES, DIVES + 1):
        effects.mask("bullet_needle").turned(pi + notch * NOTCH)
    for notch in range(-SIDEWAYS, SIDEWAYS + 1):
        effects.mask("side_bullet").turned(notch * NOTCH / 2)
    for frame in (*LOOKS, *(made.frame for made in KINDS.values())):
        planes.mask(frame).turned(0.0)
