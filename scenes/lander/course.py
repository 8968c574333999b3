"""The course: three landing sites in three acts, the landings, and the end of a game.

`scene.result` is set once, at the very end. The world continues to move behind the result.
"""

from game.drawing.number_text import count_text
from game.scene import Result
from scenes.lander.feel import FUEL, HULL, REARM, REFUEL, REPAIR, SETTLED, SHELLS, STRANDED, steps

FORGOTTEN = steps(0.6)  # steps in the air after which earlier impacts no longer count for the landing
TITLE = steps(4.2)  # steps for which the name of an act is shown
CHEER = steps(3.2)  # steps for which a landing's points are shown
# Steps from the last landing to the first bonus; between two bonuses; from the last bonus to the result.
FIRST_BONUS, NEXT_BONUS, SHOWN = steps(2.2), steps(0.5), steps(2.0)
FLYING, LANDED, CLEARED, WON, LOST = "flying", "landed", "cleared", "won", "lost"


class Course:
    """Progress of the player from landing site to landing site.

    act: number of the current site, 0..2; mode: FLYING, LANDED, CLEARED, WON or LOST; since: steps in this mode; rest:
    steps at rest on a pad.
    """

    def __init__(self, moon):
        self.moon = moon
        self.act, self.mode, self.since, self.rest, self.stranded = 0, FLYING, 0, 0, 0
        self.touchdown = 0.0  # [px/s] greatest speed at a contact since the ship was last in the air
        self.airborne = 0  # [steps] for which the ship has had no contact
        self.clock = 0  # [steps] time of the run, until the last landing
        self.counted = []  # (reason, points) of the last landing, or of the end so far

    @property
    def site(self):
        """The Pad that is the current landing site."""
        return self.moon.pads[self.act + 1]

    @property
    def over(self):
        """True once all sites have been reached or all ships are lost."""
        return self.mode in (CLEARED, WON, LOST)

    def _enter(self, mode):
        self.mode, self.since = mode, 0

    def step(self, scene):
        """Update the progress of `scene` after a step of its world."""
        self.since += 1
        self.clock += self.mode in (FLYING, LANDED)
        if self.mode == LANDED and self.since >= CHEER:
            self.act += 1
            self._enter(FLYING)
            scene.spectacle.act_begins()
        elif self.mode == CLEARED:
            self._count_bonuses(scene)
        if self.mode in (FLYING, LANDED):
            self._watch(scene)

    def touched(self, speed):
        """Record that the ship touched a body. speed: approach speed of the contact [px/s]."""
        self.touchdown = max(self.touchdown, speed)

    def _watch(self, scene):
        """Check whether the ship has landed, is stranded without fuel, or was the last ship and is lost."""
        ship = scene.ship
        self.airborne = 0 if ship.touching else self.airborne + 1
        if self.airborne == FORGOTTEN:
            self.touchdown = 0.0
        pad = scene.pad_below() if ship.quiet else None
        self.rest = self.rest + 1 if pad is not None else 0
        if pad is not None and self.rest >= SETTLED:
            ship.pad = pad
            self._serve(scene, ship)
            if pad is self.site and self.mode == FLYING:
                self._land(scene, ship, pad)
        helpless = ship.here and pad is None and ship.fuel <= 0.0 and bool(ship.touching)
        self.stranded = self.stranded + 1 if helpless else 0
        if self.stranded == STRANDED:
            scene.give_up()
        if not ship.here and not ship.lives and not ship.away:
            self._enter(LOST)
            scene.result = self._result(scene, won=False)

    def _serve(self, scene, ship):
        """Refuel, repair and rearm the ship for one step, while it rests on a pad."""
        filling = ship.fuel < FUEL or ship.hull < HULL
        ship.fuel, ship.hull = min(ship.fuel + REFUEL, FUEL), min(ship.hull + REPAIR, HULL)
        if self.rest % REARM == 0 and ship.shells < SHELLS:
            ship.shells += 1
            filling = True
        if filling:
            scene.spectacle.served(self.rest)

    def _land(self, scene, ship, pad):
        self.counted = scene.score.land(self.act + 1, self.touchdown, abs(ship.x - pad.x), ship.fuel, ship.hull)
        last = self.act == len(self.moon.pads) - 2
        self._enter(CLEARED if last else LANDED)
        scene.spectacle.landed(pad, last)
        if last:
            self.landing, self.counted = self.counted, []

    def _count_bonuses(self, scene):
        bonuses = self.landing + scene.score.final(self.clock / 60, scene.ship.lives, scene.yard.in_all)
        number = len(self.counted)
        if number < len(bonuses):
            if self.since == FIRST_BONUS + NEXT_BONUS * number:
                self.counted.append(bonuses[number])
                if number >= len(self.landing):
                    scene.score.add(bonuses[number][1])
                scene.play("coin", volume=0.6)
        elif self.since >= FIRST_BONUS + NEXT_BONUS * number + SHOWN:
            self._enter(WON)
            scene.result = self._result(scene, won=True)

    def _result(self, scene, won):
        score = scene.score
        lines = (
            f"{score.medal.lower()} medal" if won else f"{count_text(score.landings, 'site')} of 3 reached",
            f"cargo {score.delivered} of {scene.yard.in_all}, {count_text(score.lost, 'ship')} lost",
            f"softest touchdown {score.softest:.0f} px/s" if score.landings else "no touchdown that counts",
        )
        return Result(won, score.points, self.clock / 60, lines)

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return (
            self.act,
            self.mode,
            self.since,
            self.rest,
            self.stranded,
            self.touchdown,
            self.airborne,
            self.clock,
            len(self.counted),
        )
