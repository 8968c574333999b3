"""Generator of lines that add joints of all kinds, change and remove them; some arguments are invalid on purpose."""

PLAIN = "Revolute Prismatic Wheel Distance Weld Angle Motor Target NoContact Gear Pulley Ratchet".split()
FOR_MANY = "Revolute Prismatic Wheel Distance Weld Angle NoContact".split()
WRONG = 0.06  # share of joints and settings with an invalid argument
MOST_JOINTS, MOST_BODIES = 24, 12  # in a world, before no joint and no row of bodies is added
GONE = 10**6  # id of no body and of no joint
BAD_SETTINGS = (
    "motor = Drive(3.0)",
    "motor = 2.0",
    "spring = Spring(-1.0)",
    "spring = Spring(2.0, -0.5)",
    "limits = (2.0, -2.0)",
    "limits = (np.nan, 1.0)",
    "breaks = (0.0, None)",
    "enabled = 1",
    "contacts = None",
    "ratio = 0.0",
    "ratchet = 0.0",
    "phase = np.inf",
    "length = -3.0",
    "point = (np.nan, 0.0)",
)
BAD_CALLS = (
    "world.remove_joints([{gone}])",
    "world.remove_joints('all')",
    "world.joint({gone})",
    "world.joint_solver = 'exact'",
    "world.solver = 'projection'",
    "world.add_joint(Revolute)",
    "world.add_joint(Weld(None, {gone}, at=(0.0, 0.0)))",
    "world.add_joints(Weld, [0], [0, 1], at=(0.0, 0.0))",
    "world.add_joints(Gear, [{gone}], [0])",
)


class Source(str):
    """Source text of a value; within the text of a list it has no quotes."""

    __slots__ = ()

    def __repr__(self):
        return str(self)


