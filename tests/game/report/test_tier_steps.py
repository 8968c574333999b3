"""Chart 1, whole steps: every tier steps the same moving sprites, and errors are those of the boxes alone."""

import pytest

from game.report.charts import tier_steps, tiers
from game.report.claim import HOLDS, TIE
from physics import TIERS

FEW = {"in the cache": (60, 30.0), "out of the cache": (80, 20.0)}


@pytest.fixture(scope="module", params=list(FEW))
def rows(request):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tier_steps, "SIZES", FEW)
        patch.setattr(tier_steps, "FRAMES", dict.fromkeys(FEW, 1))
        return request.param, {row["series"]: row for row in tier_steps.measure(request.param)}


def test_every_tier_is_stepped_and_pixels_are_exact(rows):
    name, found = rows
    assert set(found) == set(TIERS) - (set(tier_steps.SLOW) if name == "out of the cache" else set())
    assert found["pixels"]["wrong"][0] == 0 == found["mask"]["wrong"][0] and found["pixels"]["wrong"][1] > 20
    assert found["aabb"]["wrong"][0] > 5 and all(row["missed"][0] == 0 for row in found.values())
    assert all(
        row["boxes"] == found["aabb"]["boxes"] > 0 and min(row["step_cost"]["seconds"]) > 0.0 for row in found.values()
    )


def test_sprites_that_have_no_pair_are_not_measured(monkeypatch):
    monkeypatch.setattr(tier_steps, "SIZES", {"in the cache": (2, 2000.0)})
    with pytest.raises(RuntimeError, match="the sprites have no pair of boxes"):
        tier_steps.measure("in the cache")


@pytest.mark.parametrize("panel", tier_steps.PANELS.values())
@pytest.mark.parametrize("boxes, verdict", [(2.0, HOLDS), (1.05, TIE)])
def test_the_cheapest_tier_of_a_whole_step_is_claimed(panel, boxes, verdict):
    costs = {"pixels": 1.0, "aabb": boxes}
    made = [{"panel": panel, "series": name, "step_cost": {"seconds": [1e-7 * ns] * 3}} for name, ns in costs.items()]
    (claim,) = tiers.CHART.claims(made)
    assert claim.verdict == verdict and panel in claim.text
