"""Labs of sprites that are pushed, carved and swept: tools, drawing, figures and walls that their bots do not test."""

from math import hypot

import numpy as np
import pygame
import pytest

import physics
from game.drawing.canvas import Canvas
from game.drawing.sprites import load_atlas, load_backdrop
from game.input.inputs import InputFrame
from game.run.session import Session
from game.run.sources import IdleSource, ScriptSource
from physics import PixelMask, measure
from scenes.lab.carving import MASKS, TOP, Carving
from scenes.lab.costs import UNKNOWN
from scenes.lab.mask_stack import CHOICES, EVERY, FALLEN, WARM, WAYS, MaskStack, shapes_of
from scenes.lab.mask_sweep import MaskSweep, placed
from scenes.lab.prints import EDGE, cut_out
from scenes.lab.thin_walls import HALF, RADIUS, SHAPES, is_beyond, wall_of
from scenes.lab.tools import TOOLS, Tool

compiled = pytest.mark.skipif(not physics.JIT, reason="takes long without compiled kernels")


def play(scene, frames):
    session = Session(scene, ScriptSource(list(frames)))
    for _ in range(len(frames)):
        session.step()
    return scene


def idle(scene, steps):
    session = Session(scene, IdleSource())
    for _ in range(steps):
        session.step()
    return session


def words(scene):
    canvas = Canvas()
    canvas.begin((0, 0, 0))
    scene.draw(canvas, 1.0)
    return [text for _, text in canvas.boxes]


def press(place):
    return [InputFrame(pointer=place), InputFrame(pointer=place, pointer_down=True), InputFrame(pointer=place)]


# --- carving ---------------------------------------------------------------------------------------------------------


def ground_of(scene):
    return scene.world.body(scene.ground).shapes[0].solid


def test_a_blast_takes_the_pixels_whose_centres_it_covers():
    scene = Carving(seed=1)
    before = ground_of(scene).copy()
    place = (20, 240)
    play(scene, press(place))
    y, x = np.argwhere(before).T
    inside = np.hypot(x + 0.5 - place[0], y + 0.5 + TOP - place[1]) <= scene.tool.radius
    assert scene.removed == int(inside.sum()) > 300 and scene.crumbs == 0
    assert (before & ~ground_of(scene)).sum() == scene.removed
    assert scene.whole == scene.left + scene.removed and scene.unequal == 0
    assert 1 <= scene.anew < len(scene._tiles()), "only the tiles about it"


def test_a_blast_in_the_sky_takes_nothing_and_a_press_is_one_blast():
    scene = Carving(seed=1)
    play(scene, press((300, 50)))
    assert scene.removed == scene.carves == 0
    play(scene, [*press((20, 240))[:2], *[InputFrame(pointer=(60, 240), pointer_down=True)] * 5])
    assert scene.carves == 1


def test_digging_takes_all_that_the_pointer_passed_over():
    scene = Carving(seed=1)
    scene.change("slider:tool", TOOLS.index("dig"))
    scene.change("slider:radius", 5)
    before = ground_of(scene).copy()
    play(scene, [InputFrame(pointer=(40, 250), pointer_down=True), InputFrame(pointer=(140, 250), pointer_down=True)])
    row = 250 - TOP
    assert before[row, 36:144].all() and not ground_of(scene)[row, 36:144].any()
    assert ground_of(scene)[row, :34].all()


def test_a_sprite_and_a_box_are_stamped_in_their_shape():
    for name, corner in (("box", True), ("sprite", False)):
        scene = Carving(seed=1)
        scene.change("slider:tool", TOOLS.index(name))
        scene.change("slider:radius", 12)
        before = ground_of(scene).copy()
        play(scene, press((40, 245)))
        gone = before & ~ground_of(scene)
        assert gone[245 - TOP, 40] and gone[245 - TOP + 10, 40 + 10] == corner
        assert scene.removed == gone.sum() > 150


def test_the_hand_drags_and_does_not_carve():
    scene = Carving(seed=1)
    scene.change("slider:tool", TOOLS.index("hand"))
    idle(scene, 5)
    _, name, x, y = MASKS[2]
    assert name.startswith("crate")
    play(scene, [InputFrame(pointer=(x, y)), *[InputFrame(pointer=(x + 30, y - 40), pointer_down=True)] * 3])
    assert scene.carves == 0 and not scene.drag.holds, "the press was beside it"
    play(scene, [InputFrame(pointer=(x, y)), *[InputFrame(pointer=(x, y), pointer_down=True)] * 3])
    assert scene.drag.holds and scene.carves == 0
    scene.change("slider:tool", TOOLS.index("blast"))
    assert not scene.draggable


def test_wheel_and_keys_choose_within_their_bounds():
    scene = Carving(seed=1)
    play(scene, [InputFrame(wheel=3), InputFrame(wheel=-2)])
    assert scene.tool.radius == scene.values["radius"] == 15
    play(scene, [InputFrame(wheel=-1)] * 40)
    assert scene.tool.radius == 3
    play(scene, [InputFrame(frozenset(("right",))), InputFrame(), InputFrame(frozenset(("right",)))])
    assert scene.tool.name == TOOLS[2]


