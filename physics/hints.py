"""Hints in error messages: the name or the expression that the caller probably meant by a wrong argument.

A hint is the end of a message, after the value: "filter must be a Filter (got 3): write Filter(membership=3)". The
functions run only after an argument was rejected, so valid arguments take no extra time.
"""

import difflib
import numbers
from abc import ABCMeta
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import FrozenInstanceError
from functools import wraps
from inspect import Parameter, getattr_static, signature
from typing import Any, Never, TypeVar

import numpy as np

NEAR_NAME = 0.7  # difflib similarity from which a name counts as a misspelling of another
LONGEST_SHOWN = 200  # [characters] of a wrong value in a message
SHORT = 60  # [characters] of a value that a hint repeats
Called = TypeVar("Called", bound=Callable[..., Any])
Made = TypeVar("Made", bound=type)

MATERIALS = ("density", "friction", "restitution", "rolling_resistance", "surface_speed")
KIND_WORDS = ("static", "kinematic", "dynamic")  # in the order of STATIC, KINEMATIC, DYNAMIC
# Keywords of other engines, and values of another argument: {keyword: ((argument, expression), …)}. The hint is the
# first expression whose argument the called function has. In an expression {} is the given value.
MEANT: dict[str, tuple[tuple[str, str], ...]] = {
    **{name: (("material", f"material=Material({name}={{}})"),) for name in MATERIALS},
    **dict.fromkeys(
        ("bounce", "bounciness", "elasticity"),
        (("material", "material=Material(restitution={})"), ("restitution", "restitution={}")),
    ),
    "membership": (("filter", "filter=Filter(membership={})"),),
    "mask": (("filter", "filter=Filter(mask={})"),),
    **dict.fromkeys(
        ("category", "categories", "category_bits", "layer", "layers"),
        (("filter", "filter=Filter(membership={})"), ("membership", "membership={}")),
    ),
    **dict.fromkeys(
        ("group", "groups", "group_index"),
        (("filter", "filter=Filter(membership=…, mask=…)"), ("membership", "membership=…, mask=…, sets of bits")),
    ),
    **dict.fromkeys(
        ("ignore", "exclude"), (("filter", "filter=Filter(mask=…), with the membership of the shapes that can be hit"),)
    ),
    **dict.fromkeys(
        ("mask_bits", "collision_mask", "collides_with"), (("filter", "filter=Filter(mask={})"), ("mask", "mask={}"))
    ),
    **dict.fromkeys(
        ("pos", "position", "center", "centre", "offset", "location", "xy"),
        (
            ("positions", "positions=[{}], a place for each body"),
            ("position", "position={}"),
            ("center", "center={}"),
            ("origin", "origin={}"),
            ("at", "at={}"),
        ),
    ),
    **dict.fromkeys(("x", "y"), (("position", "position=(x, y)"), ("center", "center=(x, y)"))),
    **dict.fromkeys(("rotation", "orientation", "theta", "degrees"), (("angle", "angle=…, in radians"),)),
    **dict.fromkeys(("vel", "linear_velocity", "speed"), (("velocity", "velocity=(vx, vy)"),)),
    **dict.fromkeys(("omega", "spin", "angular_speed"), (("angular_velocity", "angular_velocity={}"),)),
    **{word: (("kind", f'kind="{word}"'),) for word in KIND_WORDS},
    **dict.fromkeys(("body_type", "type"), (("kind", 'kind="static", "kinematic" or "dynamic"'),)),
    **dict.fromkeys(("is_sensor", "trigger", "is_trigger"), (("sensor", "sensor={}"),)),
    "include_sensors": (("sensors", "sensors={}"),),
    **dict.fromkeys(
        ("direction", "vector", "delta", "to"), (("translation", "translation=…, the end minus the origin"),)
    ),
    **dict.fromkeys(("user_data", "data", "tag", "owner", "name", "collision_type"), (("user", "user={}"),)),
    "velocity": (("velocities", "velocities=[{}] * n"),),
    "angle": (("angles", "angles=[{}] * n"),),
    **dict.fromkeys(("shape", "shapes"), (("*shapes", "the shapes first, without a name: add_body(Circle(8), …)"),)),
    **dict.fromkeys(("damping", "linear_damping"), (("drag", "drag={}"), ("gravity_scale", "World(drag={})"))),
    "gravity": (("gravity_scale", "gravity_scale=…, a factor on World(gravity=…)"),),
    "fps": (("dt", "dt=1 / {}"),),
    **dict.fromkeys(("iterations", "velocity_iterations", "sub_steps"), (("substeps", "substeps={}"),)),
    **dict.fromkeys(("ppm", "scale", "meter"), (("pixels_per_meter", "pixels_per_meter={}"),)),
    **dict.fromkeys(("r", "diameter"), (("radius", "radius=…"),)),
    **dict.fromkeys(("w", "size"), (("width", "width=…, height=…"), ("radius", "radius=…"))),
    "h": (("height", "height={}"),),
    **dict.fromkeys(("vertices", "corners", "verts"), (("points", "points={}"),)),
    **dict.fromkeys(("p1", "start", "start_pos"), (("a", "a={}"),)),
    **dict.fromkeys(
        ("p2", "end", "end_pos"), (("translation", "translation=…, the end minus the origin"), ("b", "b={}"))
    ),
    "thickness": (("radius", "radius=…, half of the thickness"),),
    **dict.fromkeys(("body_a", "bodyA"), (("a", "a={}"),)),
    **dict.fromkeys(("body_b", "bodyB"), (("b", "b={}"), ("body", "body={}"))),
    **dict.fromkeys(("anchor", "pivot", "point"), (("at", "at={}"), ("at_a", "at_a=…, at_b=…"))),
    **dict.fromkeys(("anchor_a", "anchor_1"), (("at_a", "at_a={}"), ("at", "at={}"))),
    **dict.fromkeys(("anchor_b", "anchor_2"), (("at_b", "at_b={}"), ("at", "at={}"))),
    "motor_speed": (("motor", "motor=Drive(speed={}, max=…)"),),
    **dict.fromkeys(("lower", "upper", "min", "max"), (("limits", "limits=(low, high)"),)),
    **dict.fromkeys(("max_length", "max_distance"), (("limits", "limits=(None, {})"),)),
    **dict.fromkeys(("min_length", "min_distance"), (("limits", "limits=({}, None)"),)),
    **dict.fromkeys(("stiffness", "frequency"), (("spring", "spring=Spring(hertz=…)"), ("hertz", "hertz=…"))),
    **dict.fromkeys(("rate", "max_torque", "force"), (("speed", "speed=…, max=…"),)),
    "collide_bodies": (("contacts", "contacts={}"),),
    "smoothing": (("smooth", "smooth={}"),),
}
EFFECTS = (
    "narrowphase", "response", "gravity", "drag", "wind", "rotation", "friction", "restitution", "stacking",
    "continuous", "sleeping", "sensors", "persist", "one_way", "conveyor", "joints", "carving",
)  # fmt: skip
MEANT |= {
    name: (*MEANT.get(name, ()), ("effects", f"effects=Effects.rigid_bodies().with_({name}={{}})")) for name in EFFECTS
}

