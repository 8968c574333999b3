"""Body: a handle on one row of `world.bodies`. It holds a world and an id, and no state of its own.

Reading or changing a removed body raises KeyError.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from physics import body_values, carving, checks, edit, hints, step, teleport
from physics.annotations import ContinuousName, KindName, Pair, Pose, TierName
from physics.carving import Carved
from physics.collision.areas import with_areas
from physics.collision.manifold import contacts_of
from physics.islands import sleep
from physics.joint import Joint
from physics.math2d import Vec2, rotate
from physics.queries.casts import bounds_of
from physics.shapes.shape import Filter, Material, Shape
from physics.tables.body import CONTINUOUS, DYNAMIC, KINDS, KINEMATIC, STATIC
from physics.tables.columns import ContactRows
from physics.tables.contact import CONTACT_POINT
from physics.world_state import Handle


@checks.setting_by(checks.set_known)
class Body(Handle, metaclass=hints.WithForeignNames):
    """A handle on one body of a world. Positions in px, angles in rad clockwise on the screen, velocities per second.

    World.add_body returns it.

    world: the World of the body; identity: the id of the body.

    A Body equals another handle on the same body. A setter raises TypeError or ValueError, naming the argument, for a
    value that is not allowed. A property, setter or method raises KeyError for a removed body and, if it changes the
    simulation, RuntimeError during a step. A setter that raises leaves the world unchanged.

    >>> ball.velocity = (60, -200)
    >>> world.step()
    >>> ball.position.x > 200, ball.awake, [shape.radius for shape in ball.shapes]
    (True, True, [10.0])
    >>> Body(world, 1) == ball == world.body(1)
    True
    """

    __slots__ = ()

    # --- pose -------------------------------------------------------------------------------------------------------

    @property
    def position(self) -> Vec2:
        """The origin of the body [px]. Setting it teleports the body in the same way as move_to."""
        return self._pair("x", "y")

    @position.setter
    def position(self, value: Pair) -> None:
        teleport.move_to(self._world, self._id, checks.position("position", value), None)

    @property
    def angle(self) -> float:
        """The angle of the body [rad]. Setting it rotates the body about its origin, in the same way as move_to."""
        return self._value("angle")

    @angle.setter
    def angle(self, value: float) -> None:
        teleport.move_to(self._world, self._id, None, checks.angle("angle", value))

    @property
    def center(self) -> Vec2:
        """The centre of mass [px]."""
        return self._pair("center_x", "center_y")

    @property
    def bounds(self) -> tuple[float, float, float, float] | None:
        """The AABB (min_x, min_y, max_x, max_y) [px] of all shapes at the present pose; None if all are empty."""
        self._must_exist()
        return bounds_of(self.world, self.id)

    def to_world(self, point: Pair) -> Vec2:
        """Convert a point from body space to world space. Return (x, y) [px].

        point: (x, y) in body space [px].

        Raises TypeError for a value that is not a point, ValueError for one that is not finite.
        """
        x, y, angle = self._values("x", "y", "angle")
        u, v = rotate(*checks.vector("point", point), math.cos(angle), math.sin(angle))
        return Vec2(x + u, y + v)

    def to_local(self, point: Pair) -> Vec2:
        """Convert a point from world space to body space. Return (x, y) [px].

        point: (x, y) in the world [px].

        Raises TypeError for a value that is not a point, ValueError for one that is not finite.
        """
        x, y, angle = self._values("x", "y", "angle")
        u, v = checks.vector("point", point)
        return Vec2(*rotate(u - x, v - y, math.cos(angle), -math.sin(angle)))

    def move_to(self, position: Pair, angle: float | None = None) -> None:
        """Teleport the body to a pose, without collisions between the old and the new pose.

        position: new origin (x, y) [px].
        angle: new angle [rad]; None: unchanged.

        The body wakes, and so do the islands that it touched. Raises TypeError for an argument of another type;
        ValueError for a number that is not finite or too large, and for an angle other than 0 of a TileGrid.
        """
        teleport.move_to(
            self.world,
            self.id,
            checks.position("position", position),
            None if angle is None else checks.angle("angle", angle),
        )

    def _teleport_of_character(self, position: Vec2 | tuple[float, float]) -> None:
        """Teleport the body of a Character, which calls this method, to a position (x, y) [px]."""
        teleport.move_to(self._world, self._id, position, None, of_character=True)

    def set_target(self, position: Pair, angle: float | None = None) -> None:
        """Move a kinematic body to a pose by the end of the next step.

        position: origin at the end of the step (x, y) [px].
        angle: angle at the end of the step [rad]; None: unchanged.

        The velocity is the distance divided by the length of the next step. The body carries the characters that stand
        on it, and pushes other bodies out of its path. After the step its velocity is 0. Setting a velocity or
        teleporting the body before the next step cancels the target. Raises TypeError for arguments of other types;
        ValueError for a body that is not kinematic, a position that cannot be reached below the speed limit, and a new
        angle without the effect `rotation`.
        """
        step.set_target(self.world, self.id, position, angle)

    @property
    def joints(self) -> tuple[Joint, ...]:
        """The joints of the body, in ascending order of joint ids."""
        self._must_exist()
        joints = self.world.joints
        mine = (joints["body_a"] == self.id) | (joints["body_b"] == self.id)
        return tuple(Joint(self.world, each) for each in joints["id"][mine].tolist())

    # --- motion -----------------------------------------------------------------------------------------------------

    @property
    def velocity(self) -> Vec2:
        """Velocity (x, y) of the centre of mass [px/s].

        Setting it to a value other than 0 raises ValueError for a static body.
        """
        return self._pair("vx", "vy")

    @velocity.setter
    def velocity(self, value: Pair) -> None:
        world, identity = self._world, self._id
        world._unstepped()
        value = checks.vector("velocity", value)
        row, columns = world._row_at(identity), world._bodies.columns
        kind = columns["kind"][row]
        if kind == STATIC and value != (0.0, 0.0):
            raise ValueError(f"velocity must be (0, 0) for static body {identity} (got {value})")
        if kind == KINEMATIC:
            teleport.check_no_character(world, identity, "velocity")
        columns["vx"][row], columns["vy"][row] = value
        world._targets.pop(identity, None)
        self._stir(row)

    @property
    def angular_velocity(self) -> float:
        """Angular velocity [rad/s].

        Setting it to a value other than 0 raises ValueError without the effect `rotation`, for a static body, and for a
        body with a TileGrid.
        """
        return self._value("angular_velocity")

    @angular_velocity.setter
    def angular_velocity(self, value: float) -> None:
        world, identity = self._world, self._id
        world._unstepped()
        value = checks.number("angular_velocity", value)
        row, columns = world._row_at(identity), world._bodies.columns
        if value != 0.0:
            world._needs("rotation", "angular_velocity", True)
            if columns["kind"][row] == STATIC:
                raise ValueError(f"angular_velocity must be 0 for static body {identity} (got {value})")
            teleport.check_no_character(world, identity, "angular_velocity")
            edit.check_grid_stands(world._shapes_of[identity], value)
        columns["angular_velocity"][row] = value
        world._targets.pop(identity, None)
        self._stir(row)

    @property
    def awake(self) -> bool:
        """Whether the body is awake. Steps skip a sleeping body until it is woken, for example by a contact."""
        return self._value("awake")

    @property
    def mass(self) -> float:
        """Mass [density px²]. It is 0 if no mass was given and no shape has an area."""
        return self._value("mass")

    @property
    def inertia(self) -> float:
        """Moment of inertia about the centre of mass [density px⁴]."""
        return self._value("inertia")

    @property
    def kinetic_energy(self) -> float:
        """Kinetic energy, m v² / 2 + I ω² / 2 [mass px²/s²]."""
        mass, inertia, vx, vy, spin = self._values("mass", "inertia", "vx", "vy", "angular_velocity")
        return 0.5 * mass * (vx * vx + vy * vy) + 0.5 * inertia * spin * spin

    def velocity_at(self, point: Pair) -> Vec2:
        """Return the velocity (x, y) [px/s] of the material point of the body that is at a world point.

        point: (x, y) in the world [px].

        Raises TypeError for a value that is not a point, ValueError for one that is not finite.
        """
        vx, vy, spin, cx, cy = self._values("vx", "vy", "angular_velocity", "center_x", "center_y")
        x, y = checks.vector("point", point)
        return Vec2(vx - spin * (y - cy), vy + spin * (x - cx))

    def apply_force(self, force: Pair, point: Pair | None = None) -> None:
        """Add a force that acts on the body during the next step.

        force: (x, y) [mass px/s²].
        point: point of application (x, y) in the world [px]; None: the centre of mass.

        Raises TypeError for arguments of other types; ValueError for numbers that are not finite and for a body that is
        not dynamic. Also raises ValueError in a world without any of the effects `response`, `gravity`, `drag`, `wind`.
        """
        self.world._unstepped()
        force = checks.vector("force", force)
        self.world._needs_velocities("apply_force")
        point = None if point is None else checks.vector("point", point)
        row, columns = self._dynamic("apply_force")
        total = checks.vector("sum of forces", (columns["force_x"][row] + force[0], columns["force_y"][row] + force[1]))
        columns["force_x"][row], columns["force_y"][row] = total
        row = self._stir(row)
        if point is not None:
            x, y = point
            columns["torque"][row] += (x - columns["center_x"][row]) * force[1] - (
                y - columns["center_y"][row]
            ) * force[0]

    def apply_impulse(self, impulse: Pair, point: Pair | None = None) -> None:
        """Apply an impulse, which changes the velocity immediately by impulse / mass.

        impulse: (x, y) [mass px/s].
        point: point of application (x, y) in the world [px]; None: the centre of mass. With a point and the effect
            `rotation`, the angular velocity changes too.

        Raises TypeError for arguments of other types, ValueError for numbers that are not finite and for a body that is
        not dynamic.
        """
        self.world._unstepped()
        impulse = checks.vector("impulse", impulse)
        point = None if point is None else checks.vector("point", point)
        row, columns = self._dynamic("apply_impulse")
        row = self._stir(row)
        inverse_mass = columns["inverse_mass"][row]
        columns["vx"][row], columns["vy"][row] = checks.vector(
            "velocity after the impulse",
            (columns["vx"][row] + inverse_mass * impulse[0], columns["vy"][row] + inverse_mass * impulse[1]),
        )
        if point is not None and self.world.effects.rotation:
            x, y = point
            columns["angular_velocity"][row] += columns["inverse_inertia"][row] * (
                (x - columns["center_x"][row]) * impulse[1] - (y - columns["center_y"][row]) * impulse[0]
            )

    def apply_torque(self, torque: float) -> None:
        """Add a torque that acts on the body during the next step.

        torque: [mass px²/s²], positive clockwise on the screen.

        Raises TypeError for a value that is not a number; ValueError if it is not finite, without the effect
        `rotation`, and for a body that is not dynamic.
        """
        self.world._unstepped()
        torque = checks.number("torque", torque)
        self.world._needs("rotation", "apply_torque", True)
        row, columns = self._dynamic("apply_torque")
        row = self._stir(row)
        columns["torque"][row] += torque

    def _dynamic(self, what) -> tuple[int, dict[str, Any]]:
        """Return (row number of this body, columns of world.bodies by name). Raises ValueError if it is not dynamic.

        what: name of the operation, for the message.
        """
        row, columns = self._world._row_at(self._id), self._world._bodies.columns
        if columns["kind"][row] != DYNAMIC:
            raise ValueError(f"{what} needs a dynamic body; body {self.id} is {self.kind}")
        return row, columns

    # --- contacts, carving, sleep, removal ----------------------------------------------------------------------

    @property
    def contacts(self) -> ContactRows:
        """The contact points of this body as a copy of their CONTACT_POINT rows, in the order of shape ids.

        They include the contacts of the last step and the stored contacts with or between sleeping bodies.
        """
        world, row = self.world, self._row
        points = world.contacts
        points = points[(points["body_a"] == self.id) | (points["body_b"] == self.id)]
        asleep = contacts_of(with_areas(world, world.sleeping_set.naming(self.id, int(row["island"]))))
        both = np.concatenate([points, asleep])
        return both[np.lexsort((both["shape_b"], both["shape_a"]))].view(CONTACT_POINT)  # pyright: ignore[reportReturnType]

    def carve(self, shape: Shape, pose: Pose, crumb: int = 4) -> Carved:
        """Remove from the body's masks all pixels with centres inside a shape, or on its boundary. Return a Carved.

        shape: a Circle, Capsule, Polygon or PixelMask.
        pose: pose of the shape in the world, (x, y) or (x, y, angle) [px, rad].
        crumb: a whole number >= 0. Separated pieces with fewer pixels than this number are deleted.

        Pieces are 8-connected. In a dynamic body, each carved mask keeps only its largest piece. In a body of another
        kind, pieces that were separate before the cut stay, and a piece that splits keeps its largest part. Of equally
        large pieces, the one with the first pixel stays. The other pieces become dynamic bodies; their pixels keep
        their velocities. The body is removed if it has no shape left, or if it is dynamic and has no mass left. Bodies
        that touch carved pixels wake. Raises TypeError for an argument of another type; ValueError without the effect
        `carving`, for a body without a PixelMask, and for a pose or crumb out of range; RuntimeError during a step.
        """
        self._must_exist()
        found = carving.carve(self.world, self.id, shape, pose, crumb)
        return found._replace(fragments=tuple(Body(self.world, each) for each in found.fragments))

    def wake(self) -> None:
        """Wake the body and its island."""
        self.world._unlocked()
        self._must_exist()
        sleep.disturb(self.world, [self.id])

    def set_kind(self, kind: KindName) -> None:
        """Set the kind of the body. The velocities of a body that becomes static are set to 0.

        kind: "static", "kinematic" or "dynamic".

        Raises TypeError for a value that is not a string; ValueError for another kind, for shapes that a body of this
        kind cannot have, and for the body of a character, which must stay kinematic.
        """
        edit.set_kind(self.world, self.id, checks.choice("kind", kind, KINDS))

    def restore(self) -> None:
        """Add a quarantined body to the simulation again, at rest at its last pose within range.

        A body is quarantined (disabled) when one of its numbers is not finite or out of range; a position or angle is
        out of range from 2**52 px or rad on. Pose, velocity and forces are then reset; set any other such number, such
        as gravity_scale, to a valid value before this call. Other bodies are unchanged.
        """
        edit.restore(self.world, self.id)

    def remove(self) -> None:
        """Remove the body and its joints from the world."""
        self._world._remove_one(self._id)

    # --- kind and user value -------------------------------------------------------------------------------------

    @property
    def kind(self) -> KindName:
        """The kind: "static" (never moves), "kinematic" (moves only by its velocity) or "dynamic". See set_kind."""
        return KINDS[self._value("kind")]

    @property
    def user(self) -> Any:
        """Any value that the caller attaches to the body. Snapshots and digests do not contain it."""
        self._must_exist()
        return self._world._users.get(self._id)

    @user.setter
    def user(self, value: Any) -> None:
        self._must_exist()
        self.world._users[self.id] = value

    # --- default values of its shapes ----------------------------------------------------------------------------

    @property
    def material(self) -> Material:
        """The material of the shapes without a material of their own. Setting it recomputes the mass."""
        return body_values.material_of(self.world, self.id)

    @material.setter
    def material(self, value: Material) -> None:
        body_values.set_material(self.world, self.id, value)

    @property
    def filter(self) -> Filter:
        """The collision filter of the shapes without a filter of their own."""
        return body_values.filter_of(self.world, self.id)

    @filter.setter
    def filter(self, value: Filter) -> None:
        body_values.set_filter(self.world, self.id, value)

    @property
    def sensor(self) -> bool:
        """Whether the shapes without a sensor value of their own are sensors, which report overlaps and do not push.

        Sensors count towards the mass of the body. Setting True raises ValueError without the effect `sensors`.
        """
        return self._definitions["sensor"].item()

    @sensor.setter
    def sensor(self, value: bool) -> None:
        body_values.set_sensor(self.world, self.id, value)

    # --- settings of its motion -----------------------------------------------------------------------------------

    @property
    def gravity_scale(self) -> float:
        """Factor by which the world's gravity is multiplied for this body."""
        return self._value("gravity_scale")

    @gravity_scale.setter
    def gravity_scale(self, value: float) -> None:
        self.world._unlocked()
        row = self.world._row_number(self.id)
        self.world._bodies.columns["gravity_scale"][row] = checks.number("gravity_scale", value)
        self._stir(row)

    @property
    def allow_sleep(self) -> bool:
        """Whether the body's island may sleep. A dynamic body with False wakes its island and keeps it awake."""
        return self._value("allow_sleep")

    @allow_sleep.setter
    def allow_sleep(self, value: bool) -> None:
        self.world._unlocked()
        row, value = self.world._row_number(self.id), checks.flag("allow_sleep", value)
        self.world._bodies.columns["allow_sleep"][row] = value
        if not value:
            self._stir(row)

    @property
    def bullet(self) -> bool:
        """Whether the body is also swept against other dynamic bodies, so that it cannot pass through them.

        A solver that does not stack ("projection", "blocking") ignores this value and sweeps all pairs of dynamic
        bodies. Setting True raises ValueError without the effect `continuous`.
        """
        return self._value("bullet")

    @bullet.setter
    def bullet(self, value: bool) -> None:
        self.world._unlocked()
        row = self._row
        row["bullet"] = edit.checked_bullet(self.world, value)

    @property
    def continuous(self) -> ContinuousName:
        """The mode of continuous collision, which stops the body at its first impact in a step.

        "off": no test. "ray": test the path of the centre, the cheapest mode. "swept": test the path of the shapes
        without rotation, or with rotation in contact. "toi": test the path of the shapes with rotation (time of
        impact). "auto": as "toi", but only in steps in which the body moves by more than half its size. Setting "ray",
        "swept" or "toi" raises ValueError without the effect `continuous`.
        """
        return CONTINUOUS[self._value("continuous")]

    @continuous.setter
    def continuous(self, value: ContinuousName) -> None:
        body_values.set_continuous(self.world, self.id, value)

    @property
    def fixed_rotation(self) -> bool:
        """Whether contacts and impulses leave the angular velocity unchanged. Setting True also sets it to 0."""
        return self._value("fixed_rotation")

    @fixed_rotation.setter
    def fixed_rotation(self, value: bool) -> None:
        body_values.set_fixed_rotation(self.world, self.id, value)

    # --- shapes ----------------------------------------------------------------------------------------------------

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The shapes of the body. If a tier is set, they are the shapes that replace its PixelMask."""
        self._must_exist()
        return self.world._shapes_of[self.id]

    @property
    def shape_ids(self) -> tuple[int, ...]:
        """The ids of the shapes, in the order of `shapes`."""
        return edit.shape_ids(self.world, self.id)

    def set_shapes(self, *shapes: Shape) -> None:
        """Replace the shapes of the body. Values of the body, such as its material, stay; Body.tier becomes None.

        *shapes: the new shapes.

        The new shapes get new ids. Exception: the ids stay if all old and new shapes are masks and their number is
        unchanged. Contacts on surface that did not change keep their impulses. Raises TypeError for values that are
        not shapes, ValueError for shapes that a body of this kind cannot have.
        """
        edit.set_shapes(self.world, self.id, shapes)

    def set_cells(self, cells: ArrayLike, solid: ArrayLike) -> None:
        """Make cells of the body's TileGrid solid or empty.

        cells: (n, 2) int, (column, row) of each cell.
        solid: a bool, or one bool for each cell.

        A one-way cell or a slope becomes an ordinary solid or empty cell. The shape keeps its id. Only bodies that
        touch a changed cell wake; no other body gets begin or end events. Raises TypeError for values of other types;
        ValueError for a cell outside the grid, and for a body that does not have exactly one TileGrid.
        """
        edit.exchange_cells(self.world, self.id, cells, solid)

    def add_shape(self, shape: Shape) -> int:
        """Append a shape to the body and recompute the mass. Return the id of the shape. Body.tier becomes None.

        shape: the new shape, in body space.

        Raises TypeError for a value that is not a shape, ValueError for a shape that a body of this kind cannot have.
        """
        return edit.add_shape(self.world, self.id, shape)

    def remove_shape(self, shape_id: int) -> None:
        """Remove a shape from the body and recompute the mass. Body.tier becomes None.

        shape_id: id of the shape, one of shape_ids.

        Raises KeyError if the body has no shape with this id; TypeError if shape_id is not a whole number; ValueError
        if a body of this kind cannot have only the remaining shapes.
        """
        edit.remove_shape(self.world, self.id, shape_id)

    @property
    def tier(self) -> TierName | None:
        """The simplification of the body's PixelMask: one of TIERS, such as "hull"; None if it is not simplified.

        Setting a tier replaces the shapes of the body by physics.fit(mask, tier). Raises ValueError for an unknown
        tier, and for a body that was not made from exactly one PixelMask.
        """
        self._must_exist()
        return self.world._tiers.get(self.id)

    @tier.setter
    def tier(self, value: TierName | None) -> None:
        edit.set_tier(self.world, self.id, value)

    # --- rows --------------------------------------------------------------------------------------------------------

    @property
    def _row(self) -> np.void:
        return self.world._body_row(self.id)

    def _value(self, name: str) -> Any:
        """Return the value of a column in the body's BODY row, as a Python number. name: name of the column.

        Reading the column takes a tenth of the time of reading the row.
        """
        world = self._world
        return world._bodies.columns[name][world._row_at(self._id)]

    def _values(self, *names: str) -> list[Any]:
        """Return the values of the named columns in the body's BODY row, as Python numbers in the order of `names`."""
        world = self._world
        row, columns = world._row_at(self._id), world._bodies.columns
        return [columns[name][row] for name in names]

    def _pair(self, first: str, second: str) -> Vec2:
        world = self._world
        row, columns = world._row_at(self._id), world._bodies.columns
        return Vec2(columns[first][row], columns[second][row])

    @property
    def _definitions(self) -> np.void:
        """The body's BODY_DEF row: given mass, material, filter and sensor flag."""
        return self.world._definitions.rows[self.world._row_number(self.id)]

    def _must_exist(self) -> None:
        """Raise KeyError if the body was removed."""
        self._world._row_at(self._id)

    def _stir(self, row: int) -> int:
        """Wake this body and set its sleep time to 0. row: its row number in world.bodies.

        Return its row number afterwards, which may differ, because waking may drop the rows of removed bodies.
        """
        columns = self._world._bodies.columns
        if not columns["awake"][row]:
            row = sleep.disturb_one(self._world, self._id, row)
        columns["sleep_time"][row] = 0.0
        return row