def test_what_is_carved_away_whole_is_gone_from_everywhere():
    scene = Carving(seed=1)
    scene.change("slider:radius", 40)
    x, y = MASKS[0][2:]
    bodies = len(scene.world)
    play(scene, press((x, y)))
    assert len(scene.world) <= bodies - 3 and set(scene.prints.of) <= set(scene.world.bodies["id"].tolist())
    words(scene)
    assert scene.whole == scene.left + scene.removed + scene.crumbs and scene.left == scene.solid()


@compiled
def test_a_piece_shows_its_part_of_the_picture_it_came_from():
    scene = Carving(seed=1)
    scene.change("slider:tool", TOOLS.index("box"))
    scene.change("slider:radius", 9)
    picture = load_backdrop("lab_earth")
    play(scene, [*press((142, 168)), *press((222, 168))])
    assert scene.made == 1
    piece = scene.world.body(max(scene.prints.of))
    print_of, (mask,) = scene.prints.of[piece.id], piece.shapes
    # Where it was: a static mask's pixels and the picture's are one, and it has hardly moved yet.
    left, top = piece.position[0] - mask.origin[0], piece.position[1] - mask.origin[1] - TOP
    assert abs(print_of.left - left) < 1.0 and abs(print_of.top - top) < 2.0
    image = cut_out(print_of, mask.solid)
    for row, column in np.argwhere(mask.solid)[::37].tolist():
        shade = image.get_at((column, row))
        wanted = picture.get_at((print_of.left + column, print_of.top + row))
        assert shade in (wanted, pygame.Color(*EDGE)) and shade.a == 255
    assert image.get_at((0, 0)).a == (255 if mask.solid[0, 0] else 0)


@compiled
@pytest.mark.parametrize("seed", [2, 3])
def test_no_pixel_is_lost_however_wildly_it_is_dug(seed):
    scene = Carving(seed=seed)
    random = np.random.default_rng(seed)
    frames = []
    for _ in range(40):
        tool, radius = int(random.integers(0, 4)), int(random.integers(3, 30))
        place = (int(random.integers(0, 480)), int(random.integers(100, 264)))
        frames.append(InputFrame(changes=(("slider:tool", tool), ("slider:radius", radius)), pointer=place))
        frames += [InputFrame(pointer=place, pointer_down=True)] * 2
        frames += [InputFrame(pointer=(place[0] + 9 * k, place[1]), pointer_down=True) for k in range(4)]
    play(scene, frames)
    assert scene.carves > 60 and scene.unequal == 0 and scene.made >= 3
    assert scene.solid() + scene.removed + scene.crumbs == scene.whole
    words(scene)


def test_a_tool_forgets_its_stroke_when_it_is_let_go():
    tool = Tool()
    tool.choose("dig", 4)

    class At:
        def __init__(self, place, down=True):
            self.pointer, self.pointer_down = place, down

    assert tool.cut(At((10, 10)))[1] == (10.0, 10.0)
    stroke, pose = tool.cut(At((30, 10)))
    assert pose == (0.0, 0.0) and (stroke.a, stroke.b) == ((10.0, 10.0), (30.0, 10.0))
    assert tool.reach[0][0] <= 6.0 and tool.reach[1][0] >= 34.0
    assert tool.cut(At((30, 10))) is None, "it stands still"
    assert tool.cut(At((30, 10), False)) is None
    assert tool.cut(At((90, 10)))[1] == (90.0, 10.0)


# --- mask_stack ------------------------------------------------------------------------------------------------------


def test_figures_are_those_of_the_sprites_in_the_pile():
    scene = MaskStack(seed=1)
    scene.change("slider:sprites", CHOICES.index("stars"))
    scene.change("slider:high", 2)
    image = load_atlas("lab")["star_gold"]
    for number, way in enumerate(WAYS):
        assert np.isnan(scene.share(way)).all(), "nothing is told before it was measured"
        idle(scene, EVERY)
        assert [bool(np.isnan(scene.share(each)).any()) for each in WAYS].count(False) == number + 1
        found = measure(*shapes_of(image, way))
        assert scene.share(way) == pytest.approx((2 * found.corners, 2 * found.over, 2 * found.missed))
    by_way = {way: scene.share(way) for way in WAYS}
    mask = PixelMask.from_surface(image)
    left, top, right, bottom = mask.bounds
    assert by_way["box"][1] == pytest.approx(2 * ((right - left) * (bottom - top) - mask.area))
    assert by_way["exact"][1:] == pytest.approx((0.0, 0.0), abs=1e-6)


@pytest.mark.parametrize("choice", CHOICES)
def test_every_pile_has_the_same_sprites_in_all_columns(choice):
    scene = MaskStack(seed=1)
    scene.change("slider:sprites", CHOICES.index(choice))
    looks = [sorted(cast.looks.values()) for cast in scene.casts]
    assert all(each == looks[0] for each in looks) and len(looks[0]) >= 4
    starts = [world.bodies[world.bodies["inverse_mass"] > 0.0][["x", "y"]].tolist() for world in scene.worlds]
    assert all(each == starts[0] for each in starts)