# Attributes that cannot be set, and those of other engines: {class: {attribute: expression}}, with {} as in MEANT.
ASSIGNED: dict[str, dict[str, str]] = {
    "Body": {
        **{name: f"body.material = Material({name}={{}})" for name in MATERIALS},
        **dict.fromkeys(("bounce", "bounciness", "elasticity"), "body.material = Material(restitution={})"),
        **dict.fromkeys(("mass", "inertia"), "body.material = Material(density=…), or add_body(…, mass=…)"),
        **dict.fromkeys(("kind", "type", "body_type"), "body.set_kind({})"),
        **dict.fromkeys(("shapes", "shape"), "body.set_shapes(…)"),
        "mask": "body.set_shapes(PixelMask.from_surface(…))",
        **dict.fromkeys(("pos", "location"), "body.position = {}"),
        **dict.fromkeys(("x", "y"), "body.position = (x, y)"),
        **dict.fromkeys(("center", "centre", "rect", "bounds"), "body.position = …, the place of the origin"),
        **dict.fromkeys(("rotation", "orientation"), "body.angle = …, in radians"),
        **dict.fromkeys(("vel", "linear_velocity"), "body.velocity = {}"),
        **dict.fromkeys(("vx", "vy"), "body.velocity = (vx, vy)"),
        "force": "body.apply_force({})",
        "torque": "body.apply_torque({})",
        "awake": "body.wake()",
        **dict.fromkeys(("user_data", "data", "tag", "name", "image", "sprite", "collision_type"), "body.user = {}"),
        **dict.fromkeys(("layer", "category", "group"), "body.filter = Filter(membership=…, mask=…)"),
    },
    "Joint": {
        **dict.fromkeys(("stiffness", "frequency", "hertz", "damping"), "joint.spring = Spring(hertz=…, damping=…)"),
        **dict.fromkeys(("rate", "motor_speed"), "joint.motor = Drive(speed={}, max=…)"),
        **dict.fromkeys(("max_torque", "max_motor_torque"), "joint.motor = Drive(speed=…, max={})"),
        **dict.fromkeys(("lower", "upper", "min", "max"), "joint.limits = (low, high)"),
        "break_force": "joint.breaks = ({}, None)",
        "max_force": "joint.breaks = ({}, None), or give max_force to a new Target or Motor",
        **dict.fromkeys(("collide_bodies", "collide_connected"), "joint.contacts = {}"),
        "target": "joint.point = (x, y)",
        **dict.fromkeys(
            ("body_a", "body_b", "a", "b", "anchor_a", "anchor_b", "at", "axis", "kind"),
            "joint.remove(), and world.add_joint(…) for another one",
        ),
    },
    "World": {
        "effects": "world.set_effects({})",
        "bodies": "world.add_body(…)",
        "shapes": "world.add_body(…)",
        "joints": "world.add_joint(…)",
        "fps": "world.dt = 1 / {}",
        "iterations": "world.substeps = {}",
        "damping": "world.drag = {}",
    },
}
ASSIGNED["Character"] = {
    **dict.fromkeys(("position", "pos", "x", "y", "rect", "center"), "character.move_to({})"),
    **dict.fromkeys(("velocity", "vel", "vx", "vy", "speed"), "character.move(dx, dy), in pixels of this step"),
    **{name: f"character.body.{name} = {{}}" for name in ("user", "filter")},
    "max_slope": "Character(…, max_slope={})",
}
_OWN_VALUES = {name: f"shape.with_({name}={{}})" for name in ("material", "filter", "sensor")}
ASSIGNED |= {
    "PixelMask": {
        **_OWN_VALUES,
        "one_way": "mask.with_(one_way={})",
        "size": "mask.scaled(factor)",
        **dict.fromkeys(("solid", "words"), "body.carve(…), or body.set_shapes(PixelMask(solid))"),
    },
    "TileGrid": {**_OWN_VALUES, "solid": "body.set_cells(cells, solid)"},
    "Shape": _OWN_VALUES,
}


