"""Points of the shooter: the values of kills and grazes, and the chain that multiplies these values.

A graze is a bullet that passes close by the player without a hit. Each kill or graze adds a link to the chain. The
chain breaks after a while without kills and grazes, or when the player is hit.
"""

from scenes.shooter.cast import steps

CHAIN_STEP, TOP_CHAIN = 8, 8  # links that raise the multiplier by 1, and its greatest value
HOLD = steps(3.0)  # steps for which the chain lasts after a kill
GRAZE_HOLD = steps(0.75)  # steps by which a graze prolongs the chain, up to HOLD
GRAZE, BURNT, SPARE, WHOLE_WAVE = 20, 10, 1000, 500  # points, times the multiplier
FIRST_LIFE, NEXT_LIFE = 100_000, 200_000
LIFE_BONUS, BOMB_BONUS, GRAZE_BONUS, PURE_BONUS = 20_000, 5_000, 50, 100_000


class Score:
    """The points and counts of a game.

    chain: number of links in the current chain; hold: steps until the chain breaks; continues: number of times that
    the player has continued after the last life.
    """

    def __init__(self, kinds):
        self.points = self.chain = self.hold = self.best_chain = 0
        self.grazes = self.taken = self.hits = self.bombs = self.waves = self.continues = 0
        self.kills = dict.fromkeys(kinds, 0)
        self.next_life = FIRST_LIFE

    @property
    def times(self):
        """Multiplier of points, 1..TOP_CHAIN, which grows with the chain."""
        return min(1 + self.chain // CHAIN_STEP, TOP_CHAIN)

    def step(self, quiet):
        """Count down to the end of the chain. quiet: True stops the countdown, because there are no targets.

        Return whether a chain with a multiplier above 1 has broken in this step.
        """
        if self.hold == 0 or quiet:
            return False
        self.hold -= 1
        if self.hold > 0:
            return False
        worth, self.chain = self.times > 1, 0
        return worth

    def _link(self, hold):
        self.chain += 1
        self.best_chain = max(self.best_chain, self.chain)
        self.hold = min(max(self.hold, 0) + hold, HOLD)

    def kill(self, enemy):
        """Count the kill of a plane and add its points. Return these points."""
        if enemy.kind in self.kills:
            self.kills[enemy.kind] += 1
        self._link(HOLD)
        return self._add(enemy.points * self.times)

    def graze(self, count):
        """Count `count` grazes and add their points. Return these points."""
        for _ in range(count):
            self.grazes += 1
            self._link(GRAZE_HOLD)
        return self._add(GRAZE * count * self.times)

    def burn(self, count):
        """Add points for `count` bullets that were removed without a hit. Return these points."""
        return self._add(BURNT * count)

    def whole_wave(self):
        """Count a wave that was shot down completely, and add its points. Return these points."""
        self.waves += 1
        return self._add(WHOLE_WAVE * self.times)

    def phase(self, bonus, left):
        """Add the points of a won phase of a boss fight, and return these points.

        The points are bonus / 2 + left * bonus / 2, rounded to hundreds. left: remaining share of the phase's time,
        0..1.
        """
        self.hold = HOLD if self.chain else 0
        return self._add(round(bonus * (0.5 + 0.5 * left) / 100) * 100)

    def take(self, gained):
        """Count a pick-up, and return the points added for it.

        gained: whether the plane could use the pick-up. Points are added only if it could not.
        """
        self.taken += 1
        return 0 if gained else self._add(SPARE * self.times)

    def hit(self):
        """Count a hit of the player, and end the chain."""
        self.hits += 1
        self.chain = self.hold = 0

    def go_on(self):
        """Count one continue after the last life, and start the points again.

        The new points equal the number of continues, so that their last digit shows this number.
        """
        self.continues += 1
        self.points, self.next_life = self.continues, FIRST_LIFE
        self.chain = self.hold = 0

    def final(self, lives, bombs):
        """Return the bonuses at the end of the stage, a list of (reason, points).

        There are bonuses for remaining lives, bombs and grazes, and for a game without a continue.
        """
        found = [("LIVES", lives * LIFE_BONUS), ("BOMBS", bombs * BOMB_BONUS), ("GRAZES", self.grazes * GRAZE_BONUS)]
        return found + [("NO CONTINUE", PURE_BONUS)] if not self.continues else found

    def add_bonus(self, points):
        """Add the points of one bonus that final() has returned."""
        self._add(points)

    def earned_life(self):
        """Return whether the points have reached the next extra life. Each extra life is reported once only."""
        if self.points < self.next_life:
            return False
        self.next_life += NEXT_LIFE
        return True

    def _add(self, points):
        self.points += points
        return points

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return (
            self.points,
            self.chain,
            self.hold,
            self.best_chain,
            self.grazes,
            self.taken,
            self.hits,
            self.bombs,
            self.waves,
            self.continues,
            self.next_life,
            *self.kills.values(),
        )
