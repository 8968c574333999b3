"""Points of the lander, for landings, for deliveries and at the end, and the medals for the total of points."""

from scenes.lander.feel import FUEL, HARD, HULL, SOFT

LANDING, GENTLE, CENTRED, SPARED, WHOLE = 1000, 1500, 500, 1000, 500  # points, multiplied by the site's number 1..3
DELIVERY = 4000  # for undamaged cargo
CAN_WORTH = 200
PAR, SECOND, LIFE, PURE = 300.0, 30, 3000, 5000  # [s]; points per second below PAR; per spare ship; for no loss
MEDALS = (("GOLD", 50000), ("SILVER", 34000), ("BRONZE", 0))
OFF_CENTRE = 34.0  # [px] distance from a pad's middle from which there is no bonus for precision


class Score:
    """The player's score. points: total; the other attributes count landings, deliveries, lost ships,
    shells and cans.
    """

    def __init__(self):
        self.points = 0
        self.landings = self.delivered = self.lost = self.fired = self.cans = 0
        self.softest = 999.0  # [px/s] speed of the softest touchdown that counted

    def land(self, number, speed, off, fuel, hull):
        """Count a landing and add its points. Return a list of (reason, points).

        number: 1 for the first site; speed: speed at touchdown [px/s]; off: distance from the pad's centre [px]; fuel,
        hull: remaining amounts.
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
        """Count a delivered piece of cargo and add its points. Return these points.

        whole: condition of the cargo, from 100 (undamaged) to 0.
        """
        self.delivered += 1
        worth = rounded(DELIVERY * (0.25 + 0.75 * whole / 100.0))
        self.points += worth
        return worth

    def take_can(self):
        """Count a can of fuel and add its points. Return these points."""
        self.cans += 1
        self.points += CAN_WORTH
        return CAN_WORTH

    def final(self, seconds, lives, cargo):
        """Return the bonuses at the end of the course, a list of (reason, points).

        seconds: time of the run [s]; lives: remaining ships, with the current one; cargo: number of pieces of cargo on
        the moon.
        """
        found = [("TIME", rounded(max(PAR - seconds, 0.0) * SECOND)), ("SHIPS LEFT", max(lives - 1, 0) * LIFE)]
        if not self.lost:
            found.append(("NO SHIP LOST", PURE))
        if self.delivered == cargo:
            found.append(("ALL CARGO", PURE))
        return found

    def add(self, points):
        """Add the points of one bonus that final() has returned."""
        self.points += points

    @property
    def medal(self):
        """Name of the medal for the current points: "GOLD", "SILVER" or "BRONZE"."""
        return next(name for name, least in MEDALS if self.points >= least)

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return (self.points, self.landings, self.delivered, self.lost, self.fired, self.cans, self.softest)


def rounded(points):
    """Return the points, rounded to a multiple of ten."""
    return round(points / 10) * 10