# Attributes of other engines that are read, and columns: {class: {attribute: expression}}.
READ: dict[str, dict[str, str]] = {
    "Body": {
        **{name: f"body.material.{name}" for name in MATERIALS},
        **dict.fromkeys(("bounce", "bounciness", "elasticity"), "body.material.restitution"),
        **dict.fromkeys(("type", "body_type", "is_static", "is_dynamic", "is_kinematic"), "body.kind"),
        **dict.fromkeys(("shape", "mask", "fixtures"), "body.shapes[0]"),
        **dict.fromkeys(("filter_mask", "mask_bits"), "body.filter.mask"),
        **dict.fromkeys(("layer", "category", "categories", "group", "membership"), "body.filter.membership"),
        **dict.fromkeys(("pos", "location", "xy"), "body.position"),
        **{name: f"body.position.{name}" for name in ("x", "y")},
        **dict.fromkeys(("centre", "world_center", "worldCenter", "center_of_gravity"), "body.center"),
        **dict.fromkeys(("rect", "bb", "aabb", "width", "height", "size"), "body.bounds, (min_x, min_y, max_x, max_y)"),
        **dict.fromkeys(("rotation", "orientation"), "body.angle, in radians"),
        "rotation_vector": "Vec2(1, 0).rotated(body.angle)",
        **dict.fromkeys(("vel", "linear_velocity", "linearVelocity"), "body.velocity"),
        **dict.fromkeys(("speed",), "body.velocity.length"),
        **{f"v{name}": f"body.velocity.{name}" for name in ("x", "y")},
        **dict.fromkeys(("omega", "spin", "angularVelocity"), "body.angular_velocity"),
        **dict.fromkeys(("force", "torque"), 'world.bodies["force_x"][world.rows(body)], likewise force_y and torque'),
        "moment": "body.inertia",
        **dict.fromkeys(("user_data", "userData", "data", "tag", "name", "image", "sprite"), "body.user"),
        "collision_type": "body.user",
        "space": "body.world",
        **dict.fromkeys(("constraints", "joint"), "body.joints"),
        **dict.fromkeys(("is_sleeping", "sleeping"), "not body.awake"),
        **dict.fromkeys(("kill", "destroy"), "body.remove()"),
        **dict.fromkeys(("activate", "sleep"), "body.wake(); bodies fall asleep by themselves"),
        **dict.fromkeys(
            ("apply_force_at_world_point", "apply_force_at_local_point", "ApplyForce"),
            "body.apply_force(force, point), with a point in the world",
        ),
        **dict.fromkeys(
            ("apply_impulse_at_world_point", "apply_impulse_at_local_point", "ApplyLinearImpulse"),
            "body.apply_impulse(impulse, point), with a point in the world",
        ),
        "local_to_world": "body.to_world(point)",
        "world_to_local": "body.to_local(point)",
        "velocity_at_world_point": "body.velocity_at(point)",
        "each_arbiter": "body.contacts",
    },
    "Joint": {
        **dict.fromkeys(("stiffness", "frequency", "hertz"), "joint.spring.hertz"),
        "damping": "joint.spring.damping",
        **dict.fromkeys(("rate", "motor_speed"), "joint.motor.speed"),
        **dict.fromkeys(("max_torque", "max_motor_torque"), "joint.motor.max"),
        **dict.fromkeys(("lower", "min"), "joint.limits[0]"),
        **dict.fromkeys(("upper", "max"), "joint.limits[1]"),
        **dict.fromkeys(("max_force", "break_force"), "joint.breaks[0]"),
        **dict.fromkeys(("collide_bodies", "collide_connected"), "joint.contacts"),
        **dict.fromkeys(("a", "bodyA"), "joint.body_a"),
        **dict.fromkeys(("b", "bodyB"), "joint.body_b"),
        **dict.fromkeys(("at", "anchor"), "joint.anchor_a"),
        "target": "joint.point, of a Target",
        "impulse": "joint.force",
    },
    "World": {
        "fps": "1 / world.dt",
        **dict.fromkeys(("iterations", "velocity_iterations"), "world.substeps"),
        "damping": "world.drag",
        **dict.fromkeys(
            ("space", "add", "create_body", "CreateBody", "CreateStaticBody", "CreateDynamicBody"),
            "world.add_body(*shapes, position=…)",
        ),
        "static_body": 'world.add_body(*shapes, kind="static"); a joint with None holds to the world',
        **dict.fromkeys(("remove", "DestroyBody"), "world.remove_body(body)"),
        **dict.fromkeys(
            ("on_collision", "add_collision_handler", "collisions", "contact_listener", "contactListener"),
            "world.events.begin, after the step",
        ),
        **dict.fromkeys(("hits", "begin", "end"), "world.events.hits, world.events.begin or world.events.end"),
        "constraints": "world.joints",
        **dict.fromkeys(
            ("raycast", "ray", "segment_query", "segment_query_first", "RayCast"), "world.ray_cast(origin, translation)"
        ),
        "point_query": "world.query_point(point)",
        "point_query_nearest": "world.closest(point)",
        **dict.fromkeys(("bb_query", "QueryAABB"), "world.query_aabb(lower, upper)"),
        "shape_query": "world.overlap(shape, pose)",
        **dict.fromkeys(("update", "tick", "Step", "simulate"), "world.step()"),
        "collision_slop": "world.tolerances.slop",
        "debug_draw": "debug.outlines(world), of the module debug",
        "copy": "copy.deepcopy(world), or world.snapshot()",
    },
    "Events": {
        **dict.fromkeys(
            ("collisions", "contacts", "pairs", "collision", "started", "enter", "begins", "on_begin"),
            "events.begin; world.contacts has the contact points of all touching pairs",
        ),
        **dict.fromkeys(("stay", "touching"), "events.persist, or world.touching()"),
        **dict.fromkeys(("exit", "ended", "separate", "ends", "stopped"), "events.end"),
        **dict.fromkeys(("hit", "impacts", "post_solve"), "events.hits"),
        **dict.fromkeys(("sensors", "sensor", "triggers", "overlaps"), "events.sensor_begin and events.sensor_end"),
    },
    "Character": {
        **{name: f"character.position[{k}]" for k, name in enumerate("xy")},
        **dict.fromkeys(
            ("grounded", "on_ground", "on_floor", "is_on_floor", "wall", "riding", "squeezed", "slope"),
            "moved = character.move(dx, dy), and moved.grounded, .wall, .slope, .riding or .squeezed",
        ),
        **dict.fromkeys(
            ("velocity", "move_and_slide", "move_and_collide"), "character.move(dx, dy), in pixels of this step"
        ),
        "world_position": "character.position",
        **{name: f"character.body.{name}" for name in ("user", "bounds", "filter", "shapes", "id", "contacts")},
        "rect": "character.body.bounds, (min_x, min_y, max_x, max_y)",
    },
    "Record": {
        "position": 'row["point_x"], row["point_y"]',
        **{name: f'row["{name}_x"], row["{name}_y"]' for name in ("point", "normal")},
        **dict.fromkeys(("impulse", "total_impulse"), 'row["normal_impulse"]'),
        **dict.fromkeys(("depth", "penetration", "distance"), 'row["separation"], negative where shapes overlap'),
        **dict.fromkeys(("a", "bodyA"), 'world.body(row["body_a"])'),
        **dict.fromkeys(("b", "bodyB"), 'world.body(row["body_b"])'),
        "bodies": 'row["body_a"], row["body_b"]',
        "shapes": 'row["shape_a"], row["shape_b"]',
    },
}


