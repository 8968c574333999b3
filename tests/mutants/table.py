"""Fifty-four single-operator errors in the kernels, and the tests that detect each.

The seed of a mutant is 1. If the change that seed 1 picks is equivalent to the original (EQUIVALENT), the mutant has
another seed.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Mutant:
    """One changed operator of a kernel: see operators.change. tests: names of the tests that must fail."""

    kernel: str
    kind: str
    tests: tuple
    seed: int = 1

    @property
    def key(self):
        """Return the arguments (kernel, kind, seed) of operators.change."""
        return self.kernel, self.kind, self.seed

    def __str__(self):
        return "-".join(map(str, self.key))


MUTANTS = (
    # finding pairs
    Mutant("overlaps", "edge", ("test_awkward_boxes_pair_as_the_double_loop_says",)),
    Mutant("may_meet", "both", ("test_box_on_a_slope_slides_at_g_sin_less_mu_cos",)),
    Mutant("sweep_intervals", "turn", ("test_random_boxes_pair_as_the_double_loop_says",)),
    Mutant("dynamic_tree.rotate", "turn", ("test_tree_stays_low_through_sorted_insertions_and_removals",)),
    Mutant("level_of", "turn", ("test_giant_ground_under_small_boxes_pairs_with_each",)),
    # testing pairs
    Mutant("collide_circles", "sign", ("test_circles_in_closed_form",)),
    Mutant("collide_polygon_circle", "sign", ("test_circle_and_polygon_hit_with_the_exact_depth",)),
    Mutant("edge_normal", "minus", ("test_polygons_hit_with_the_least_push_as_depth",)),
    Mutant("find_max_separation", "turn", ("test_polygons_hit_with_the_least_push_as_depth",)),
    Mutant("clip_edges", "edge", ("test_boxes_face_to_face_have_two_points",)),
    Mutant("support", "turn", ("test_disc_and_box_in_closed_form",)),
    Mutant("reduce_simplex", "turn", ("test_boxes_that_share_an_edge",), seed=3),
    Mutant("measure_edge", "sign", ("test_unit_box_in_a_big_one_leaves_by_the_least_translation",)),
    Mutant("least_separation", "turn", ("test_depth_and_gap_are_exact_and_the_points_lie_between_the_surfaces",)),
    Mutant("owns_start", "turn", ("test_a_convex_corner_is_met_between_the_two_normals_and_once",)),
    # pixels
    Mutant("columns_up_to", "sign", ("test_every_offset_across_a_word_border",)),
    Mutant("shared_rectangle", "side", ("test_random_masks_hit_as_the_double_loop_says",)),
    Mutant(
        "separation_along", "sign", ("test_symmetric_full_overlap_has_a_unit_normal_and_a_depth_that_parts",), seed=2
    ),
    # sweeps, rays
    Mutant("cast_on_polygon", "turn", ("test_ray_against_a_box",)),
    Mutant("sweep_circles", "minus", ("test_two_discs_in_closed_form",)),
    # motion, solvers
    Mutant("integrate_velocities", "sign", ("test_free_fall_without_stacking_is_its_own_recurrence",), seed=4),
    Mutant("integrate_velocities", "factor", ("test_drag_and_wind_follow_the_implicit_recurrence",), seed=2),
    Mutant("write_masses", "sign", ("test_oblique_equal_discs_leave_at_right_angles",), seed=31),
    Mutant("warm_lanes", "sign", ("test_f9_pyramid_that_starts_a_quarter_inside_itself",), seed=2),
    Mutant("gather_motions", "factor", ("test_sliding_disc_rolls_after_two_thirds",)),
    Mutant("mixed", "factor", ("test_stopping_distance",)),
    Mutant("solve_soft", "sign", ("test_a_slope_is_level_ground_under_a_gravity_that_leans",), seed=5),
    Mutant("push_pair", "sign", ("test_cradle_hands_on_the_velocity",), seed=2),
    Mutant("push_pair", "sign", ("test_oblique_equal_discs_leave_at_right_angles",), seed=3),
    Mutant(
        "push_pair",
        "sign",
        ("test_ball_that_hits_a_free_box_off_its_middle_turns_it_as_the_impact_formula_says",),
        seed=9,
    ),
    Mutant("bounce_once", "side", ("test_bounces_rise_by_the_square_of_restitution",)),
    # joints
    Mutant("report_joints", "turn", ("test_a_joint_breaks_at_its_force_and_is_told_once",), seed=19),
    Mutant("report_joints", "turn", ("test_a_torque_breaks_a_weld",), seed=20),
    Mutant("joint_rows.push", "minus", ("test_welded_bodies_move_as_one",)),
    Mutant("place_joint", "sign", ("test_welded_bodies_move_as_one",), seed=2),
    Mutant("warm_joints", "sign", ("test_the_reported_force_holds_the_weight_in_every_direction",)),
    Mutant("point_inverse_mass", "sign", ("test_the_reported_force_holds_the_weight_in_every_direction",), seed=5),
    Mutant("limit_change", "sign", ("test_a_slider_is_free_up_to_its_limit",), seed=2),
    Mutant("limit_change", "minus", ("test_a_slider_is_free_up_to_its_limit",)),
    Mutant("impulse_of", "sign", ("test_an_angle_stays_within_its_limits",)),
    Mutant("solve_motor", "sign", ("test_the_motor_of_a_wheel_turns_both_bodies",), seed=2),
    # joints solved directly
    Mutant("take_joints", "turn", ("test_joints_that_close_a_loop_are_not_taken",)),
    Mutant("order_bodies", "turn", ("test_random_forests_are_solved_as_by_numpy",), seed=5),
    Mutant("independent", "sign", ("test_random_forests_are_solved_as_by_numpy",), seed=2),
    Mutant("apply_row", "sign", ("test_random_forests_are_solved_as_by_numpy",)),
    Mutant("gather_violations", "sign", ("test_random_forests_are_solved_as_by_numpy",), seed=2),
    Mutant("spread_impulses", "sign", ("test_random_forests_are_solved_as_by_numpy",)),
    Mutant("write_line", "sign", ("test_welded_bodies_move_as_one",)),
    Mutant("next_state", "turn", ("test_a_chain_with_limits_stops_at_them",)),
    # what is told, characters
    Mutant("compare_pairs", "turn", ("test_every_begin_has_exactly_one_end",)),
    Mutant("in_tiles", "edge", ("test_one_way_opens_from_below_and_drops_on_demand",)),
    Mutant("whole_pixels", "sign", ("test_remainder_is_carried_exactly",)),
    Mutant(
        "slope_under_box",
        "sign",
        ("test_slope_of_tiles_is_told_by_the_middle_of_the_feet_and_by_a_foot_at_their_ends",),
        seed=7,
    ),
    Mutant("cast_on_tiles", "sign", ("test_rays_on_tiles_are_rays_on_the_boxes_of_the_tiles",), seed=5),
)

# (kernel, kind, seed) of changes that come to the same, and why.
EQUIVALENT = {
    ("warm_lanes", "sign", 1): "uncompiled there is one lane, the first: lane is 0",
    ("solve_soft", "sign", 1): "as before",
    (
        "reduce_simplex",
        "turn",
        1,
    ): "the walk goes on from the other corner of an edge, and ends at the same, rounds later",
}
