"""Outlines stored with the art equal newly fitted ones, and are used only for the masks that they belong to."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from game.places import OUTLINES
from physics.outline import kept, mask_parts, tiled
from physics.outline.kept import Parts

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def alone(monkeypatch):
    """Empty the cache of stored outlines, and return its module. Only the entries of the test are then in it."""
    monkeypatch.setattr(kept, "_kept", {})
    monkeypatch.setattr(kept, "_files", [])
    monkeypatch.setattr(kept, "recorded", {})
    return kept


def rasters():
    """Yield random rasters of several densities and sizes, and simple ones."""
    rng = np.random.default_rng(5)
    for size in (1, 3, 8, 17):
        for density in (0.2, 0.5, 0.9):
            yield rng.random((size, size + 2)) < density
    yield np.ones((5, 9), bool)
    yield np.zeros((4, 4), bool)
    disc = np.hypot(*np.indices((15, 15)) - 7) <= 6.5
    yield disc


def same(one, other):
    return len(one) == len(other) and all(
        np.array_equal(a.corners, b.corners) and np.array_equal(a.inner, b.inner) and a.radius == b.radius
        for a, b in zip(one, other, strict=True)
    )


@pytest.mark.parametrize("smooth", [0.0, 0.5, 2.0])
def test_what_is_kept_is_what_is_fitted(alone, tmp_path, smooth):
    solids = list(rasters())
    fresh = [mask_parts.mask_parts(each, smooth) for each in solids]
    kept.write(tmp_path / "outlines.npz", kept.recorded)
    kept.recorded = None
    kept.use(tmp_path / "outlines.npz")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mask_parts, "_fit", lambda *given: pytest.fail("it was kept"))
        again = [mask_parts.mask_parts(each, smooth) for each in solids]
    assert all(map(same, again, fresh))


def test_tiles_are_kept_wherever_they_lie(alone, tmp_path):
    rng = np.random.default_rng(8)
    size = 64 + 2 * tiled.HALO
    window = np.zeros((size, size), bool)
    window[40:, :] = True
    window[30:40, 20:60] = rng.random((10, 40)) < 0.5
    fresh = tiled.tile_parts(window, 0.5)
    kept.write(tmp_path / "outlines.npz", kept.recorded)
    kept.recorded = None
    kept.use(tmp_path / "outlines.npz")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tiled, "_fit", lambda *given: pytest.fail("it was kept"))
        for at in ((0, 0), (64, 128)):
            again = tiled.tile_parts(window, 0.5, at)
            assert np.array_equal(again.corners, fresh.corners + at) and np.array_equal(again.inner, fresh.inner)
            assert again.counts.tolist() == fresh.counts.tolist()


@pytest.mark.parametrize("change", ["pixel", "smooth", "code", "method", "size"])
def test_another_key_is_not_found(alone, monkeypatch, change):
    solid = np.ones((6, 8), bool)
    marked = Parts(np.zeros((4, 2)), np.zeros(4, bool), np.array([4]), np.zeros(1))
    name, smooth = "mask_parts", 0.5
    kept._kept[kept._key(name, solid, smooth)] = marked
    if change == "pixel":
        solid = solid.copy()
        solid[2, 3] = False
    elif change == "size":
        solid = np.ones((8, 6), bool)
    elif change == "smooth":
        smooth = 0.25
    elif change == "method":
        name = "tile_parts"
    else:
        monkeypatch.setattr(kept, "code_stamp", lambda: b"another")
    anew = marked._replace(radii=np.ones(1))
    assert kept.fitted(name, solid, smooth, lambda: anew) is anew


def damaged(path):
    """Yield the contents of a file of outlines that is damaged in different ways."""
    content = path.read_bytes()
    yield b""
    yield content[: len(content) // 2]
    yield content[:40] + bytes(200) + content[240:]
    yield b"PK\x03\x04 no archive"


@pytest.mark.parametrize("way", range(4))
def test_a_damaged_file_holds_nothing(alone, tmp_path, way):
    solid = np.ones((6, 8), bool)
    fresh = mask_parts.mask_parts(solid)
    path = tmp_path / "outlines.npz"
    kept.write(path, kept.recorded)
    path.write_bytes(list(damaged(path))[way])
    kept.recorded = None
    kept.use(path)
    assert same(mask_parts.mask_parts(solid), fresh) and not kept._kept
    kept.use(tmp_path / "missing.npz")
    assert same(mask_parts.mask_parts(solid), fresh)


def test_a_file_whose_numbers_do_not_agree_holds_nothing(alone, tmp_path):
    mask_parts.mask_parts(np.ones((6, 8), bool))
    path = tmp_path / "outlines.npz"
    kept.write(path, kept.recorded)
    with np.load(path) as file:
        held = dict(file)
    for name in ("counts", "parts", "corners"):
        np.savez(path, **{**held, name: held[name][:-1]})
        assert kept._read(path) == {}


def test_the_shipped_file_is_of_this_code_and_not_empty():
    """The shipped file of outlines was made with the present code and is not empty.

    Otherwise every start without compiled kernels would fit all outlines again: run python -m scenes.outlines.
    """
    found = kept._read(OUTLINES)
    solid = np.zeros((1, 1), bool)
    assert len(found) > 100 and kept._key("mask_parts", solid, 0.5) not in found


def test_the_shipped_outlines_are_found(alone, monkeypatch):
    """The shipped outlines cover the masks at the start of the scenes, so nothing is fitted again."""
    code = (
        "from game.run.headless import start_dummy_display; start_dummy_display()\n"
        "from game.registry import Registry\nfrom scenes import SCENES\n"
        "from physics.outline import mask_parts\nfrom physics.outline import tiled as tile_parts\n"
        "def fail(*given):\n    raise AssertionError('fitted anew: run python -m scenes.outlines')\n"
        "mask_parts._fit = tile_parts._fit = fail\n"
        "for name in ('shooter', 'platformer', 'lander', 'lab/mask_stack'):\n"
        "    Registry(SCENES).scene_class(name)(0)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.nightly
def test_the_shipped_outlines_are_those_that_are_fitted_anew():
    done = subprocess.run(
        [sys.executable, "-m", "scenes.outlines", "--check"], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout
