"""List of the defects that the stability suite found, each with a regression test in tests/regress.

`section()` is the part "What the suite found" of docs/stability.md. It quotes the first sentence of each test file's
docstring.
"""

import ast
from pathlib import Path

REGRESS = Path(__file__).resolve().parents[1] / "regress"
FOUND = (
    "blows_on_piles",
    "boxes_ask_as_shapes_do",
    "candidates_of_carved_masks",
    "characters_put_into_solids",
    "characters_stay_kinematic",
    "contacts_of_bodies_in_trees",
    "contacts_of_masks_tell_all",
    "corners_where_three_parts_meet",
    "deep_parts_are_told_once",
    "devices_that_go_away",
    "discs_that_roll_round_a_corner",
    "heavy_loads_taken_away",
    "heavy_loads_under_sequential_impulses",
    "islands_ease_together",
    "large_masks_that_turn",
    "masks_without_a_pixel",
    "numbers_that_spread",
    "pushes_wake_what_is_near",
    "rasters_for_questions",
    "rows_asked_for_after_removals",
    "shape_ids_that_run_out",
    "snapshots_on_a_full_disk",
    "solvers_switched_after_removals",
    "steps_shorter_than_any",
    "steps_that_change_a_lot",
)


def first_sentence(path: Path) -> str:
    """Return the first sentence of the module docstring of a test file, on one line."""
    told = " ".join((ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or "").split())
    return told.split(". ")[0].rstrip(".") + "."


def section() -> str:
    """Return the list of defects as Markdown, each with a link to its test, relative to docs/."""
    lines = []
    for name in FOUND:
        path = REGRESS / f"test_{name}.py"
        lines.append(f"- {first_sentence(path)} [{name.replace('_', ' ')}](../tests/regress/{path.name})")
    return "\n".join(lines)
