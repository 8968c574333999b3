"""The rows of the study with the substeps that follow from the loads: each within its limit, all seeds."""

from functools import partial

import pytest

from tests.stability.piles import needs_speed
from tests.stability.study.engines import Hitbox
from tests.stability.study.rows import table
from tests.stability.study.verdict import Played, judge

# Forty boxes 5 % inside the analytic limit give way, with the most substeps that there are, by more than these 5 %:
# what leans is balanced from box to box, pass by pass, and does not find its balance before it has leant too far. With
# 128 it does, and so do thirty boxes and harmonic towers of 24 and 32, which fall with 32.
OUT_OF_REACH = ("offset_40_in",)
FAMILIES = sorted({name.split("_")[0] for name, row in table().items() if row.unit != "ms"})


@needs_speed
@pytest.mark.parametrize("family", FAMILIES)
def test_rows_are_within_their_limits(family):
    played = Played(partial(Hitbox, substeps="auto"))
    for name, row in table().items():
        if name.split("_")[0] != family or row.unit == "ms":
            continue
        found = judge(row, played)
        told = f"{name}: {found.figure:.4g} {row.unit}, limit {row.limit}, {found.stood} of {found.seeds} stand"
        assert found.met is (name not in OUT_OF_REACH), told
