"""Points: what a kill is worth, the chain that multiplies it, and what it costs to be hit.

Kills and grazes make the chain longer and keep it alive; it breaks when nothing happened for a while, or at a hit.
"""

from scenes.shooter.cast import steps

CHAIN_STEP, TOP_CHAIN = 8, 8  # links per step of the multiplier, and its end
HOLD = steps(3.0)  # steps that a kill keeps the chain alive
GRAZE_HOLD = steps(0.75)  # steps that a graze adds, at most to the whole
GRAZE, BURNT, SPARE, WHOLE_WAVE = 20, 10, 1000, 500  # points, times the multiplier
FIRST_LIFE, NEXT_LIFE = 100_000, 200_000
LIFE_BONUS, BOMB_BONUS, GRAZE_BONUS, PURE_BONUS = 20_000, 5_000, 50, 100_000


class Score:
    """`points`, kills by kind, grazes, pick-ups taken, hits taken, bombs used, `continues`."""

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
        """Time passes, unless nobody is there to shoot at. True in the step in which a chain of some worth breaks."""
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
        """An enemy is gone. Returns what it was worth."""
        if enemy.kind in self.kills:
            self.kills[enemy.kind] += 1
        self._link(HOLD)
        return self._add(enemy.points * self.times)

    def graze(self, count):
        """So many bullets passed close by. Returns what it was worth."""
        for _ in range(count):
            self.grazes += 1
            self._link(GRAZE_HOLD)
        return self._add(GRAZE * count * self.times)

    def burn(self, count):
        """Bullets turned into points: by a bomb, or at the end of a leader's phase."""
        return self._add(BURNT * count)

    def whole_wave(self):
        """All planes of a wave were shot down."""
        self.waves += 1
        return self._add(WHOLE_WAVE * self.times)

    def phase(self, bonus, left):
        """A leader's phase was shot through with a share `left` of its time: half the bonus, and more for haste."""
        self.hold = HOLD if self.chain else 0
        return self._add(round(bonus * (0.5 + 0.5 * left) / 100) * 100)

    def take(self, gained):
        """A pick-up. Returns the points for one that could not give what it holds, else 0."""
        self.taken += 1
        return 0 if gained else self._add(SPARE * self.times)

    def hit(self):
        """The player is hit: the chain breaks."""
        self.hits += 1
        self.chain = self.hold = 0

    def go_on(self):
        """Continue: the points begin anew, and their last digit tells how often."""
        self.continues += 1
        self.points, self.next_life = self.continues, FIRST_LIFE
        self.chain = self.hold = 0

    def final(self, lives, bombs):
        """(what for, points) of what the end of the stage is worth."""
        found = [("LIVES", lives * LIFE_BONUS), ("BOMBS", bombs * BOMB_BONUS), ("GRAZES", self.grazes * GRAZE_BONUS)]
        return found + [("NO CONTINUE", PURE_BONUS)] if not self.continues else found

    def add_bonus(self, points):
        """Take one of them in."""
        self._add(points)

    def earned_life(self):
        """True once for every life that the points are worth."""
        if self.points < self.next_life:
            return False
        self.next_life += NEXT_LIFE
        return True

    def _add(self, points):
        self.points += points
        return points

    def state(self):
        """For the digest."""
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
