"""Points: the value of kills, the chain that multiplies it, and the cost of a hit.

Kills and grazes extend the chain; it breaks after a while without either, or at a hit.
"""

from scenes.shooter.cast import steps

CHAIN_STEP, TOP_CHAIN = 8, 8  # links per step of the multiplier, and its greatest value
HOLD = steps(3.0)  # steps that a kill keeps the chain
GRAZE_HOLD = steps(0.75)  # steps that a graze adds, up to HOLD
GRAZE, BURNT, SPARE, WHOLE_WAVE = 20, 10, 1000, 500  # points, times the multiplier
FIRST_LIFE, NEXT_LIFE = 100_000, 200_000
LIFE_BONUS, BOMB_BONUS, GRAZE_BONUS, PURE_BONUS = 20_000, 5_000, 50, 100_000


class Score:
    """Score. `points`, kills by kind, grazes, pick-ups taken, hits taken, bombs used, `continues`."""

    def __init__(self, kinds):
        self.points = self.chain = self.hold = self.best_chain = 0
        self.grazes = self.taken = self.hits = self.bombs = self.waves = self.continues = 0
        self.kills = dict.fromkeys(kinds, 0)
        self.next_life = FIRST_LIFE

    @property
    def times(self):
        """The multiplier."""
        return min(1 + self.chain // CHAIN_STEP, TOP_CHAIN)

    def step(self, quiet):
        """Let time pass, unless there are no targets. Return whether a chain of some worth breaks in this step."""
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
        """Add a kill. Return its points."""
        if enemy.kind in self.kills:
            self.kills[enemy.kind] += 1
        self._link(HOLD)
        return self._add(enemy.points * self.times)

    def graze(self, count):
        """Add grazing bullets. Return their points."""
        for _ in range(count):
            self.grazes += 1
            self._link(GRAZE_HOLD)
        return self._add(GRAZE * count * self.times)

    def burn(self, count):
        """Add bullets turned into points, by a bomb or at the end of a leader's phase."""
        return self._add(BURNT * count)

    def whole_wave(self):
        """Add a completely shot wave. Return its points."""
        self.waves += 1
        return self._add(WHOLE_WAVE * self.times)

    def phase(self, bonus, left):
        """Add a leader's phase, beaten with a share `left` of its time: half the bonus, and more for speed."""
        self.hold = HOLD if self.chain else 0
        return self._add(round(bonus * (0.5 + 0.5 * left) / 100) * 100)

    def take(self, gained):
        """Add a pick-up. Return the points for one that had nothing to give, else 0."""
        self.taken += 1
        return 0 if gained else self._add(SPARE * self.times)

    def hit(self):
        """Break the chain after a hit."""
        self.hits += 1
        self.chain = self.hold = 0

    def go_on(self):
        """Continue: the points start again, and their last digit counts the continues."""
        self.continues += 1
        self.points, self.next_life = self.continues, FIRST_LIFE
        self.chain = self.hold = 0

    def final(self, lives, bombs):
        """Return (reason, points) of the end of the stage."""
        found = [("LIVES", lives * LIFE_BONUS), ("BOMBS", bombs * BOMB_BONUS), ("GRAZES", self.grazes * GRAZE_BONUS)]
        return found + [("NO CONTINUE", PURE_BONUS)] if not self.continues else found

    def add_bonus(self, points):
        """Add the points of one bonus."""
        self._add(points)

    def earned_life(self):
        """Return True once for every life that the points earn."""
        if self.points < self.next_life:
            return False
        self.next_life += NEXT_LIFE
        return True

    def _add(self, points):
        self.points += points
        return points

    def state(self):
        """Return the state for the digest."""
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