def text_of(value: Any) -> str:
    """Return repr(value) on one line, or "Type(…)" if repr raises an error, as for an int of 5,000 digits."""
    try:
        text = repr(value)
    except Exception:
        return f"{type(value).__name__}(…)"
    return " ".join(text.split()) if "\n" in text else text


def shown(value: Any) -> str:
    """Return a value as text for an error message: at most LONGEST_SHOWN characters, then "…" and the full length."""
    text = text_of(value)
    return text if len(text) <= LONGEST_SHOWN else f"{text[:LONGEST_SHOWN]}… ({len(text)} characters)"


def brief(value: Any) -> str:
    """Return a value as text for the expression in a hint, or "…" if the text is longer than SHORT characters."""
    text = text_of(value)
    return text if len(text) <= SHORT else "…"


def near(word: str, allowed: Iterable[str]) -> str:
    """Return the word in `allowed` that is most similar to `word`, or "" if none is similar enough.

    A word is also similar if it alone begins with `word`. Case, "_", "-" and spaces are ignored.
    """
    plain = {each.lower().replace("_", ""): each for each in allowed}
    word = word.lower().translate(str.maketrans("", "", "_- "))
    found = difflib.get_close_matches(word, plain, 1, NEAR_NAME)
    if not found and len(word) > 2:
        found = [each for each in plain if each.startswith(word)]
    return plain[found[0]] if len(found) == 1 else ""


