"""Every test runs without a display and without sound; several workers find their kernels compiled."""

import importlib.util
import os
import sys
from pathlib import Path

import pytest

# Its figures are oracles: without it what needs them is not collected.
NEEDS_SHAPELY = ("import shapely", "from shapely", "from tests.fitting")
if importlib.util.find_spec("shapely") is None:
    collect_ignore = [
        str(path)
        for path in Path(__file__).parent.rglob("test_*.py")
        if any(line.startswith(NEEDS_SHAPELY) for line in path.read_text(encoding="utf-8").splitlines())
    ]

# `pytest -m quick`: the promises of the sources, the units of each folder, one scene through lockstep; a minute.
QUICK = {
    "tests": ("test_architecture", "test_docs", "test_kernel_dialect", "test_lockstep"),
    "tests/mutants": ("test_operators",),
    "tests/physics": (
        "test_bad_input",
        "test_bad_shapes",
        "test_broadphase_incremental",
        "test_character",
        "test_character_belts",
        "test_character_bodies",
        "test_character_carry",
        "test_churn",
        "test_collide_values",
        "test_debug_and_fit",
        "test_distance",
        "test_events",
        "test_hull_manifolds",
        "test_mask_surface",
        "test_masks_turned",
        "test_mass_properties",
        "test_new_shapes",
        "test_quarantine",
        "test_rays",
        "test_response",
        "test_snapshot",
        "test_surfaces",
        "test_tree_rebuild",
    ),
    "tests/game": (
        "test_draw",
        "test_inputs",
        "test_loop",
        "test_overlay_layers",
        "test_records",
        "test_replay",
        "test_screens",
        "test_settings",
        "test_sound",
        "test_histogram",
        "test_startup",
        "test_tilemap",
    ),
    "tests/scenes": ("test_platformer_maps", "test_platformer_things", "test_registry", "test_shooter_stage_files"),
    "tests/regress": ("test_physics_found", "test_rigid_bodies_found", "test_turned_parts"),
    "tests/assets": ("test_art_images", "test_art_levels", "test_music_notation"),
}
LONGEST = ("test_scenes.py", "test_flashes.py", "test_ten_minutes.py")  # a minute and more for each game
ROOT = Path(__file__).resolve().parent.parent
os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
os.environ.setdefault("SDL_AUDIODRIVER", "dummy")
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
sys.path.insert(0, str(ROOT))


def pytest_sessionstart(session):
    """Before workers start, compile what they would otherwise each compile."""
    workers = session.config.getoption("numprocesses", None)
    if workers and "NUMBA_DISABLE_JIT" not in os.environ and not hasattr(session.config, "workerinput"):
        from tests.warm_kernels import warm_up

        warm_up(workers)


@pytest.hookimpl(tryfirst=True)  # before -m chooses
def pytest_collection_modifyitems(items):
    """Mark the quick tests; what is long in their files stays out. The longest come first: no worker ends with one."""
    quick = {ROOT / folder / f"{name}.py" for folder, names in QUICK.items() for name in names}
    for item in items:
        if item.path in quick and not any(item.iter_markers("deep")) and not any(item.iter_markers("nightly")):
            item.add_marker("quick")
    items.sort(key=lambda item: item.path.name not in LONGEST)
