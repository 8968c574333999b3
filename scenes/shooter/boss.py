"""The leaders: mid-boss and boss. A leader fights in phases, each with its own health, timer, path and guns.

Between two phases the leader cannot be hurt and does not fire, and all bullets are removed.
"""

from math import pi, sin

from scenes.shooter.cast import FALLING, WIDTH, steps
from scenes.shooter.enemies import Enemy
from scenes.shooter.patterns import Gun
from scenes.shooter.stage import Group

LOOKS = ("midboss_0", "boss_a_0", "boss_b_0", "boss_c_0")
ENTRY_Y, HOME_Y = -60.0, 70.0  # [px]
ARRIVE_SPEED, SWING_SPEED = 95.0, 130.0  # [px/s]
CHANGE = steps(1.6)  # steps between two phases
DRESSED = steps(0.5)  # steps after a phase's end until the picture of the next phase appears, behind the smoke
FALL = steps(2.6)  # steps that a beaten leader burns before it breaks
SINK = 14.0  # [px/s] downward speed while it burns
ALMOST = 5.0  # [s] before the end of a phase: from then on its timer is red and shows tenths


class Leader(Enemy):
    """A mid-boss or boss.

    number: index of the current phase; clock: remaining steps of this phase; beaten: True if the player won the last
    finished phase, False if its time ran out.
    """

    heavy = leads = True

    def __init__(self, event):
        group = Group("", (0.5,), 1.0, 0.0, "", HOME_Y)
        super().__init__(WIDTH / 2, ENTRY_Y, group, event)  # an Event has the same factors as a Difficulty
        self.kind, self.name, self.phases = event.event, event.name, event.phases
        self.number = 0
        self.beaten = False
        self._take_up()

    @property
    def phase(self):
        """The current Phase of the leader's fight."""
        return self.phases[self.number]

    @property
    def last(self):
        """True if the leader's current phase is its last one."""
        return self.number + 1 == len(self.phases)

    @property
    def sheltered(self):
        """True while the leader cannot be hurt."""
        return self.mode != "fight"

    @property
    def seconds_left(self):
        """Remaining time of the current phase [s]."""
        return self.clock / 60

    def _take_up(self):
        """Start phase `self.number` of the fight: set its health, timer, guns and picture."""
        self.health = self.full = float(self.phase.health)
        self.clock = steps(self.phase.seconds)
        self.guns = [Gun(pattern) for pattern in self.phase.patterns]
        self.frame = "midboss_0" if self.kind == "midboss" else f"boss_{'abc'[self.number]}_0"

    def think(self, sky):
        """Set the velocity for the next step and fire, as the leader's mode requires. sky: the scene.

        The modes are "arrive", "fight", "change", "fall" and "leave".
        """
        if self.mode == "arrive":
            if self.approach(self.home_x, self.home_y, ARRIVE_SPEED) < 3.0:
                self.begin("fight")
        elif self.mode == "fight":
            self._swing()
            fired = [gun.step(sky, self.x, self.y) for gun in self.guns]
            if any(fired):
                sky.spectacle.leader_fires(self)
            self.clock -= 1
            if self.clock <= 0:
                sky.end_phase(self, beaten=False)
        elif self.mode == "change":
            self.approach(self.home_x, self.home_y, SWING_SPEED)
            if self.since == DRESSED:
                self.number += 1
                self._take_up()
            if self.since >= CHANGE:
                self.begin("fight")
        elif self.mode == "fall":
            self.vx, self.vy = self.vx * 0.94, SINK
            sky.spectacle.leader_burns(self, FALL)
            if self.since >= FALL:
                sky.bury(self)
        else:
            self.vx, self.vy = self.vx * 0.96, max(self.vy - 2.0, -110.0)

    def _swing(self):
        """Set the velocity for a slow path in the form of an eight around the leader's home position."""
        move, turn = self.phase.move, 2 * pi * self.since / 60 / self.phase.move.seconds
        self.approach(self.home_x + move.across * sin(turn), self.home_y + move.down * sin(2 * turn), SWING_SPEED)

    def end_phase(self, beaten):
        """End the current phase. After the last phase the leader falls if `beaten` is True; otherwise it flies away."""
        self.beaten = beaten
        if not self.last:
            self.begin("change")
        else:
            self.begin("fall" if beaten else "leave")
            self.side = FALLING

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return (
            *super().state(),
            self.number,
            self.clock,
            self.beaten,
            *(value for gun in self.guns for value in gun.state()),
        )