# Words for shapes that are not names of tiers -> the tier.
SHAPE_WORDS = {"box": "aabb", "boxes": "aabb", "rect": "aabb", "bounds": "aabb", "pixel": "pixels", "sprite": "pixels"}
# Names of classes in other engines -> what to write.
CLASSES = {
    "Space": "World", "b2World": "World", "Scene": "World", "Simulation": "World",
    "Box": "Polygon.box(width, height)", "Rect": "Polygon.box(width, height)",
    "Rectangle": "Polygon.box(width, height)", "Square": "Polygon.box(width, height)",
    "Poly": "Polygon(points)", "Ball": "Circle(radius)", "Line": "Segment(a, b)",
    "Edge": "Segment(a, b)", "EdgeShape": "Segment(a, b)", "Mask": "PixelMask",
    "ShapeFilter": "Filter", "PivotJoint": "Revolute", "HingeJoint": "Revolute",
    "RevoluteJoint": "Revolute", "PinJoint": "Distance", "DistanceJoint": "Distance",
    "SlideJoint": "Distance", "GrooveJoint": "Prismatic", "PrismaticJoint": "Prismatic",
    "WheelJoint": "Wheel", "WeldJoint": "Weld", "GearJoint": "Gear",
    "PulleyJoint": "Pulley", "RatchetJoint": "Ratchet", "MouseJoint": "Target",
    "DampedSpring": "Distance(..., spring=Spring(hertz, damping))",
    "DampedRotarySpring": "Angle(..., spring=Spring(hertz, damping))", "SimpleMotor": "Motor",
    "Vec2d": "Vec2", "Vector2": "Vec2", "b2Vec2": "Vec2", "BB": "Bounds",
    "AABB": "Bounds", "RigidBody": "world.add_body(shape, kind=\"dynamic\")",
    "StaticBody": "world.add_body(shape, kind=\"static\")",
    "KinematicBody": "world.add_body(shape, kind=\"kinematic\")",
}  # fmt: skip


def in_place_of_class(name: str, known: Iterable[str]) -> str:
    """Return the hint for a name that the package does not have; "" if there is no hint. known: its public names."""
    found = CLASSES.get(name, "")
    if found:
        return f": write {found}"
    similar = near(name, known)
    return f": did you mean {similar}?" if similar else ""


def explaining_missing_names(module: str, known: Collection[str]) -> Callable[[str], Never]:
    """Return the `__getattr__` of a module: it raises AttributeError with a hint. known: the module's public names."""

    def missing(name: str) -> Never:
        raise AttributeError(f"module {module!r} has no attribute {name!r}{in_place_of_class(name, known)}")

    return missing


# ---- keywords --------------------------------------------------------------------------------------------------------


def unexpected(name: str, names: Sequence[str], given: Mapping[str, Any]) -> TypeError:
    """Return the TypeError for keyword arguments that a function does not have, with a hint for the first of them.

    name: name of the function, for the message; names: names of its arguments; given: {name: value} of the unexpected
    arguments.
    """
    word, value = min(given.items())
    meant = next((text for argument, text in MEANT.get(word, ()) if argument in names), "")
    similar = near(word, [each for each in names if not each.startswith("*")])
    if similar and (not meant or word.lower() == similar):
        meant = f"{similar}={{}}"
    listed = ", ".join(names)
    hint = f": write {meant.replace('{}', brief(value))}" if meant else f"; its arguments are {listed}"
    called = name if name.endswith(")") else f"{name}()"
    return TypeError(f"{called} got an unexpected keyword argument {word!r} (got {word}={brief(value)}){hint}")


def argument_names(function: Callable[..., Any]) -> tuple[str, ...]:
    """Return the names of a function's arguments, without self, cls and keyword dictionaries (**others).

    The name of an argument for any number of values starts with a star: "*shapes".
    """
    found = [each for each in signature(function).parameters.values() if each.name not in ("self", "cls")]
    stars = {Parameter.VAR_POSITIONAL: "*"}
    return tuple(stars.get(each.kind, "") + each.name for each in found if each.kind != Parameter.VAR_KEYWORD)


EXAMPLES = {  # calls with all needed arguments, for those whose names alone do not say what they are
    "Capsule": "Capsule((x, y), (x, y), radius)",
    "Segment": "Segment((x, y), (x, y))",
    "Polygon": "Polygon([(x, y), (x, y), (x, y)])",
    "Chain": "Chain([(x, y), (x, y)])",
    "PixelMask": "PixelMask.from_surface(surface)",
}


def explained(function: Called) -> Called:
    """Decorate a function, so that an unexpected argument raises a TypeError with a hint.

    A missing argument raises a TypeError with a call that has all of them. Each call of the decorated function takes
    0.2 µs longer.
    """
    names = argument_names(function)
    known, called = frozenset(names), function.__qualname__.removesuffix(".__init__")
    parameters = signature(function).parameters
    most, needed = (
        len(parameters),
        [each for each in names if each in parameters and parameters[each].default is Parameter.empty],
    )

    @wraps(function)
    def checked(*args: Any, **given: Any) -> Any:
        if len(args) > most:
            own = len(args) - (most - len(names))  # without self or cls
            raise TypeError(f"{called}() takes {', '.join(names)} (got {own} arguments: {shown(args[-own:])})")
        if given and not given.keys() <= known:
            raise unexpected(called, names, {each: given[each] for each in given.keys() - known})
        try:
            return function(*args, **given)
        except TypeError:
            missing = [each for each in needed[max(0, len(args) - (most - len(names))) :] if each not in given]
            if not missing:
                raise
        example = EXAMPLES.get(called, f"{called}({', '.join(needed)})")
        raise TypeError(f"{called}() needs {', '.join(needed)} (got no {', no '.join(missing)}): write {example}")

    return checked  # pyright: ignore[reportReturnType]


