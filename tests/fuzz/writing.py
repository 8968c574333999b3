"""Generator of a random program, line by line, from the present world: most lines are valid, some are not."""

import re

from physics import SOLVERS, STATIC, Joint
from physics.step import STACKING
from tests.fuzz.joint_lines import JointLines
from tests.fuzz.values import STRATEGIES, Values

KINDS = ("dynamic", "dynamic", "dynamic", "static", "kinematic")
MOST = 16  # bodies: one step takes a tenth of a millisecond
JOINTS = 0.5  # share of lines about joints among the edits of a world with joints


class Writer:
    """Generator of lines for a namespace in which the previous lines have been run.

    effect: name of an effect that the world has; None: any effects.
    """

    def __init__(self, rng, effect=None):
        self.rng, self.values, self.named, self.effect = rng, Values(rng), 0, effect
        self.joint_lines = JointLines(self.values)
        self.edits = [getattr(self, name) for name in sorted(dir(self)) if name.startswith("edit_")]
        self.asks = [getattr(self, name) for name in sorted(dir(self)) if name.startswith("ask_")]

    def first(self):
        """Return the line that makes the world."""
        v, rng = self.values, self.rng
        names = v.effects(self.effect)
        self.stacking = "stacking" in names
        said = ", ".join([f"{name}=True" for name in names if name != "narrowphase"])
        if "narrowphase" not in names and names:
            said = f"narrowphase=False, {said}" if v.chance(0.3) else said
        solvers = [*STACKING] * 3 if "joints" in names else []  # the others solve no joints
        more = [f"solver={rng.choice([None, *solvers, *self._solvers()])!r}"]
        v.one_way = "one_way" in names
        more += [f"gravity={v.pair(400.0)}"] if "gravity" in names and v.chance(0.3) else []
        more += [f"drag={v.number(0.0, 2.0)}"] if {"drag", "wind"} & set(names) and v.chance(0.3) else []
        more += [f"wind={v.pair(100.0)}"] if "wind" in names and v.chance(0.3) else []
        more += [f"restitution_speed={v.number(0.0, 60.0)}"] if v.chance(0.2) else []
        more += [f"pixels_per_meter={rng.choice((1.0, 32.0, 100.0))}"] if v.chance(0.3) else []
        more += [f"substeps={rng.randint(1, 8)}"] if v.chance(0.2) else []
        return f"world = World(Effects({said}), {rng.choice(STRATEGIES)}, {', '.join(more)})"

    def next(self, space):
        """Return the next line of the program. space: the namespace."""
        self.space, self.world = space, space["world"]
        kind = self.rng.random()
        if len(self.world) < 3 or kind < 0.1:
            return self.edit_add(None)
        if kind < 0.5:
            return self.step()
        if kind < 0.6:
            return self.rng.choice(self.asks)()
        if kind < 0.7 and (heroes := self._living(r"hero\d+")):
            return self.walk(self.rng.choice(heroes))
        if self.world.effects.joints and self.values.chance(JOINTS):
            return self.joint_lines.next(self.world, self._joints())
        bodies = [f"b{name}" for name in self._living(r"b\d+", start=1)]
        bodies += (
            [f"world.body({each})" for each in self.world.bodies["id"].tolist()] if self.values.chance(0.2) else []
        )
        return self.rng.choice(self.edits)(self.rng.choice(bodies or [f"world.body({len(self.world)})"]))

    def _living(self, pattern, start=0):
        """Return the names in the namespace that match a pattern and whose body is in the world.

        start: number of first letters to cut off each name.
        """
        found = []
        for name, value in self.space.items():
            if re.fullmatch(pattern, name) and getattr(value, "body", value) in self.world:
                found.append(name[start:])
        return found

    def _joints(self):
        """Return texts of the joints in the world: mostly names of the namespace, some ids."""
        names = [name for name, value in self.space.items() if isinstance(value, Joint) and value in self.world]
        return names + [f"world.joint({each})" for each in self.world.joints["id"].tolist()[:4]]

    def _solvers(self):
        return list(SOLVERS) if self.stacking else [name for name in SOLVERS if name not in STACKING]

    def _name(self):
        self.named += 1
        return self.named

    # --- steps and walks -------------------------------------------------------------------------------------------

    def step(self):
        line = "world.step()" if self.values.chance(0.8) else f"world.step({self.values.dt()})"
        return f"for _ in range({self.rng.choice((3, 10, 40))}): {line}" if self.values.chance(0.3) else line

    def walk(self, hero):
        v = self.values
        move = f"{v.number(-8.0, 8.0)}, {v.number(-8.0, 12.0)}"
        return self.rng.choice(
            (
                f"{hero}.move({move})",
                f"{hero}.move({move})",
                f"{hero}.move({move}, drop=True)",
                f"{hero}.blocked({move})",
                f"{hero}.move_to({v.place()})",
            )
        )

    # --- edits -----------------------------------------------------------------------------------------------------

    def edit_add(self, body):
        v, kind = self.values, self.rng.choice(KINDS)
        if len(self.world) >= MOST:
            return self.edit_remove(f"world.body({self.rng.choice(self.world.bodies['id'].tolist())})")
        effects, shapes = self.world.effects, [v.shape(kind) for _ in range(1 if v.chance(0.85) else 2)]
        more = [f"position={v.place()}"]
        more += [f"kind={kind!r}"] if kind != "dynamic" else []
        more += [f"velocity={v.speed()}"] if kind != "static" and v.chance(0.5) else []
        more += [f"angle={v.angle()}"] if "Tile" not in "".join(shapes) and v.chance(0.5) else []
        if effects.rotation and kind != "static" and v.chance(0.2):
            more.append(f"angular_velocity={v.number(-20.0, 20.0)}")
        more += [f"material={v.material()}"] if v.chance(0.3) else []
        more += [f"filter={v.filter()}"] if v.chance(0.15) else []
        more += ["sensor=True"] if effects.sensors and v.chance(0.1) else []
        more += ["bullet=True"] if effects.continuous and v.chance(0.1) else []
        if effects.continuous and v.chance(0.2):
            more.append(f"continuous={self.rng.choice(('off', 'ray', 'swept', 'toi'))!r}")
        more += [f"mass={v.number(0.1, 500.0)}"] if v.chance(0.1) else []
        more += ["fixed_rotation=True"] if v.chance(0.1) else []
        more += ["allow_sleep=False"] if v.chance(0.05) else []
        more += [f"gravity_scale={v.number(-1.0, 2.0)}"] if v.chance(0.1) else []
        return f"b{self._name()} = world.add_body({', '.join(shapes + more)})"

    def edit_add_many(self, body):
        places = [self.values.place() for _ in range(self.rng.randint(0, 3))]
        return f"world.add_bodies({self.values.shape()}, {places})"

    def edit_hero(self, body):
        if not self.world.effects.response:
            return self.edit_add(body)
        v = self.values
        shape = self.rng.choice(("Polygon.box(10.0, 14.0)", "Circle(7.0)", "Capsule((0, -6), (0, 6), 5.0)", v.convex()))
        more = ", pushable=True" if v.chance(0.3) else ""
        return f"hero{self._name()} = Character(world, {shape}, {v.place()}{more})"

    def edit_remove(self, body):
        return f"{body}.remove()" if self.values.chance(0.7) else f"world.remove_bodies([{body}])"

    def edit_clear(self, body):
        return "world.clear()" if self.values.chance(0.1) else self.edit_remove(body)

    def edit_place(self, body):
        v = self.values
        return self.rng.choice(
            (
                f"{body}.position = {v.place()}",
                f"{body}.move_to({v.place()}, {v.angle()})",
                f"{body}.angle = {v.angle()}",
                f"{body}.position = {self.rng.choice(self.world.bodies['x'].tolist())}, {v.number(-99.0, 99.0)}",
            )
        )

    def edit_motion(self, body):
        v = self.values
        return self.rng.choice((f"{body}.velocity = {v.speed()}", f"{body}.angular_velocity = {v.number(-30.0, 30.0)}"))

    def edit_push(self, body):
        v = self.values
        return self.rng.choice(
            (
                f"{body}.apply_force({v.pair(1e5)}, {v.place()})",
                f"{body}.apply_impulse({v.pair(1e4)})",
                f"{body}.apply_torque({v.number(-1e5, 1e5)})",
            )
        )

    def edit_values(self, body):
        v = self.values
        name, value = self.rng.choice(
            (
                ("material", v.material()),
                ("filter", v.filter()),
                ("sensor", v.chance(0.5)),
                ("bullet", v.chance(0.5)),
                ("continuous", repr(self.rng.choice(("off", "ray", "swept", "toi", "auto")))),
                ("fixed_rotation", v.chance(0.5)),
                ("gravity_scale", v.number(-2.0, 2.0)),
                ("tier", self.rng.choice((None, "'hull'", "'circle'", "'obb'", "'outline'", "'pixels'", "'mask'"))),
                ("user", "'someone'"),
            )
        )
        return f"{body}.{name} = {value}"

    def edit_shapes(self, body):
        v = self.values
        return self.rng.choice(
            (
                f"{body}.set_shapes({v.shape()})",
                f"{body}.set_shapes({v.shape()}, {v.shape()})",
                f"{body}.add_shape({v.shape(also_wrong=0.2)})",
                f"{body}.remove_shape({body}.shape_ids[-1])",
            )
        )

    def edit_kind(self, body):
        return f"{body}.set_kind({self.rng.choice(KINDS)!r})"

    def edit_target(self, body):
        angle = f", {self.values.angle()}" if self.values.chance(0.3) else ""
        return f"{body}.set_target({self.values.place()}{angle})"

    def edit_rest(self, body):
        return self.rng.choice((f"{body}.wake()", f"{body}.restore()", f"world.touch([{body}])"))

    def edit_carve(self, body):
        v = self.values
        masks = [each.id for each in self.world if any("Mask" in type(shape).__name__ for shape in each.shapes)]
        if masks:
            body = f"world.body({self.rng.choice(masks)})"
            x, y = self.world.body(int(body[11:-1])).position
        else:
            x, y = 0.0, 0.0
        near = (round(x + v.number(-15.0, 15.0), 2), round(y + v.number(-15.0, 15.0), 2))
        tool = self.rng.choice((f"Circle({v.number(1.0, 12.0)})", v.convex(), "Polygon.box(60.0, 2.0)"))
        return f"{body}.carve({tool}, {(*near, v.angle())}, crumb={self.rng.randint(0, 6)})"

    def edit_world(self, body):
        v, rng = self.values, self.rng
        name, value = rng.choice(
            (
                ("gravity", v.pair(500.0)),
                ("wind", v.pair(200.0)),
                ("drag", v.number(0.0, 3.0)),
                ("dt", rng.choice((1 / 240, 1 / 60, 1 / 30))),
                ("substeps", rng.choice((rng.randint(1, 8), 4, "'auto'"))),
                ("broadphase", rng.choice(STRATEGIES)),
                ("broadphase", rng.choice(STRATEGIES)),
                ("solver", repr(rng.choice(self._solvers()))),
            )
        )
        return f"world.{name} = {value}"

    def edit_snapshot(self, body):
        return (
            "kept = world.snapshot()" if "kept" not in self.space or self.values.chance(0.4) else "world.restore(kept)"
        )

    def edit_twin(self, body):
        unit = self.world.tolerances.pixels_per_meter
        return f"twin = World(world.effects, {self.rng.choice(STRATEGIES)}, pixels_per_meter={unit})"

    def edit_column(self, body):
        told = zip(self.world.bodies["kind"], self.world.bodies["quarantined"], strict=True)
        movers = [row for row, (kind, broken) in enumerate(told) if kind != STATIC and not broken]
        if not movers:
            return self.edit_add(body)
        row = self.rng.choice(movers)
        name, value = self.rng.choice(
            (
                ("x", f"+= {self.values.number(-30.0, 30.0)}"),
                ("vy", f"-= {self.values.number(-300.0, 300.0)}"),
                ("x", "= np.nan"),
                ("vx", "= np.inf"),
            )
        )
        touched = f'; world.touch(world.bodies["id"][{row}])' if self.values.chance(0.8) else ""
        return f'world.bodies["{name}"][{row}] {value}{touched}'

    # --- questions -------------------------------------------------------------------------------------------------

    def ask_ray(self):
        return f"world.ray_cast_all({self.values.place()}, {self.values.pair(300.0)})"

    def ask_cast(self):
        shape = self.rng.choice((self.values.convex(), self.values.shape()))
        return f"world.shape_cast({shape}, {(*self.values.place(), 0.0)}, {self.values.pair(300.0)})"

    def ask_overlap(self):
        return f"world.overlap({self.values.shape()}, {(*self.values.place(), 0.0)})"

    def ask_point(self):
        place = self.values.place()
        return self.rng.choice(
            (f"world.query_point({place})", f"world.closest({place})", f"world.query_aabb((-50, -50), {place})")
        )
