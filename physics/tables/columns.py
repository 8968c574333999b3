"""Static types of the arrays that a step reports, with named columns: a type checker rejects a misspelt column.

The arrays are plain NumPy structured arrays; the classes of this module are never instantiated. A test compares their
names with the dtypes.
"""

from collections.abc import Iterator
from typing import Any, Generic, Literal, Never, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

# Names of the columns of each type, as literals.
Floats = TypeVar("Floats")
Ints = TypeVar("Ints")
Flags = TypeVar("Flags")
Texts = TypeVar("Texts")
Chosen = slice | NDArray[np.bool_] | NDArray[np.integer[Any]] | list[int] | list[bool]  # selects rows


class Row(np.void, Generic[Floats, Ints, Flags, Texts]):
    """One row of a structured array: row["x"] is its value in the column x."""

    @overload
    def __getitem__(self, key: Floats, /) -> np.float64: ...
    @overload
    def __getitem__(self, key: Ints, /) -> np.int64: ...
    @overload
    def __getitem__(self, key: Flags, /) -> np.bool_: ...
    @overload
    def __getitem__(self, key: Texts, /) -> np.str_: ...
    def __getitem__(self, key: Any, /) -> Any:  # pyright: ignore[reportIncompatibleMethodOverride]
        return super().__getitem__(key)

    def __setitem__(self, key: Floats | Ints | Flags | Texts, value: Any, /) -> None:  # pyright: ignore[reportIncompatibleMethodOverride]
        super().__setitem__(key, value)  # pyright: ignore[reportCallIssue, reportArgumentType]


class Rows(Generic[Floats, Ints, Flags, Texts], np.ndarray[tuple[int], np.dtype[np.void]]):
    """Rows of a structured array: rows["x"] is a column, rows[3] a row, rows[rows["awake"]] a selection of rows."""

    @overload
    def __getitem__(self, key: Floats, /) -> NDArray[np.float64]: ...
    @overload
    def __getitem__(self, key: Ints, /) -> NDArray[np.int64]: ...
    @overload
    def __getitem__(self, key: Flags, /) -> NDArray[np.bool_]: ...
    @overload
    def __getitem__(self, key: Texts, /) -> NDArray[np.str_]: ...
    @overload
    def __getitem__(self, key: int | np.integer[Any], /) -> Row[Floats, Ints, Flags, Texts]: ...
    @overload
    def __getitem__(self, key: Chosen, /) -> "Rows[Floats, Ints, Flags, Texts]": ...
    @overload
    def __getitem__(self, key: list[str], /) -> NDArray[np.void]: ...
    def __getitem__(self, key: Any, /) -> Any:  # pyright: ignore[reportIncompatibleMethodOverride]
        return super().__getitem__(key)

    @overload
    def __setitem__(self, key: Floats | Ints | Flags | Texts, value: Any, /) -> None: ...
    @overload
    def __setitem__(self, key: int | np.integer[Any] | Chosen, value: Any, /) -> None: ...
    def __setitem__(self, key: Any, value: Any, /) -> None:  # pyright: ignore[reportIncompatibleMethodOverride]
        super().__setitem__(key, value)

    def __iter__(self) -> Iterator[Row[Floats, Ints, Flags, Texts]]:
        return super().__iter__()  # pyright: ignore[reportReturnType]


# ---- columns ---------------------------------------------------------------------------------------------------------