def explained_class(made: Made) -> Made:
    """Decorate a class: replace its `__init__` by explained(__init__), and return the class."""
    made.__init__ = explained(made.__init__)
    return made


def without_others(function: Called) -> Called:
    """Hide the last argument of a function, `**others: Never`, from help() and signature(). Return the function.

    The function itself must raise the error that `unexpected` returns for these keyword arguments. Calls are not
    slower, unlike with `explained`.
    """
    whole = signature(function)
    kept = [each for each in whole.parameters.values() if each.kind != Parameter.VAR_KEYWORD]
    function.__signature__ = whole.replace(parameters=kept)  # pyright: ignore[reportFunctionMemberAccess]
    return function


# ---- values ----------------------------------------------------------------------------------------------------------


def is_a(value: Any, package: str, *names: str) -> bool:
    """Return whether the class of a value, or one of its base classes, is a class of `package` with one of `names`.

    The package is not imported.
    """
    return any(each.__name__ in names and each.__module__.split(".")[0] == package for each in type(value).__mro__)


def is_own(value: Any, *names: str) -> bool:
    """Return whether a value is an instance of a class with one of `names` that is defined in the package physics."""
    package = __name__.rpartition(".")[0]
    return any(each.__name__ in names and each.__module__.startswith(package) for each in type(value).__mro__)


def is_class(value: Any, name: str) -> bool:
    """Return whether a value is itself a class with this name. A caller may have passed it instead of an instance."""
    return isinstance(value, type) and value.__name__ == name


def is_number(value: Any) -> bool:
    """Return whether a value is a real number and not a bool."""
    return isinstance(value, numbers.Real) and not isinstance(value, bool)


def is_bits(value: Any) -> bool:
    """Return whether a value is a whole number from 0 to 2**32 - 1, which represents a set of 32 bits."""
    return is_number(value) and isinstance(value, numbers.Integral) and 0 <= int(value) <= 0xFFFFFFFF


def is_pair(value: Any) -> bool:
    """Return whether a value is a tuple or list of two numbers."""
    return isinstance(value, (tuple, list)) and len(value) == 2 and all(map(is_number, value))


def in_place_of_surface(value: Any) -> str:
    """Return the hint for a wrong value that was passed instead of a pygame Surface or Mask; "" if there is no hint."""
    if is_a(value, "pygame", "Surface", "Mask", "Sprite"):
        return in_place_of_shape(value)
    return f": write pygame.image.load({brief(value)})" if isinstance(value, str) else ""


def in_place_of_solid(value: Any) -> str:
    """Return the hint for a wrong value that was passed instead of a bool array of pixels or tiles; "" for no hint."""
    if is_a(value, "pygame", "Rect", "FRect"):
        value = tuple(value.size)
    if is_pair(value):
        return f": write np.ones({brief((value[1], value[0]))}, bool) for a full rectangle of this size"
    if isinstance(value, str) and "\n" not in value:
        return f": write PixelMask.from_surface(pygame.image.load({brief(value)}))"
    rows = [*value] if isinstance(value, (list, tuple)) else []
    if rows and isinstance(rows[0], (str, list, tuple)) and rows[0] and isinstance(rows[0][0], str):
        return ': write [[each == "#" for each in row] for row in rows]'
    return ""


def in_place_of_shape(value: Any, many: bool = False) -> str:
    """Return the hint for a wrong value that was passed instead of a shape; "" if there is no hint.

    many: whether the called function takes several shapes.
    """
    if is_a(value, "pygame", "Surface"):
        return ": write PixelMask.from_surface(surface)"
    if is_a(value, "pygame", "Mask"):
        return ": write PixelMask.from_mask(mask)"
    if is_a(value, "pygame", "Rect", "FRect"):
        return f": write Polygon.box({value.width}, {value.height}), placed at {tuple(value.center)}"
    if is_a(value, "pygame", "Sprite"):
        return ": write PixelMask.from_surface(sprite.image)"
    if is_own(value, "Body"):
        return ": write *body.shapes for the shapes of a body"
    if is_own(value, "Material", "Filter"):
        name = type(value).__name__
        return f": write {name.lower()}={name}(…) after the shapes"
    if isinstance(value, type) and value.__module__.startswith(__name__.rpartition(".")[0]):
        return f": write {value.__name__}(…), a shape of this class"
    if isinstance(value, str):
        return (
            f": write kind={value!r}" if value in KIND_WORDS else ": write PixelMask.from_surface(pygame.image.load(…))"
        )
    if is_number(value):
        return f": write Circle({brief(value)})"
    return _in_place_of_shape(value, many)


def _in_place_of_shape(value, many):
    if isinstance(value, np.ndarray):
        if value.ndim == 2 and value.dtype == np.bool_:
            return ": write PixelMask.from_array(solid), or TileGrid(solid, tile_size)"
        return ": write Polygon(points)" if value.ndim == 2 and value.shape[1] == 2 else ""
    if not isinstance(value, (tuple, list)) or not value:
        return ""
    if all(is_own(each, "Shape") for each in value):
        return ": write the shapes one by one, or *shapes" if many else ": write one shape"
    if is_pair(value):
        box = f", Polygon.box{brief(tuple(value))} for a size" if min(value) > 0 else ""
        return f": write position={brief(tuple(value))} for a place{box}"
    if all(is_pair(each) or is_a(each, "pygame", "Vector2") for each in value):
        return ": write Segment(a, b)" if len(value) == 2 else ": write Polygon(points)"
    return ""


