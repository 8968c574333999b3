"""A rope, an example of a new joint: the parts of a joint that it uses, and a line in KINDS of
physics/joints/kinds.py.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from physics import checks
from physics.annotations import Pair
from physics.joints.kinds import Kind
from physics.tables.joint import LENGTH


@dataclass(frozen=True)
class Rope(Kind):
    """Joint that limits the distance of two anchors [px] to `slack` times their distance when it is created."""

    PARTS = {"coordinate": LENGTH}
    POINTS = ("at_a", "at_b")
    COORDINATE = ()

    a: Any
    b: Any
    at_a: Pair
    at_b: Pair
    slack: float = 1.0

    def columns(self) -> dict[str, Any]:
        """Return the columns of JOINT that follow from the settings. Raises TypeError, ValueError."""
        checks.number("slack", self.slack, low=1.0)
        return super().columns()

    def with_lengths(self, rows: np.ndarray, lengths: np.ndarray) -> None:
        """Write the greatest distance to JOINT rows. lengths: present distances (n,) [px]."""
        rows["upper"] = self.slack * lengths
