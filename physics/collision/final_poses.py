"""What a step ends with in a world that stacks: boxes, pixels and contacts where the bodies are now.

Solvers, sweeps and characters move bodies one after the other. What is told, sensed and put to sleep is what there is
after all of them; contacts are carried there by their anchors, nothing is detected twice.
"""

from physics.collision.areas import count_areas
from physics.collision.persist import follow_bodies
from physics.dynamics.integrate import place_shapes
from physics.tables.step_state import StepState, stage


def recount(state: StepState) -> None:
    """The areas of contacts at the final poses."""
    if state.library.masks:
        count_areas(state.library.tables, state.bodies, state.shapes, state.workspace.narrow.workspace, state.manifolds)


@stage(
    "final_poses",
    reads=("awake", "bodies", "shapes", "library", "manifolds", "anchors", "workspace"),
    writes=(
        "manifolds",
        "library",
        "workspace",
        *(f"shapes.{name}" for name in ("min_x", "min_y", "max_x", "max_y", "raster", "left", "top")),
    ),
)
def settle_contacts(state: StepState) -> None:
    """Boxes, pixels, and the points, normals, separations and areas of contacts, at the final poses."""
    place_shapes(state)
    follow_bodies(state.bodies, state.anchors, state.manifolds)
    recount(state)