def in_place_of_vector(name: str, value: Any) -> str:
    """Return the hint for a wrong value of the argument `name`, which must be a pair; "" if there is no hint."""
    if is_a(value, "pygame", "Rect", "FRect"):
        return ": write rect.center or rect.topleft"
    if is_own(value, "Body", "Character"):
        return ": write body.position"
    if isinstance(value, complex) and not is_number(value):
        return ": write (z.real, z.imag)"
    if not is_number(value):
        return ""
    if name == "gravity":
        return f": write (0, {brief(abs(value))}), in px/s², y points down"
    return ": write (x, y)"


def in_place_of_points(name: str, value: Any, count: int | None = None, of: str = "") -> str:
    """Return the hint for a wrong value of the argument `name`, an array of points or numbers; "" if there is no hint.

    count: the required number of points or numbers, None: any number; of: name of the shape or function that takes the
    points, "" for a query.
    """
    if isinstance(value, (set, frozenset)):
        return ": write a list, because a set has no order"
    if isinstance(value, Iterator):
        return f": write [*{name}], a list"
    if name == "points":
        return _in_place_of_corners(value, of)
    times = f" * {count}" if count is not None and count > 1 else ""
    if is_pair(value) and name.startswith(("positions", "velocities", "origins", "translations")):
        return f": write [{brief(tuple(value))}]{times}"
    return f": write [{brief(value)}]{times}" if is_number(value) and name == "angles" else ""


def _in_place_of_corners(value, of):
    """Return the hint for a wrong value of the argument `points`, "" for no hint. of: see in_place_of_points."""
    if is_own(value, "Shape"):
        return ": write shape.points" if hasattr(value, "points") else ""
    if of and is_a(value, "pygame", "Rect", "FRect"):
        if of == "Polygon":
            return f": write Polygon.box({value.width}, {value.height}, center={tuple(value.center)})"
        loop = ", loop=True" if of == "Chain" else ""
        return f": write {of}([rect.topleft, rect.topright, rect.bottomright, rect.bottomleft]{loop})"
    if of and is_a(value, "pygame", "Surface", "Mask"):
        return ": write PixelMask.from_surface(surface), or PixelMask.from_mask(mask)"
    if is_pair(value):
        size = f", Polygon.box{brief(tuple(value))} for a size" if of == "Polygon" else ""
        return f": write [{brief(tuple(value))}] for one point{size}"
    if is_number(value):
        corners = f"{of}([(x, y), (x, y), …])" if of else "[(x, y)]"
        return f": write {'Polygon.box(width, height)' if of == 'Polygon' else corners}"
    return ""


def in_place_of_number(name: str, value: Any) -> str:
    """Return the hint for a wrong value of the argument `name`, which must be a number; "" if there is no hint."""
    if name == "radius" and is_pair(value):
        return ": write the radius first, Circle(radius, center)"
    if name == "radius" and is_a(value, "pygame", "Rect", "FRect"):
        return f": write Polygon.box({value.width}, {value.height}), or Circle(rect.width / 2)"
    if name == "gravity_scale" and is_pair(value):
        return f": write World(gravity={brief(value)})"
    if name in ("width", "height") and (is_pair(value) or is_a(value, "pygame", "Rect", "FRect")):
        return ": write Polygon.box(width, height), two numbers"
    return ""


def in_place_of_limits(value: Any) -> str:
    """Return the hint for a wrong value of a joint's limits, which must be (low, high); "" if there is no hint."""
    return f": write (None, {brief(value)})" if is_number(value) else ""


def in_place_of_material(value: Any) -> str:
    """Return the hint for a wrong value that was passed instead of a Material."""
    if is_number(value) and value >= 0:
        return f": write Material(friction={brief(value)})"
    if isinstance(value, dict) and value and value.keys() <= set(MATERIALS):
        return f": write Material({', '.join(f'{name}={brief(each)}' for name, each in value.items())})"
    if is_own(value, "Filter"):
        return ": write filter=Filter(…)"
    if is_class(value, "Material"):
        return ": write Material()"
    return ": write Material(friction=…, restitution=…, density=…)"


def in_place_of_filter(value: Any) -> str:
    """Return the hint for a wrong value that was passed instead of a Filter."""
    if is_bits(value):
        return f": write Filter(membership={brief(value)})"
    if is_pair(value) and all(map(is_bits, value)):
        return f": write Filter(membership={brief(value[0])}, mask={brief(value[1])})"
    if is_own(value, "Material"):
        return ": write material=Material(…)"
    if is_class(value, "Filter"):
        return ": write Filter()"
    return ": write Filter(membership=…, mask=…), or Filter.ALL"


MOST_NAMES = 20  # names that a hint repeats


