"""Random values as source text: numbers with few digits, shapes of all kinds, filters, materials and effects."""

from dataclasses import fields

from physics import JIT, Effects

DETECTION = "narrowphase rotation continuous sensors persist".split()
PUSHING = "response gravity drag wind rotation friction restitution continuous sensors persist one_way conveyor".split()
FAMILIES = (  # each compiles kernels of its own: without numba any valid set is drawn
    [],
    DETECTION,
    [*PUSHING, "carving"],
    "response gravity rotation friction restitution stacking continuous sleeping sensors".split(),
    [*PUSHING, "stacking", "sleeping", "carving"],
    "response gravity rotation friction restitution stacking continuous sleeping sensors joints".split(),
    [*PUSHING, "stacking", "sleeping", "carving", "joints"],
)
STRATEGIES = ("BruteForce()", "SweepAndPrune()", "SpatialHashGrid()", "DynamicTree()", 'SweepAndPrune(axes="both")')
MOVING = ("circle", "circle", "box", "box", "plank", "hull", "rounded", "capsule", "mask", "mask", "bounds")
STILL = (*MOVING, "segment", "chain", "tiles", "open_mask")


class Values:
    """Generator of random values from a random.Random."""

    def __init__(self, rng, one_way=True):
        self.rng, self.one_way = rng, one_way  # one_way: whether shapes may be open from below

    def chance(self, share):
        return self.rng.random() < share

    def number(self, low, high):
        """Return a number in low .. high, mostly of four digits; some are integers, so that shapes touch exactly."""
        value = self.rng.uniform(low, high)
        return float(round(value)) if self.chance(0.3) else float(f"{value:.4g}")

    def pair(self, reach):
        return (self.number(-reach, reach), self.number(-reach, reach))

    def place(self):
        """Return a random position: mostly near the others, some on a grid, where shapes lie side by side, a few far
        away.
        """
        if self.chance(0.3):
            return (8.0 * self.rng.randint(-12, 12), 8.0 * self.rng.randint(-12, 12))
        return self.pair(1e6) if self.chance(0.01) else self.pair(120.0)

    def speed(self):
        return self.pair(self.rng.choice((0.0, 40.0, 300.0, 300.0, 4000.0, 1e5)))

    def angle(self):
        return self.rng.choice((0.0, 0.0, 1.5707963267948966, self.number(-7.0, 7.0)))

    def dt(self):
        return self.rng.choice((0.0, 1e-6, 0.004, 1 / 120, 1 / 60, 1 / 30, 0.1))

    def effects(self, effect=None):
        """Return the names of a random valid set of effects. effect: name of an effect in it; None: any."""
        if JIT:
            return list(self.rng.choice([names for names in FAMILIES if effect is None or effect in names]))
        names = [field.name for field in fields(Effects) if field.name == effect or self.chance(0.6)]
        while True:
            try:
                Effects(**{name: True for name in names})
                return names
            except ValueError as error:
                names.append("stacking" if "stacking" in str(error).split("needs")[1] else "response")

    # --- shapes ----------------------------------------------------------------------------------------------------

    def shape(self, kind="dynamic", also_wrong=0.02):
        """Return the text of a random shape for a body of a kind.

        also_wrong: probability that a dynamic body gets a shape from all kinds, some of which it may not have.
        """
        of_all = kind != "dynamic" or self.chance(also_wrong)
        text = getattr(self, "_" + self.rng.choice(STILL if of_all else MOVING))()
        if self.chance(0.08):
            text += f".with_({self.rng.choice((f'material={self.material()}', f'filter={self.filter()}'))})"
        return text

    def convex(self):
        return getattr(self, "_" + self.rng.choice(("circle", "box", "plank", "hull", "rounded", "capsule")))()

    def _size(self):
        return self.rng.choice((self.number(2.0, 12.0), self.number(6.0, 40.0), 16.0))

    def _circle(self):
        center = f", {self.pair(6.0)}" if self.chance(0.2) else ""
        return f"Circle({self._size()}{center})"

    def _box(self):
        return f"Polygon.box({self._size()}, {self._size()})"

    def _plank(self):
        return f"Polygon.box({self.number(40.0, 200.0)}, {self.number(0.5, 6.0)})"

    def _hull(self):
        points = [self.pair(self.rng.choice((8.0, 25.0))) for _ in range(self.rng.randint(3, 8))]
        return f"hull({points})"

    def _rounded(self):
        return f"Polygon({self._hull()}.points, {self.number(0.5, 8.0)})"

    def _capsule(self):
        return f"Capsule({self.pair(15.0)}, {self.pair(15.0)}, {self.number(1.0, 10.0)})"

    def _segment(self):
        return f"Segment({self.pair(80.0)}, {self.pair(80.0)})"

    def _bounds(self):
        return f"Bounds({self.convex()})"

    def _chain(self):
        xs = sorted({self.number(-120.0, 120.0) for _ in range(self.rng.randint(2, 6))})
        return f"Chain({[(x, self.number(-12.0, 12.0)) for x in xs]})"

    def _tiles(self):
        rows, columns = self.rng.randint(1, 3), self.rng.randint(1, 8)
        solid = [[self.rng.randint(0, 1) for _ in range(columns)] for _ in range(rows)]
        more = ""
        if self.one_way and self.chance(0.4):
            more = f", one_way={[[int(not cell and self.chance(0.4)) for cell in row] for row in solid]}"
        elif self.chance(0.4):
            slope = ((0.0, 1.0), (1.0, 0.5), (0.0, 0.0))
            more = f", slopes={[[(0.0, 0.0) if cell else self.rng.choice(slope) for cell in row] for row in solid]}"
        return f"TileGrid({solid}, 16.0{more})"

    def _mask(self):
        width, height = self.rng.randint(1, 24), self.rng.randint(1, 24)
        pixels = self.rng.choice(
            (
                f"np.ones(({height}, {width}), bool)",
                f"np.random.default_rng({self.rng.randint(0, 99)}).random(({height}, {width})) < 0.8",
                f"np.hypot(*np.mgrid[-{height}:{height}, -{height}:{height}]) < {height}",
            )
        )
        return f"PixelMask({pixels}, snap={self.chance(0.5)})"

    def _open_mask(self):
        return f"{self._mask()}.with_(one_way=True)" if self.one_way else self._mask()

    # --- what bodies are given -------------------------------------------------------------------------------------

    def filter(self):
        return self.rng.choice(("Filter.ALL", f"Filter({self.rng.randint(1, 3)}, {self.rng.randint(0, 3)})"))

    def material(self):
        return (
            f"Material(density={self.number(0.1, 8.0)}, friction={self.number(0.0, 1.5)}, "
            f"restitution={self.number(0.0, 1.0)}, rolling_resistance={self.number(0.0, 0.5)}, "
            f"surface_speed={self.rng.choice((0.0, self.number(-80.0, 80.0)))})"
        )
