"""Table of all injected faults, with the result and the test of each. `section()` is the part "Faults" of
docs/stability.md.
"""

from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[3]
HERE = "tests/stability/faults"
INTRODUCTION = """\
Each fault is deliberate. *Disabled*: the body is taken out of the simulation at its last pose in range, at rest, and
reported by id and reason in `world.events.quarantined`, until `body.restore()`; its neighbours continue to the bit as
if it had been removed. *Refused*: ValueError or TypeError with the argument, its value and what is allowed; nothing has
changed.
"""


class Fault(NamedTuple):
    """An injected fault: the fault itself, its expected result, and its test as `file::function`."""

    fault: str
    gets: str
    test: str


FAULTS: dict[str, tuple[Fault, ...]] = {
    "Numbers": (
        Fault("NaN, infinity or a wrong kind for any argument", "refused", "tests/physics/test_bad_input.py"),
        Fault(
            "NaN, ±inf, 1e308 into any column of `world.bodies` or `world.shapes` that a step reads",
            "that body alone is disabled, in the same step",
            f"{HERE}/test_poison.py::test_the_poisoned_body_alone_is_put_aside",
        ),
        Fault(
            "into a column that is reported or recomputed: previous, settled and still poses, boxes, timers",
            "overwritten",
            f"{HERE}/test_poison.py::test_the_poisoned_body_alone_is_put_aside",
        ),
        Fault(
            "into a character's row",
            "the character stays where it is, `move` gives (0, 0), and the next step disables it",
            f"{HERE}/test_poison.py::test_the_poisoned_body_alone_is_put_aside",
        ),
        Fault(
            "into the contact cache (manifolds, anchors) or the broad phase (swept AABBs)",
            "recomputed; forces that are not finite, or beyond 1e100, are dropped",
            f"{HERE}/test_poison.py::test_the_poisoned_body_alone_is_put_aside",
        ),
        Fault(
            "into the arrays that stages share",
            "written before they are read",
            f"{HERE}/test_poison.py::test_what_stages_share_is_written_before_it_is_read",
        ),
        Fault(
            "a query (ray, overlap, closest, `move`) between that and the next step",
            "skips bodies without a pose",
            f"{HERE}/test_poison.py::test_questions_before_the_next_step_pass_over_it",
        ),
        Fault(
            "a mass of 1e308 or 1e-308, friction, restitution or rolling of 1e308, given to a constructor",
            "accepted, and disabled in the first step: products of two would overflow",
            f"{HERE}/test_poison.py::test_numbers_that_are_finite_and_of_no_use_reach_nobody",
        ),
        Fault(
            "faster than 1e9 m/s, also by its spin, or beyond 2^52 px",
            "disabled; such a position as an argument is refused",
            f"{HERE}/test_full_tables.py::test_positions_and_speeds_that_a_double_does_not_resolve",
        ),
        Fault(
            "a TileGrid that is rotated by its column", "disabled, upright", "tests/regress/test_grids_do_not_turn.py"
        ),
    ),
    "Teleports": (
        Fault(
            "into a box, disc, mask, wall, chain, the ground, a pile or the edge of tiles",
            "out again within 10 s, no faster than 6 m/s besides its fall; overlap at most two slops",
            f"{HERE}/test_teleports.py::test_it_comes_out_gently",
        ),
        Fault(
            "into the middle of solid tiles",
            "stays inside or leaves; slow, finite",
            f"{HERE}/test_teleports.py::test_in_the_middle_of_solid_tiles_it_stays_or_leaves_and_is_finite",
        ),
        Fault(
            "without stacking",
            "projection: out within two seconds; blocking: it stays where it was put",
            f"{HERE}/test_teleports.py::test_without_stacking_it_is_out_or_stuck_at_once",
        ),
        Fault(
            "a hundred boxes at one point",
            "apart within 10 s, the same every time",
            "tests/stability/test_f_overlap.py::test_f10_a_hundred_boxes_at_one_point",
        ),
        Fault(
            "a crusher into a character",
            "`squeezed` in every move while it is in it",
            "tests/regress/test_squeezed_while_crushed.py::test_it_is_told_without_a_gap",
        ),
    ),
    "Time": (
        Fault(
            "dt 0, or shorter than 1e-30 s",
            "nothing moves; forces and targets wait for the next step",
            "tests/regress/test_steps_shorter_than_any.py::test_nothing_moves_and_forces_wait",
        ),
        Fault(
            "dt negative, NaN, infinite or not a number",
            "refused",
            f"{HERE}/test_time_steps.py::test_what_is_no_length_is_refused_and_changes_nothing",
        ),
        Fault(
            "dt that changes: by 1 %, by half, at random from 1/240 to 1/20 s, a stall of 1 s, 1e-9 s throughout",
            "five boxes stand, overlap at most two slops",
            f"{HERE}/test_time_steps.py::test_a_pile_stands_however_the_steps_change",
        ),
        Fault(
            "dt of 1/30 and 1/240 in turn; of 1/60 and 1e-5 or 1e-9 s in turn",
            "five boxes stand, and none gets faster than 5 px/s",
            f"{HERE}/test_time_steps.py::test_a_pile_stands_where_long_and_short_steps_alternate",
        ),
        Fault(
            "dt 1 s",
            "finite and above the floor; piles sink into themselves, which soft_step counts in `cap_hits`",
            f"{HERE}/test_time_steps.py::test_steps_of_a_second_are_finite_and_stay_above_the_floor",
        ),
        Fault(
            "dt 1 s, and then 1/60",
            "apart within 15 s",
            f"{HERE}/test_time_steps.py::test_after_steps_of_a_second_ordinary_ones_bring_it_apart",
        ),
    ),
    "Full": (
        Fault(
            "bodies, shapes, pairs, contacts, events: 0, 1, and across 16, 32, 64 and 128 rows",
            "grown; no row lost, the same digest one by one, all at once and under every broad phase",
            f"{HERE}/test_full_tables.py::test_no_row_is_lost_where_a_table_grows",
        ),
        Fault(
            "more contacts of one body than the 62 colours",
            "solved first, in order: it rests as on fewer",
            f"{HERE}/test_full_tables.py::test_a_plank_on_more_boxes_than_there_are_colors_lies",
        ),
        Fault(
            "a polygon of more than 16 corners",
            "refused; `hull` keeps the 16 that count",
            f"{HERE}/test_full_tables.py::test_polygons_have_as_many_corners_as_their_row",
        ),
        Fault(
            "shape ids after 2^31",
            "refused: make a new World",
            "tests/regress/test_shape_ids_that_run_out.py::test_the_last_id_is_given_and_no_further_one",
        ),
        Fault(
            "impacts that stop one another for more than 64 iterations",
            "counted in `cap_hits`; none gets through",
            f"{HERE}/test_full_tables.py::test_impacts_that_go_on_and_on_are_counted",
        ),
        Fault(
            "loads that need more than 32 substeps",
            "counted in `cap_hits`",
            f"{HERE}/test_full_tables.py::test_loads_that_need_more_substeps_than_there_are_are_counted",
        ),
        Fault(
            "a grid of 300 cells, a chain of 300 links, a mask of 1,200 px",
            "the last row collides like the first",
            f"{HERE}/test_full_tables.py::test_the_last_row_of_a_large_shape_is_met",
        ),
    ),
    "Devices": (
        Fault(
            "no sound device",
            "silence, with its reason in the settings",
            "tests/game/test_sound.py::test_no_device_is_silence_with_a_reason",
        ),
        Fault(
            "the sound device is removed while it plays",
            'one line, "the sound device is gone (…); the game goes on in silence"',
            f"{HERE}/test_devices.py::test_a_sound_device_that_goes_away_is_silence_and_one_line",
        ),
        Fault(
            "a window of 1 x 1 px",
            "drawn; at its old size the picture is complete again",
            f"{HERE}/test_devices.py::test_a_window_of_a_few_pixels_is_drawn_into",
        ),
        Fault(
            "a window mode that the system refuses",
            '"the window stays as it is: …"',
            f"{HERE}/test_devices.py::test_a_window_that_cannot_be_changed_stays_as_it_is",
        ),
        Fault(
            "the display is removed",
            '"the display is gone (…); what was played and chosen is kept", exit 2',
            f"{HERE}/test_devices.py::test_a_display_that_goes_away_ends_with_one_line_and_keeps_the_run",
        ),
        Fault("the controller is removed", "the game pauses", "tests/game/test_app.py::test_focus_and_pad_lost_pause"),
    ),
    "Files": (
        Fault(
            "a full disk while settings, records, a ghost or a level are saved",
            "OSError; the old file is whole, no partial file is left",
            f"{HERE}/test_full_disk.py::test_what_was_kept_before_stays_whole",
        ),
        Fault(
            "a full disk in mid-game",
            "one line each, with file and reason, for settings, screenshot and replay; the game goes on",
            f"{HERE}/test_full_disk.py::test_a_game_goes_on_and_says_what_could_not_be_kept",
        ),
        Fault(
            "a full disk under `--record` or `--screenshot`",
            "one line, exit 2; the old file is whole",
            f"{HERE}/test_full_disk.py::test_an_output_that_does_not_fit_is_one_line_and_exit_2",
        ),
        Fault(
            "a full disk under `Snapshot.save`",
            "OSError; the old snapshot is whole",
            f"{HERE}/test_full_disk.py::test_a_snapshot_that_does_not_fit_leaves_the_old_one",
        ),
        Fault(
            "a full disk under the kernel cache",
            "one warning; compiled, used, and compiled again at the next start",
            f"{HERE}/test_full_disk.py::test_kernels_that_cannot_be_kept_run_all_the_same",
        ),
        Fault(
            "a kernel cache with wrong bytes",
            "one warning; compiled again",
            "tests/regress/test_kernel_caches_with_wrong_bytes.py::test_wrong_bytes_are_compiled_anew",
        ),
        Fault(
            "a data folder out of reach",
            "one line; defaults",
            "tests/regress/test_data_folders_out_of_reach.py::test_everything_starts_empty",
        ),
        Fault(
            "two windows of the game",
            "both keep their high scores",
            "tests/regress/test_two_windows.py::test_both_windows_keep_their_places",
        ),
        Fault(
            "a replay cut off at any length",
            "FileError with file, line and reason",
            f"{HERE}/test_spoilt_replays.py::test_every_length_is_refused_but_the_whole",
        ),
        Fault(
            "a replay with a flipped bit",
            "refused, or diverges at a named frame, or the bit has no effect on the run",
            f"{HERE}/test_spoilt_replays.py::test_a_turned_bit_is_refused_diverges_or_says_nothing_of_the_run",
        ),
        Fault(
            "a snapshot cut off or with a flipped bit",
            "refused or whole",
            "tests/physics/test_snapshot.py::test_cut_and_flipped_files_are_refused_or_whole",
        ),
        Fault(
            "a level whose packed layer holds more than its map",
            "unpacked up to the map's bytes; FileError with layer and bytes",
            "tests/regress/test_packed_layers_without_end.py::test_it_takes_no_more_memory_than_the_map",
        ),
        Fault(
            "a PNG larger than allowed, or another kind of file under its name",
            "FileError with its size and what is allowed, before a pixel is decoded",
            "tests/regress/test_pictures_larger_than_memory.py"
            "::test_a_huge_picture_is_refused_with_its_size_and_what_is_allowed",
        ),
        Fault(
            "a level that names a picture outside its folder",
            "FileError, also through a link; only the game's own pictures are found by their names",
            "tests/regress/test_pictures_outside_the_level.py::test_a_path_out_of_the_folder_is_refused",
        ),
        Fault(
            "a byte order mark before any JSON file",
            "ignored",
            "tests/regress/test_byte_order_marks.py::test_a_file_with_a_mark_says_the_same",
        ),
        Fault(
            "a file name that the system does not allow, or thousands of letters in a file",
            "one line of at most 300 letters",
            "tests/regress/test_names_that_are_too_long.py::test_a_file_to_read",
        ),
        Fault(
            "a program killed while it saves",
            "the old file is whole; the partial file is removed by a start an hour later",
            "tests/regress/test_leftovers.py::test_an_old_one_of_ours_is_removed",
        ),
    ),
}


def section() -> str:
    """Return the section as Markdown: a table for each kind of fault, with a link to each test relative to docs/."""
    lines = ["## Faults", "", INTRODUCTION]
    for kind, faults in FAULTS.items():
        lines += [f"### {kind}", "", "| fault | result | test |", "|---|---|---|"]
        for each in faults:
            path, _, function = each.test.partition("::")
            name = function or Path(path).stem
            lines.append(f"| {each.fault} | {each.gets} | [{name}](../{path}) |")
        lines.append("")
    return "\n".join(lines)