def in_place_of_effects(value: Any, effects: Collection[str], needs: Mapping[str, Iterable[str]]) -> str:
    """Return the hint for a wrong value that was passed instead of an Effects.

    effects: names of all effects; needs: {effect: the effects that it needs}.
    """
    if is_class(value, "Effects"):
        return ": write Effects()"
    if callable(value) and getattr(value, "__name__", "") in ("detection", "rigid_bodies"):
        return f": write Effects.{value.__name__}()"
    given = (value,) if isinstance(value, str) else value
    names = [*given] if isinstance(given, (dict, list, tuple, set, frozenset)) else []
    if 0 < len(names) <= MOST_NAMES and all(isinstance(each, str) and each in effects for each in names):
        named = {each for each in names if not isinstance(value, dict) or value[each]}
        named |= {other for each in named for other in needs.get(each, ())}
        on = [each for each in effects if each in named]
        return f": write Effects({', '.join(f'{each}=True' for each in on)})"
    return ": write Effects.rigid_bodies(), or Effects(gravity=True, …)"


def assigned_to(thing: Any) -> dict[str, str]:
    """Return the entry of ASSIGNED for the class of an object or a base class: {attribute: expression}, {} if none."""
    return next((ASSIGNED[each.__name__] for each in type(thing).__mro__ if each.__name__ in ASSIGNED), {})


def in_place_of_attribute(thing: Any, name: str, value: Any) -> str:
    """Return the hint for an attribute that cannot be set; "" if there is no hint.

    thing: the object; name: the attribute; value: the value that was to be set.
    """
    expression = assigned_to(thing).get(name)
    return f": write {expression.replace('{}', brief(value))}" if expression else ""


def unchangeable(expression: str, reason: str = "") -> Callable[[Made], Made]:
    """Return a class decorator that makes setting and deleting of any attribute raise FrozenInstanceError.

    expression: the code that the message suggests instead, unless ASSIGNED has an expression for the attribute; {name},
    {value} and {kind} are replaced by those of the assignment and the name of the class. reason: added to the message.
    """

    def refuse(thing: Any, name: str, value: Any = None) -> None:
        kind = type(thing).__name__
        hint = in_place_of_attribute(thing, name, value)
        hint = hint or f": write {expression.format(name=name, value=brief(value), kind=kind)}"
        raise FrozenInstanceError(f"{kind} cannot be changed{reason}{hint}")

    def decorate(made: Made) -> Made:
        type.__setattr__(made, "__setattr__", refuse)
        type.__setattr__(made, "__delattr__", refuse)
        return made

    return decorate


class ForeignName:
    """A class attribute for a name of another engine. Reading it raises AttributeError with the expression to write.

    It is no data descriptor, so that subclasses and instances can have an attribute of this name.
    """

    __slots__ = ("message",)

    def __init__(self, message: str) -> None:
        self.message = message

    def __get__(self, thing: Any, kind: Any = None) -> Never:
        raise AttributeError(self.message)


def _without_foreign_names(kind: type, names: Iterable[str]) -> list[str]:
    """Return the names of attributes of a class, or of its instance, that are not ForeignNames of the class."""
    return [each for each in names if not isinstance(getattr_static(kind, each, None), ForeignName)]


class WithForeignNames(ABCMeta):
    """Metaclass that adds a ForeignName for each entry of READ to the class of this name; dir() and help() omit them.

    A `__getattr__` in these classes would make all reading slower, by 30 % for body.position: CPython specializes the
    bytecode LOAD_ATTR only for classes without it. The base is ABCMeta, so that a subclass of World can also have ABC
    as a base.
    """

    def __init__(cls, name: str, bases: tuple[type, ...], namespace: dict[str, Any]) -> None:
        super().__init__(name, bases, namespace)
        if name in READ:
            type.__setattr__(cls, "__dir__", visible_names)
        for word, expression in READ.get(name, {}).items():
            if not hasattr(cls, word):
                setattr(cls, word, ForeignName(f"{name} has no attribute {word}: write {expression}"))

    def __dir__(cls) -> list[str]:
        return _without_foreign_names(cls, super().__dir__())


def visible_names(thing: Any) -> list[str]:
    """Return the names of the attributes of an object for dir(), without ForeignNames of its class."""
    own = getattr(thing, "__dict__", {})
    return [*own, *_without_foreign_names(type(thing), {*object.__dir__(thing)} - {*own})]


def in_place_of_column(row: Any, name: str) -> str:
    """Return the hint for reading an attribute `name` of a row of a structured array; "" if there is no hint."""
    expression = f'row["{name}"]' if name in (row.dtype.names or ()) else READ["Record"].get(name, "")
    return f": write {expression}" if expression else ""


def in_place_of_word(name: str, value: Any, allowed: Sequence[str]) -> str:
    """Return the hint for a wrong value of the argument `name`, which must be one of the strings `allowed`.

    The result is "" if there is no hint.
    """
    if isinstance(value, str):
        found = SHAPE_WORDS.get(value.lower(), "") if name == "tier" else ""
        found = found if found in allowed else near(value, allowed)
        return f': did you mean "{found}"?' if found else ""
    if name == "kind" and is_number(value) and value in (0, 1, 2):
        word = KIND_WORDS[int(value)]
        return f': write kind="{word}"; {word.upper()} is its number in world.bodies["kind"]'
    if name == "continuous" and isinstance(value, bool):
        return f': write continuous="{"toi" if value else "off"}"'
    return ""
