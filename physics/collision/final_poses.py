"""What a step ends with in a world that stacks: boxes, pixels and contacts where the bodies are now.

Solvers, sweeps and characters move bodies one after the other. What is told, sensed and put to sleep is what there is
after all of them; contacts are carried there by their anchors, nothing is detected twice.
"""

from physics.collision.follow import follow_bodies
from physics.dynamics.integrate import place_shapes
from physics.tables.step_state import StepState, stage


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
    place_shapes(state)
    follow_bodies(state.bodies, state.anchors, state.manifolds)
