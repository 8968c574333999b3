"""Drawing: text is measured, labels avoid each other, and the presenter maps positions in both directions."""

import pygame
import pytest

from game.drawing.camera import Camera
from game.drawing.canvas import SMALL, TEXT, Canvas, shorten, whole, wrap
from game.drawing.font import load_font
from game.drawing.presenter import Presenter


@pytest.mark.parametrize("font", [TEXT, SMALL])
@pytest.mark.parametrize("scale", [1, 2, 3])
def test_measured_size_is_what_is_drawn(font, scale):
    surface = pygame.Surface((400, 60), pygame.SRCALPHA)
    width, height = load_font(font).measure("Hitbox |59%|", scale)
    load_font(font).draw(surface, "Hitbox |59%|", 0, 0, (255, 255, 255), scale)
    box = surface.get_bounding_rect()
    assert box.width == width and box.bottom <= height


@pytest.mark.parametrize("font", [TEXT, SMALL])
def test_every_printable_letter_is_there(font):
    have = load_font(font).places
    assert not [chr(c) for c in range(32, 127) if chr(c) not in have]
    assert all(arrow in have for arrow in "\u2190\u2192\u2191\u2193")


def test_text_if_free_never_overlaps_or_leaves():
    canvas = Canvas(pygame.Surface((100, 60)))
    assert canvas.text_if_free("score", 10, 10)
    assert not canvas.text_if_free("score", 12, 12)
    assert not canvas.text_if_free("score", 90, 30)
    canvas.reserve((0, 40, 100, 20))
    assert not canvas.text_if_free("score", 10, 45)
    assert len(canvas.boxes) == 1


def test_wrap_and_shorten_fit():
    text = "Drag and turn two planes: circle, box, turned box and pixels give their verdicts"
    assert all(load_font(TEXT).measure(line)[0] <= 90 for line in wrap(text, 90))
    assert " ".join(wrap(text, 90)) == text
    assert load_font(TEXT).measure(shorten(text, 90))[0] <= 90


def test_rounding_is_half_up_on_both_sides_of_zero():
    assert [whole(v) for v in (-1.5, -0.5, -0.4, 0.5, 1.5)] == [-1, 0, 0, 1, 2]


@pytest.mark.parametrize(
    "size", [(480, 270), (960, 540), (1440, 810), (1000, 700), (300, 200), (1920, 1080), (2560, 600)]
)
@pytest.mark.parametrize("docked", [False, True])
def test_presenter_scales_and_maps_back(size, docked):
    """The presenter scales the canvas by an integer, or beside a panel to the space that is left.

    Positions in the window are mapped back to the canvas.
    """
    presenter = Presenter(pygame.Surface(size))
    presenter.docked = docked
    canvas = Canvas()
    canvas.begin((10, 20, 30))
    frame = presenter.present(canvas)
    beside = docked and not presenter.crowded
    assert frame.scale == int(frame.zoom) and (beside or frame.zoom == frame.scale)
    assert frame.area.size == (round(480 * frame.zoom), round(270 * frame.zoom))
    assert frame.from_canvas((0, 0, 480, 270)) == frame.area
    for x, y in ((0, 0), (240, 135), (479, 269)):
        place = (frame.area.x + (x + 0.5) * frame.zoom, frame.area.y + (y + 0.5) * frame.zoom)
        assert presenter.to_canvas(place) == (x, y)
    if beside:
        free = size[0] - presenter.panel_width
        assert not frame.area.colliderect(presenter.panel_rect)
        assert frame.area.width > free - 1 or frame.area.height > size[1] - 1, "the picture takes all the room"
    shown = frame.area.clip(frame.surface.get_rect())
    assert tuple(frame.surface.get_at(shown.center))[:3] == pytest.approx((10, 20, 30), abs=4)


@pytest.mark.parametrize("size", [(960, 540), (1440, 810), (1100, 600)])
def test_the_camera_and_the_lens_meet_on_the_frame_beside_a_panel(size):
    presenter = Presenter(pygame.Surface(size))
    presenter.docked = True
    camera = Camera((100, 50, 200, 100), 0.5, 40.0, 60.0)
    frame = presenter.present(Canvas())
    x, y = camera.to_canvas(123.0, 77.0)
    assert frame.lens(camera).points(123.0, 77.0) == pytest.approx((x * frame.zoom, y * frame.zoom))
    assert frame.lens(camera).clip == frame.from_canvas((100, 50, 200, 100))


def test_lens_and_camera_agree():
    presenter = Presenter(pygame.Surface((1440, 810)))
    camera = Camera((100, 50, 200, 100), 0.5, 40.0, 60.0)
    frame = presenter.present(Canvas())
    x, y = camera.to_canvas(123.0, 77.0)
    assert frame.lens(camera).points(123.0, 77.0) == pytest.approx((x * 3, y * 3))
    assert camera.to_world(x, y) == pytest.approx((123.0, 77.0))


def test_camera_stays_in_the_level_and_forgets_shakes():
    camera = Camera()
    camera.keep_within(0, 0, 1000, 270)
    camera.center_on(5000.0, 100.0)
    assert camera.view() == (520, 0)
    camera.shake(1.0)
    for _ in range(120):
        camera.begin_step(1 / 60)
    assert camera.trauma == 0.0 and camera.view() == (520, 0)
