"""Points: what a kill is worth, the chain that multiplies it, and what it costs to be hit."""

CHAIN_STEP, TOP_CHAIN = 8, 8         # kills per step of the multiplier, and its end
CLOSE, SPARE_POWER = 25, 500         # points for a near miss, and for a power-up too many
FIRST_LIFE, NEXT_LIFE = 20_000, 40_000


class Score:
    """`points`, kills by kind, near misses, power-ups taken, hits taken."""

    def __init__(self, kinds):
        self.points = self.chain = self.close = self.taken = self.hits = 0
        self.kills = dict.fromkeys(kinds, 0)
        self.next_life = FIRST_LIFE

    @property
    def times(self):
        """The multiplier."""
        return min(1 + self.chain // CHAIN_STEP, TOP_CHAIN)

    def kill(self, enemy):
        """An enemy is gone. Returns what it was worth."""
        self.kills[enemy.kind] += 1
        self.chain += 1
        return self._add(enemy.points * self.times)

    def near_miss(self):
        """Boxes overlapped, pixels did not. Returns what it was worth."""
        self.close += 1
        return self._add(CLOSE * self.times)

    def take(self, gained):
        """A power-up. Returns the points for one that could not make the plane stronger, else 0."""
        self.taken += 1
        return 0 if gained else self._add(SPARE_POWER * self.times)

    def hit(self):
        """The player is hit: the chain breaks."""
        self.hits += 1
        self.chain = 0

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
        return (self.points, self.chain, self.close, self.taken, self.hits, self.next_life, *self.kills.values())