BodyFloats = Literal[
    "x",
    "y",
    "angle",
    "center_x",
    "center_y",
    "vx",
    "vy",
    "angular_velocity",
    "inverse_mass",
    "inverse_inertia",
    "extent",
    "min_half_extent",
    "inradius",
    "previous_x",
    "previous_y",
    "previous_angle",
    "settled_x",
    "settled_y",
    "settled_angle",
    "fraction",
    "force_x",
    "force_y",
    "torque",
    "gravity_scale",
    "mass",
    "inertia",
    "local_center_x",
    "local_center_y",
    "still_x",
    "still_y",
    "still_angle",
    "sleep_time",
    "rocking_x",
    "rocking_y",
    "rocking_angle",
    "rocking_time",
    "reserve",
    "cooldown",
]
BodyInts = Literal["id", "kind", "continuous", "island", "substeps"]
BodyFlags = Literal[
    "awake",
    "active",
    "dirty",
    "quarantined",
    "bullet",
    "fixed_rotation",
    "allow_sleep",
    "forced",
    "has_current_contacts",
]
BodyRows = Rows[BodyFloats, BodyInts, BodyFlags, Never]
ContactFloats = Literal[
    "point_x", "point_y", "normal_x", "normal_y", "separation", "normal_impulse", "tangent_impulse", "area"
]
ContactInts = Literal["body_a", "body_b", "shape_a", "shape_b", "feature"]
ContactRows = Rows[ContactFloats, ContactInts, Never, Never]
EventFloats = Literal["point_x", "point_y", "normal_x", "normal_y"]
EventInts = Literal["body_a", "body_b", "shape_a", "shape_b"]
EventRows = Rows[EventFloats, EventInts, Never, Never]
HitFloats = Literal["point_x", "point_y", "normal_x", "normal_y", "speed", "normal_impulse"]
HitInts = Literal["body_a", "body_b", "shape_a", "shape_b"]
HitRows = Rows[HitFloats, HitInts, Never, Never]
QuarantineInts = Literal["body",]
QuarantineTexts = Literal["reason",]
QuarantineRows = Rows[Never, QuarantineInts, Never, QuarantineTexts]
JointFloats = Literal[
    "local_ax",
    "local_ay",
    "local_bx",
    "local_by",
    "axis_x",
    "axis_y",
    "reference",
    "lower",
    "upper",
    "motor_speed",
    "motor_max",
    "spring_hertz",
    "spring_damping",
    "spring_target",
    "point_hertz",
    "point_damping",
    "point_max",
    "angle_hertz",
    "angle_damping",
    "angle_max",
    "target_vx",
    "target_vy",
    "target_spin",
    "break_force",
    "break_torque",
    "angle",
    "translation",
    "speed",
    "separation",
    "force_x",
    "force_y",
    "torque",
    "strain",
    "point_force_x",
    "point_force_y",
    "hold_torque",
    "spring_force",
    "motor_force",
    "lower_force",
    "upper_force",
    "arm_ax",
    "arm_ay",
    "arm_bx",
    "arm_by",
    "base_x",
    "base_y",
    "start_nx",
    "start_ny",
    "start_angle",
    "ax",
    "ay",
    "bx",
    "by",
    "apart_x",
    "apart_y",
    "nx",
    "ny",
    "turn",
    "point_x",
    "point_y",
    "hold_impulse",
    "spring",
    "spring_aim",
    "motor",
    "low",
    "high",
    "total_x",
    "total_y",
    "total_torque",
    "ratio",
    "phase",
    "ratchet",
    "ground_ax",
    "ground_ay",
    "ground_bx",
    "ground_by",
    "rate",
]
JointInts = Literal[
    "id",
    "kind",
    "body_a",
    "body_b",
    "hold",
    "coordinate",
    "body_row_a",
    "body_row_b",
    "motion_a",
    "motion_b",
    "joint_a",
    "joint_b",
]
JointFlags = Literal[
    "enabled",
    "contacts",
    "locks_angle",
    "follows_point",
    "follows_angle",
    "turns_motor",
    "awake",
    "direct",
    "broken",
    "exact_limits",
    "exact_motor",
    "in_open_tree",
    "is_pin",
]
JointRows = Rows[JointFloats, JointInts, JointFlags, Never]
BrokenFloats = Literal["force", "torque"]
BrokenInts = Literal["joint", "body_a", "body_b"]
BrokenTexts = Literal["reason",]
BrokenRows = Rows[BrokenFloats, BrokenInts, Never, BrokenTexts]
RayFloats = Literal["point_x", "point_y", "normal_x", "normal_y", "fraction"]
RayInts = Literal["body", "shape"]
RayHits = Rows[RayFloats, RayInts, Never, Never]
PointInts = Literal["point", "body"]
PointHits = Rows[Never, PointInts, Never, Never]