def test_nothing_costs_anything_before_the_piles_have_been_laid():
    scene = MaskStack(seed=1)
    session = idle(scene, WARM - 1)
    assert scene.measured() is None
    scene.fits = {(name, way): (4, 0.0, 0.0) for way in WAYS for name, _, _ in scene.laid[way]}
    assert words(scene).count(UNKNOWN) == len(WAYS), "what fitting costs, under each pile"
    session.step()
    assert len(scene.measured().names) == len(WAYS)
    scene.change("slider:high", 2)
    assert scene.measured() is None, "other piles, other costs"


def test_who_stands_is_reported_as_it_is():
    scene = MaskStack(seed=1)
    session = idle(scene, 2)
    top = scene.tops[WAYS.index("outline")]
    (x, y), start = top.position, scene.starts["outline"]
    for place, stands in ((y, True), (start + FALLEN + 9.0, False), (y, True)):
        top.move_to((x, place), 0.0)
        top.velocity = (0.0, 0.0)
        session.step()
        assert scene.stands_now("outline") == stands
        shown = f"{scene.sinks['outline']:z.2f} px"
        assert shown in words(scene)
    for top in scene.tops:
        top.move_to((x, start + 40.0), 0.0)
    session.step()
    assert scene.offer


@compiled
def test_sleep_is_reported_since_when_and_a_nudge_wakes():
    scene = MaskStack(seed=1)
    session = idle(scene, 230)
    assert scene.asleep["outline"] and 0 < scene.changed["outline"] < 230
    assert any(text.startswith("sleeps ") for text in words(scene))
    play(scene, [InputFrame(frozenset(("fire",)))])
    assert not scene.asleep["outline"] and scene.changed["outline"] == scene.since
    del session


# --- mask_sweep ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("shape", SHAPES)
def test_walls_are_one_pixel_thin(shape):
    wall = wall_of(shape)
    solid = np.pad(wall.solid, 1)
    count = 0
    for y, x in np.argwhere(solid).tolist():
        # Open on two opposite sides: across, down, or along a diagonal.
        count += any(
            not solid[y + dy, x + dx] and not solid[y - dy, x - dx] for dx, dy in ((1, 0), (0, 1), (1, 1), (1, -1))
        )
    assert count == wall.area and max(wall.size) >= 2 * RADIUS


def test_a_ring_is_closed():
    solid = np.pad(wall_of("ring").solid, 1)
    outside = np.zeros_like(solid)
    outside[0, 0] = True
    for _ in range(solid.size):
        grown = outside.copy()
        for dy, dx in ((0, 1), (0, -1), (1, 0), (-1, 0)):
            grown |= np.roll(outside, (dy, dx), (0, 1))
        grown &= ~solid
        if (grown == outside).all():
            break
        outside = grown
    assert not outside[HALF + 1, HALF + 1]


def test_who_is_beyond_has_come_through():
    assert not is_beyond("straight", -3.0, 0.0) and is_beyond("straight", 3.0, 5.0)
    assert not is_beyond("aslant", 4.0, 9.0) and is_beyond("aslant", 9.0, 4.0)
    assert is_beyond("ring", 0.0, 5.0) and is_beyond("ring", 40.0, 0.0) and not is_beyond("ring", -RADIUS - 4.0, 3.0)


@compiled
@pytest.mark.parametrize("speed", [300, 1500, 6100, 9000])
def test_none_passes_at_any_speed(speed):
    scene = MaskSweep(seed=speed)
    scene.change("slider:speed", speed)
    idle(scene, 300)
    for shape in SHAPES:
        assert scene.passed["toi", shape] == 0 and scene.hit["toi", shape] >= 20
    fired = {(way, shape): scene.fired[way, shape] for way in ("off", "toi") for shape in SHAPES}
    assert all(fired["off", shape] == fired["toi", shape] for shape in SHAPES)
    if speed >= 1500:
        assert sum(scene.passed["off", shape] for shape in SHAPES) > 10


@compiled
def test_marks_stand_where_the_wall_was_met():
    scene = MaskSweep(seed=4)
    seen = 0
    session = Session(scene, IdleSource())
    for _ in range(120):
        session.step()
        for column, kind, pose, aim, fraction, age in scene.marks:
            x, y, _ = pose
            if age == 0 and column == 1 and abs(y - 37.0) < 36.0:  # the straight wall's lane
                ends = placed(scene.edges[kind], (0.0, 0.0, 0.0), pose).reshape(-1, 2)
                assert ends[:, 0].max() == pytest.approx(149.5, abs=0.6), "its foremost point touches the wall"
                assert aim is not None and 0.0 <= fraction < 1.0
                assert hypot(ends[:, 0].mean() - x, ends[:, 1].mean() - y) < 12.0
                seen += 1
    assert seen > 8