class JointLines:
    """Generator of lines about joints. values: the Values of the program."""

    def __init__(self, values):
        self.values, self.rng, self.named, self.waiting = values, values.rng, 0, []

    def next(self, world, joints):
        """Return the next line about joints. joints: texts of the joints in the world."""
        v = self.values
        if self.waiting:
            return self.waiting.pop()
        if v.chance(0.05):
            return self.rng.choice(BAD_CALLS).format(gone=GONE)
        if len(world.joints) < MOST_JOINTS and (not joints or v.chance(0.45)):
            return self.add(world, joints)
        edit = self.rng.choice((self.edit_setting,) * 6 + (self.edit_column, self.edit_solver, self.edit_remove))
        return edit(world, self.rng.choice(joints or [f"world.joint({GONE})"]))

    # --- new joints ------------------------------------------------------------------------------------------------

    def add(self, world, joints):
        if self.values.chance(0.2) and len(world) < MOST_BODIES:
            return self.add_chain()
        if self.values.chance(0.15):
            return self.add_many(world)
        kind = self.rng.choice(PLAIN)
        arguments = self._gear(joints) if kind == "Gear" else self._arguments(kind, *self._sides(world))
        self.named += 1
        return f"j{self.named} = world.add_joint({kind}({', '.join(arguments)}))"

    def add_chain(self):
        """Return the line that adds a row of bodies; the line that joins them follows."""
        v, count = self.values, self.rng.randint(2, 6)
        (x, y), apart = v.place(), v.number(4.0, 30.0)
        shape = self.rng.choice((f"Circle({v.number(1.0, 6.0)})", f"Polygon.box({apart}, {v.number(1.0, 8.0)})"))
        self.named += 1
        ids = f"k{self.named}"
        kind = self.rng.choice(("Revolute", "Revolute", "Weld"))
        at = [(round(x + apart * (k + 0.5), 3), y) for k in range(count - 1)]
        more = "".join(f", {each}" for each in self._more(kind))
        self.waiting = [f"world.add_joints({kind}, {ids}[:-1], {ids}[1:], at={at}{more})"]
        places = [(round(x + apart * k, 3), y) for k in range(count)]
        return f"{ids} = world.add_bodies({shape}, {places})"

    def add_many(self, world):
        kind, count = self.rng.choice(FOR_MANY), self.rng.randint(0, 3)
        pairs = [self._sides(world) for _ in range(count)]
        sides = [[None if body is None else body.id for body in each] for each in pairs]
        names = {"Distance": ("at_a", "at_b"), "Angle": (), "NoContact": ()}.get(kind, ("at",))
        more = [f"{name}={[self._anchor(*each) for each in pairs]}" for name in names]
        more += self._more(kind) + ([f"axis={self._axis()}"] if kind in ("Prismatic", "Wheel") else [])
        first, second = ([each[k] for each in sides] for k in range(2))
        return f"world.add_joints({', '.join([kind, str(first), str(second), *more])})"

    def _sides(self, world):
        """Return two Bodies of the world, of which at most one may be None, the world; mostly one is dynamic."""
        bodies = list(world)
        movers = [body for body in bodies if body.kind == "dynamic"] or bodies
        if not bodies:
            return None, None
        one = self.rng.choice(movers)
        others = [body for body in (bodies if self.values.chance(0.5) else movers) if body != one]
        other = None if not others or self.values.chance(0.25) else self.rng.choice(others)
        if self.values.chance(WRONG):
            other = one
        return (other, one) if self.values.chance(0.6) else (one, other)

    def _anchor(self, a, b):
        """Return a random point: on one of the two bodies, between them, or anywhere."""
        v = self.values
        places = [body.position for body in (a, b) if body is not None]
        if not places or v.chance(0.1):
            return Source("(np.nan, 0.0)") if v.chance(WRONG) else v.place()
        x, y = (sum(each[k] for each in places) / len(places) for k in range(2))
        if v.chance(0.5):
            x, y = self.rng.choice(places)
        return (round(x + v.number(-12.0, 12.0), 3), round(y + v.number(-12.0, 12.0), 3))

    def _arguments(self, kind, a, b):
        """Return the arguments of a joint between the Bodies a and b, one of which may be None."""
        v, sides = self.values, [self._body(each) for each in (a, b)]
        if kind == "Target":
            point = "None" if v.chance(0.2) else self._anchor(a, b)
            body = a if b is None else b
            found = [self._body(body), f"at={self._anchor(body, None)}", f"point={point}"]
            found += [f"spring={self._spring(target=False)}"] if v.chance(0.5) else []
            return [*found, *([f"max_force={self._most()}"] if v.chance(0.5) else []), *self._common()]
        if kind == "Motor":
            found = [f"at={self._anchor(a, b)}"] if v.chance(0.4) else []
            found += [f"velocity={v.pair(100.0)}"] if v.chance(0.5) else []
            found += [f"angular_velocity={v.number(-10.0, 10.0)}"] if v.chance(0.3) else []
            found += [f"spring={self._spring(target=False)}"] if v.chance(0.3) else []
            return [*sides, *found, f"max_force={self._most()}", f"max_torque={self._most()}", *self._common()]
        if kind == "Pulley":
            found = [self._anchor(a, None), self._anchor(b, None), v.place(), v.place()]
            found += [f"ratio={self._ratio(positive=True)}"] if v.chance(0.5) else []
            found += [f"length={v.number(10.0, 300.0)}"] if v.chance(0.3) else []
            return [*sides, *map(str, found), *(["rigid=True"] if v.chance(0.3) else []), *self._common()]
        if kind == "Ratchet":
            tooth = self.rng.choice((0.3, -0.3, 1.5, v.number(-2.0, 2.0)))
            phase = [f"phase={v.number(-1.0, 1.0)}"] if v.chance(0.3) else []
            return [*sides, *phase, f"ratchet={0.0 if v.chance(WRONG) else tooth}", *self._common()]
        names = {"Distance": ("at_a", "at_b"), "Angle": (), "NoContact": ()}.get(kind, ("at",))
        local = kind != "Distance" and v.chance(0.1)
        found = [f"{name}={v.pair(12.0) if local else self._anchor(a, b)}" for name in names]
        found += ["local=True"] if local and names else []
        found += [f"axis={self._axis()}"] if kind in ("Prismatic", "Wheel") else []
        found += ["turns=True"] if kind == "Prismatic" and v.chance(0.4) else []
        found += [f"length={v.number(5.0, 100.0)}"] if kind == "Distance" and v.chance(0.2) else []
        return [*sides, *found, *self._more(kind)]

    def _gear(self, joints):
        """Return the arguments of a gear of two joints; if there are too few, or rarely, a side is a body."""
        v = self.values
        sides = [self.rng.choice(joints) if joints and v.chance(0.85) else "world.body(0)" for _ in range(2)]
        found = [f"ratio={self._ratio()}"] if v.chance(0.7) else []
        return [*sides, *found, *([f"phase={v.number(-3.0, 3.0)}"] if v.chance(0.2) else []), *self._common()]

    def _more(self, kind):
        """Return the arguments of the coordinate, the springs and all joints, for a kind that has a coordinate."""
        v, found = self.values, []
        if kind in ("Revolute", "Prismatic", "Wheel", "Distance", "Angle"):
            found += [f"limits={self._limits(kind)}"] if v.chance(0.4) else []
            found += [f"motor={self._drive()}"] if v.chance(0.3) else []
            found += [f"spring={self._spring()}"] if v.chance(0.3) else []
        if kind == "Weld":
            found += [f"{name}={self._spring(False)}" for name in ("spring", "angular_spring") if v.chance(0.25)]
        return found + self._common()

    def _common(self):
        v, found = self.values, []
        if v.chance(0.15):
            found += [f"breaks={self._breaks()}"]
        return found + (["contacts=True"] if v.chance(0.25) else []) + (["user='pin'"] if v.chance(0.05) else [])

    # --- changes ---------------------------------------------------------------------------------------------------

    def edit_setting(self, world, joint):
        v = self.values
        if v.chance(WRONG):
            return f"{joint}.{self.rng.choice(BAD_SETTINGS)}"
        kind = self.rng.choice(PLAIN)
        name, value = self.rng.choice(
            (
                ("motor", self.rng.choice((None, self._drive(), self._drive()))),
                ("spring", self.rng.choice((None, self._spring(), self._spring()))),
                ("limits", self.rng.choice((None, self._limits(kind), self._limits("Distance")))),
                ("breaks", self.rng.choice((None, self._breaks()))),
                ("enabled", v.chance(0.5)),
                ("enabled", v.chance(0.5)),
                ("contacts", v.chance(0.5)),
                ("point", v.place()),
                ("ratio", self._ratio()),
                ("phase", v.number(-3.0, 3.0)),
                ("ratchet", v.number(-2.0, 2.0)),
                ("length", v.number(1.0, 300.0)),
                ("user", "'rope'"),
            )
        )
        return f"{joint}.{name} = {value}"

    def edit_column(self, world, joint):
        """Return a line that writes a column with settings of one joint, and mostly wakes its bodies."""
        v = self.values
        if not len(world.joints):
            return self.edit_solver(world, joint)
        row = self.rng.randrange(len(world.joints))
        name, value = self.rng.choice(
            (
                ("motor_speed", v.number(-50.0, 50.0)),
                ("motor_max", self._most()),
                ("spring_hertz", v.number(0.0, 8.0)),
                ("spring_target", v.number(-5.0, 5.0)),
                ("break_force", v.number(1e4, 1e8)),
                ("upper", "np.inf"),
                ("lower", "-np.inf"),
                ("target_vx", v.number(-50.0, 50.0)),
            )
        )
        bodies = [f'world.joints["{each}"][{row}]' for each in ("body_a", "body_b") if world.joints[each][row] >= 0]
        touched = f"; world.touch([{', '.join(bodies)}])" if v.chance(0.8) else ""
        return f'world.joints["{name}"][{row}] = {value}{touched}'

    def edit_solver(self, world, joint):
        return f"world.joint_solver = {self.rng.choice(('iterative', 'direct', 'auto'))!r}"

    def edit_remove(self, world, joint):
        return self.rng.choice((f"{joint}.remove()", f"world.remove_joints([{joint}])"))

    # --- values ----------------------------------------------------------------------------------------------------

    def _body(self, body):
        wrong = self.values.chance(0.02)
        return str(GONE) if wrong else "None" if body is None else f"world.body({body.id})"

    def _axis(self):
        if self.values.chance(WRONG):
            return (0.0, 0.0)
        return self.rng.choice(((1.0, 0.0), (0.0, 1.0), self.values.pair(3.0)))

    def _limits(self, kind):
        v, reach = self.values, 2.0 if kind in ("Revolute", "Angle") else 40.0
        low, high = sorted((v.number(-reach, reach), v.number(-reach, reach)))
        if kind == "Distance":
            low, high = sorted((abs(low), abs(high) + v.number(0.0, 60.0)))
        if v.chance(WRONG):
            low, high = high + 1.0, low
        return self.rng.choice(((low, high), (low, high), (low, low), (None, high), (low, None)))

    def _drive(self):
        v = self.values
        return f"Drive({v.number(-60.0, 60.0)}, max={self._most()})" if not v.chance(WRONG) else "Drive(2.0)"

    def _spring(self, target=True):
        v = self.values
        if v.chance(WRONG):
            return self.rng.choice(("Spring(-1.0)", "Spring(0.0)", "Spring(2.0, -1.0)", "3.0"))
        more = f", target={v.number(-3.0, 30.0)}" if target and v.chance(0.3) else ""
        return f"Spring({v.number(0.2, 12.0)}, {self.rng.choice((0.0, 0.5, 1.0, v.number(0.0, 5.0)))}{more})"

    def _most(self):
        """Return a random greatest force or torque: over many decades."""
        return float(f"{10.0 ** self.rng.uniform(2.0, 9.0):.3g}") if self.values.chance(0.95) else 0.0

    def _breaks(self):
        most = (self._most() + 1.0, self._most() + 1.0)
        return self.rng.choice((most, (most[0], None), (None, most[1])))

    def _ratio(self, positive=False):
        v = self.values
        if v.chance(WRONG):
            return self.rng.choice((0.0, Source("np.nan")))
        size = float(f"{10.0 ** self.rng.uniform(-1.0, 1.0):.3g}")
        return size if positive or v.chance(0.5) else -size
