"""Every row of the study is within its limit for all seeds, with substeps that follow the load."""

from functools import partial

import pytest

from tests.stability.piles import needs_speed
from tests.stability.study.engines import Hitbox
from tests.stability.study.rows import table
from tests.stability.study.verdict import Played, judge

# Listed, and held against the table below: to make the table takes a second, which every collection would.
FAMILIES = (
    *("aligned", "arch", "bounce", "card", "crooked", "dropped", "free", "harmonic", "heavy", "leaning", "oblique"),
    *("offset", "plate", "pyramid", "ratio", "seams", "sliding", "slope", "tumbler"),
)


def test_every_family_of_rows_is_tested():
    assert sorted(FAMILIES) == sorted({name.split("_")[0] for name, row in table().items() if row.unit != "ms"})


@needs_speed
@pytest.mark.parametrize("family", FAMILIES)
def test_rows_are_within_their_limits(family):
    played = Played(partial(Hitbox, substeps="auto"))
    for name, row in table().items():
        if name.split("_")[0] != family or row.unit == "ms":
            continue
        found = judge(row, played)
        told = f"{name}: {found.figure:.4g} {row.unit}, limit {row.limit}, {found.stood} of {found.seeds} stand"
        assert found.met, told
