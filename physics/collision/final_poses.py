"""What a step ends with in a world that stacks: boxes, pixels and contacts where the bodies are now.

Solvers, sweeps and characters move bodies one after the other. What is told, sensed and put to sleep is what there is
after all of them; contacts are carried there by their anchors, nothing is detected twice.
"""

from physics.collision.follow import follow_all
from physics.jit import kernel
from physics.shapes.placement import refresh_boxes
from physics.shapes.rasters import add_missing_rasters
from physics.tables.step_state import StepState, stage


@kernel
def settle(
    # read
    shape_rows,
    geometry,
    bodies,
    anchors,
    # write
    shapes_inout,
    manifolds_inout,
):
    """Write the boxes of these shapes, and carry all manifolds to where their bodies are. O(rows + manifolds)."""
    refresh_boxes(shape_rows, geometry, bodies, shapes_inout)
    follow_all(bodies, anchors, manifolds_inout)


@stage(
    "final_poses",
    reads=("awake", "bodies", "shapes", "library", "manifolds", "anchors"),
    writes=(
        "manifolds",
        "library",
        *(f"shapes.{name}" for name in ("min_x", "min_y", "max_x", "max_y", "raster", "left", "top")),
    ),
)
def settle_contacts(state: StepState) -> None:
    """Boxes, and the points, normals and separations of contacts, at the final poses."""
    rows, bodies, shapes = state.awake.shapes, state.bodies, state.shapes
    # What was pushed round may stand at an angle that was not foreseen.
    add_missing_rasters(state.library, rows, bodies, shapes, 0.0)
    settle(rows, state.library.tables, bodies, state.anchors, shapes, state.manifolds)
