"""Points of landings, deliveries and the end; medals for the total."""

from scenes.lander.feel import FUEL, HARD, HULL, SOFT

LANDING, GENTLE, CENTRED, SPARED, WHOLE = 1000, 1500, 500, 1000, 500  # points, times the site's number
DELIVERY = 4000  # for undamaged cargo
CAN_WORTH = 200
PAR, SECOND, LIFE, PURE = 300.0, 30, 3000, 5000  # [s] of a run; points per second left; per ship left; for no loss
MEDALS = (("GOLD", 50000), ("SILVER", 34000), ("BRONZE", 0))
OFF_CENTRE = 34.0  # [px] from a pad's middle up to which it still counts


class Score:
    """Score. `points`: total; events are counted beside them."""

    def __init__(self):
        self.points = 0
        self.landings = self.delivered = self.lost = self.fired = self.cans = 0
        self.softest = 999.0  # [px/s] softest counted touchdown

    def land(self, number, speed, off, fuel, hull):
        """Add a landing; return [(reason, points)]. number: 1 for the first site; speed [px/s] of the touchdown; off
        [px].
        """
        self.landings += 1
        self.softest = min(self.softest, speed)
        shares = (
            ("LANDING", LANDING, 1.0),
            ("GENTLE", GENTLE, (HARD - speed) / (HARD - SOFT)),
            ("CENTRED", CENTRED, 1.0 - off / OFF_CENTRE),
            ("FUEL", SPARED, fuel / FUEL),
            ("HULL", WHOLE, hull / HULL),
        )
        found = [(name, rounded(worth * number * min(max(share, 0.0), 1.0))) for name, worth, share in shares]
        self.points += sum(points for _, points in found)
        return found

    def deliver(self, whole):
        """Add delivered cargo, with `whole` 0..100 of it left. Return its points."""
        self.delivered += 1
        worth = rounded(DELIVERY * (0.25 + 0.75 * whole / 100.0))
        self.points += worth
        return worth

    def take_can(self):
        """Add a can of fuel; return its points."""
        self.cans += 1
        self.points += CAN_WORTH
        return CAN_WORTH

    def final(self, seconds, lives, cargo):
        """Return [(reason, points)] of the end. lives: ships left; cargo: number of pieces."""
        found = [("TIME", rounded(max(PAR - seconds, 0.0) * SECOND)), ("SHIPS LEFT", max(lives - 1, 0) * LIFE)]
        if not self.lost:
            found.append(("NO SHIP LOST", PURE))
        if self.delivered == cargo:
            found.append(("ALL CARGO", PURE))
        return found

    def add(self, points):
        """Add the points of one bonus."""
        self.points += points

    @property
    def medal(self):
        """GOLD, SILVER or BRONZE."""
        return next(name for name, least in MEDALS if self.points >= least)

    def state(self):
        """Return the state for the replay digest, as a flat tuple."""
        return (self.points, self.landings, self.delivered, self.lost, self.fired, self.cans, self.softest)


def rounded(points):
    """Return the points rounded to tens."""
    return round(points / 10) * 10
