"""The scatter plot of lab/pyramid: its errors are those that the lab judges by, and tried settings are kept."""

from itertools import combinations

import pygame
import pytest

from game.drawing.canvas import Canvas
from game.drawing.colors import PAPER
from game.drawing.presenter import Frame, Presenter
from game.input.inputs import InputFrame, InputState
from game.measure.measured_runs import RunFigures
from game.measure.moment import Moment
from game.measure.timing import RUNS, Cost
from scenes.lab.pyramid import JUDGED_AT, SIZE, SUBSTEPS, Pyramid
from scenes.lab.scatter import Dot, draw_scatter


def stepped(scene, steps=1, changes=()):
    inputs = InputState()
    for number in range(steps):
        inputs.set(InputFrame(frozenset(), changes=changes if number == 0 else ()))
        scene.step(inputs)
    return scene


def known(name, cost=2e-4, overlap=0.08):
    return {name: RunFigures(Cost.of([cost] * RUNS, 60), overlap)}


@pytest.mark.parametrize("solver, substeps", [("soft_step", 2), ("sequential_impulse", 1), ("projection", 4)])
def test_a_dot_has_the_error_that_the_lab_judges(solver, substeps):
    scene = Pyramid(1, solver=solver)
    scene.change("slider:rows", 5)
    scene.change("slider:substeps", substeps)
    measured_run = scene.measured().make(scene.run_name)
    moment, (first, last) = Moment(measured_run.snapshots[0], measured_run.broadphase), measured_run.judged
    overlap = moment.way(moment.here, last).overlap[first - 1 :].max()
    stepped(scene, JUDGED_AT)
    assert overlap == scene.deepest > 0.0


def test_every_solver_and_number_is_asked_for_once():
    names = stepped(Pyramid(1)).measured().names
    assert len(names) == len(set(names)) == 2 * len(SUBSTEPS) + 1, "substeps mean nothing to projection"


def test_what_was_tried_stays():
    scene = stepped(Pyramid(1, solver="soft_step"))
    first = scene.run_name
    stepped(scene, changes=(("substeps", 16),))
    odd = scene.run_name
    assert odd == (12, "soft_step", 16, "hash") and odd in scene.measured().names
    stepped(scene, changes=(("slider:solver", 0),))
    other = scene._run_name("soft_step", 8)
    scene.figures = known(first) | known(odd, overlap=0.0) | known(scene.run_name, 1e-4) | known(other)
    dots = scene.dots()
    assert scene.run_name == (12, "projection", None, "hash") and odd in scene.measured().names
    assert [dots[name].tried for name in (first, odd, scene.run_name, other)] == [True, True, True, False]
    assert dots[first].cost == pytest.approx(200.0) and dots[first].error == pytest.approx(1000 * 0.08 / SIZE)
    scene.change("slider:rows", 6)
    assert scene.dots() == {} and scene.finding().startswith("not yet"), "another pyramid"
    scene.change("slider:rows", 12)
    stepped(scene)
    assert set(scene.dots()) == set(dots), "and back"


def test_the_finding_names_what_is_as_good_for_less():
    scene = stepped(Pyramid(1, solver="soft_step"))
    for name in scene.measured().names:
        scene.figures |= known(name, 3e-4, 0.2)
    scene.figures |= known(scene.run_name, 2e-4, 0.1)
    assert scene.finding() == "a step takes 200 us and crates overlap by 3.1 thousandths"
    scene.figures |= known(scene._run_name("sequential_impulse", 2), 1e-4, 0.1)
    assert scene.finding().endswith("; sequential impulse, 2 substeps: no more for 100 us")


def test_dots_stand_by_their_logarithms_and_the_present_one_is_ringed():
    surface = pygame.Surface((960, 540))
    frame = Frame(surface)
    frame.scale, frame.area = 2, surface.get_rect()
    red, green = (255, 0, 0), (0, 255, 0)
    dots = {"a": Dot(10.0, 1.0, red, "", True), "b": Dot(1000.0, 0.0, green, "", True)}
    draw_scatter(frame, (0, 0, 200, 100), "", dots, "b")
    pixels = pygame.surfarray.array3d(surface)

    def middle(color):
        return tuple(float(each.mean()) for each in (pixels == color).all(axis=2).nonzero())

    (ax, ay), (bx, by) = middle(red), middle(green)
    assert ax < bx and ay <= by
    ring = middle(PAPER)
    assert ring == pytest.approx((bx, by), abs=1.5)


@pytest.mark.parametrize("dots", [{}, {"a": Dot(5.0, 0.0, (255, 0, 0), "1", False)}])
def test_nothing_and_a_single_dot_without_error_can_be_drawn(dots):
    surface = pygame.Surface((960, 540))
    frame = Frame(surface)
    frame.scale, frame.area = 2, surface.get_rect()
    draw_scatter(frame, (0, 0, 200, 100), "plot", dots, "a")
    assert ("measuring" in [text for _, text in frame.boxes]) == (not dots)


@pytest.mark.parametrize("size", [(640, 360), (960, 540), (1440, 810)])
def test_the_names_of_two_dots_do_not_read_as_one(size):
    dots = {number: Dot(100.0 * (1.0 + 0.02 * number), 0.01, PAPER, str(number), True) for number in range(1, 9)}
    frame = Presenter(pygame.Surface(size)).present(Canvas())
    before = len(frame.boxes)
    draw_scatter(frame, (4, 80, 130, 66), "overlap", dots, 1)
    names = [rect for rect, text in frame.boxes[before:] if text in map(str, dots)]
    assert 1 < len(names) < len(dots), "those without room are left out"
    for a, b in combinations(names, 2):
        assert not a.inflate(4 * frame.plot_scale, 0).colliderect(b)
