"""Structure of docs/reference.md: its sections, their introductions, and the names in each section."""

from typing import NamedTuple

# Ten conventions. Figures in braces are filled in from the code.
CONVENTIONS = """\
- Lengths are pixels, times seconds, angles radians; x points right, y down. A positive angle turns clockwise on the
  screen.
- A point or vector is any pair `(x, y)`; results are `Vec2`. A pose is `(x, y)` or `(x, y, angle)`. World point =
  position + rotated local point.
- `body.position` is the body's origin, `body.center` its centre of mass; `body.velocity` is that of the centre of
  mass.
- Mass is density times px²; a force is mass px/s², an impulse mass px/s. `pixels_per_meter` ({ppm:g}) scales
  tolerances and the default gravity only.
- AABBs and shapes are closed: touching is overlap, separation 0, a contact. Masks are open: they hit when they share
  area.
- A is the shape with the smaller id; normals are unit vectors from A to B; a separation below 0 is an overlap.
- Ids are whole numbers, given once and never used again in a world. Row numbers of the arrays are not ids.
- An effect that is not declared does nothing; what needs it raises ValueError and names it.
- A wrong argument raises TypeError (wrong kind) or ValueError (wrong value) that names argument, value and what is
  allowed; the world is then unchanged. Changing a world during its step raises RuntimeError.
- Arrays are NumPy structured arrays that the last step left; read them after `world.step()`, before the next. Units
  are in brackets.
"""

CONSTANTS = {
    "BROADPHASES": "the strategies by name, see [Broad phases](#section:Broad phases)",
    "SOLVERS": "the names of the solvers, see [Solvers](#section:Solvers)",
    "TIERS": "the names of the tiers, from coarse to exact, see [Tiers](#section:Tiers)",
    "STATIC": "value of the column `kind` of a static body",
    "KINEMATIC": "value of the column `kind` of a kinematic body",
    "DYNAMIC": "value of the column `kind` of a dynamic body",
    "JIT": "whether kernels are compiled; False without numba, or with `NUMBA_DISABLE_JIT=1`",
    "PHYSICS_VERSION": "changes with the results of the physics; snapshots of another version are refused",
}


class Section(NamedTuple):
    """A section of the page."""

    title: str
    text: str  # its introduction
    names: tuple[str, ...]  # names in order; a class brings its members that no other section lists
    tables: tuple[str, ...] = ()  # generated tables before the names, see TABLES in page.py


SECTIONS = (
    Section(
        "Effects",
        "What a world can do is declared once; a step runs only the stages that its effects need.",
        ("Effects",),
        ("effects",),
    ),
    Section("World", "", ("World", "World.step", "World.set_effects", "World.set_narrowphase")),
    Section(
        "Bodies",
        "A body is named by its `Body` or by its id, everywhere.",
        (
            "World.add_body", "World.add_bodies", "World.body", "World.rows", "World.move", "World.touch",
            "World.remove_body", "World.remove_bodies", "World.clear", "Body",
        ),
        ("kinds", "continuous"),
    ),
    Section(
        "Shapes",
        "Shapes are immutable values in body space. A body may have several.",
        (
            "Circle", "Capsule", "Polygon", "Segment", "Chain", "TileGrid", "PixelMask", "Turned", "Bounds", "Shape",
            "Material", "Filter", "mass_of", "Mass",
        ),
    ),
    Section(
        "Joints",
        "A joint is a value, such as `Revolute(a, b, at)`, that `world.add_joint` adds. A world with joints needs the "
        "effect `joints`. Every kind has its bodies, its anchors, and the arguments of `Kind`.",
        (
            "World.add_joint", "World.add_joints", "World.joint", "World.remove_joints", "Kind", "Drive", "Spring",
            "Revolute", "Prismatic", "Wheel", "Distance", "Weld", "Angle", "Motor", "Target", "NoContact", "Gear",
            "Pulley", "Ratchet", "Joint",
        ),
        ("joint_solvers",),
    ),
    Section("Characters", "", ("Character", "Moved")),
    Section(
        "What a step leaves behind",
        "Columns of the arrays, with type and unit. Columns of `world.bodies` and settings in `world.joints` can be "
        "written between steps; call `world.touch` for bodies that sleep.",
        ("World.touching", "Events"),
        ("arrays",),
    ),
    Section(
        "Queries",
        "Questions to a world between steps.",
        (
            "World.ray_cast", "World.ray_cast_all", "World.ray_casts", "World.shape_cast", "RayHit", "World.overlap",
            "World.closest", "World.query_point", "World.query_points", "World.query_aabb", "World.query_rect",
        ),
        ("hits",),
    ),
    Section(
        "Functions without a world",
        "",
        ("collide", "Manifold", "distance", "distance.Distance", "time_of_impact", "TimeOfImpact", "Vec2"),
    ),
    Section(
        "Tiers",
        "Simpler shapes in place of a sprite's pixels, and how wrong they are.",
        ("fit", "measure", "Fit", "hull", "decompose"),
        ("tiers",),
    ),
    Section("Carving", "", ("Body.carve", "Carved")),
    Section(
        "Broad phases",
        "All strategies find the same pairs. `World(broadphase=…)` takes a name or an instance.",
        ("BruteForce", "SweepAndPrune", "SpatialHashGrid", "DynamicTree", "Strategy"),
        ("strategies",),
    ),
    Section("Solvers", "", (), ("solvers",)),
    Section(
        "Stages, counters, tolerances",
        "`world.stages` lists the stages of a step in order, `world.profile` their times and the work done.",
        ("Profile", "Tolerances"),
        ("stages", "counters", "tolerances"),
    ),
    Section(
        "Snapshots and digests",
        "",
        ("World.snapshot", "World.restore", "World.digest", "Snapshot"),
    ),
    Section(
        "Compilation",
        "Kernels are compiled at their first call, and stored in `~/.cache/hitbox/compiled` or `HITBOX_CACHE_DIR`. "
        "Without numba everything runs as plain Python.",
        ("warmup", "compile_in_background", "Background"),
    ),
    Section(
        "Debug drawing",
        "`from hitbox.physics import debug`: the inner state of a world as arrays in world pixels. "
        "Nothing is changed, and arguments are not checked.",
        (
            "debug.bounds", "debug.motion", "debug.pairs", "debug.outlines", "debug.shape_rows",
            "debug.contact_points", "debug.islands", "debug.joints", "debug.masks", "debug.drawn_masks", "debug.Drawn",
            "debug.mask_hits", "debug.part_edges", "debug.impact_ghosts", "debug.structure", "debug.Structure",
            "debug.visited", "debug.Visited",
        ),
        ("drawing",),
    ),
    Section("Constants", "", (), ("constants",)),
    Section("Types of arguments", "As they stand in the tables of arguments.", (), ("types",)),
)  # fmt: skip
