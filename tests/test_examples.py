"""docs/examples/: the scene, shape, joint and overlay of CONTRIBUTING.md are complete in 40 lines each.

A test adds each to its list by the line that the page names, and then uses it as any other. The scene is played and
judged, the shape acts as an equal Polygon, the joint as a Distance with limits, and the overlay draws and only reads.
"""

import dataclasses
import json
import math
import re
from importlib import import_module
from pathlib import Path

import numpy as np
import pygame
import pytest

from game.command_line import run
from game.measure.shape_traces import gjk_steps, sat_axes
from game.overlays.stack import LAYERS, Overlays, layer_names
from game.registry import Registry
from game.run.digest import scene_digest
from game.run.picture import Picture
from game.scene import Scene, Slider
from physics import (
    BROADPHASES,
    Bounds,
    Capsule,
    Chain,
    Character,
    Circle,
    Distance,
    Effects,
    Filter,
    Material,
    PixelMask,
    Polygon,
    Segment,
    Snapshot,
    TileGrid,
    World,
    collide,
    debug,
    distance,
    mass_of,
    measure,
    time_of_impact,
)
from physics.jit import tiers
from physics.joints.kinds import KINDS
from physics.shapes.kinds import SHAPES
from scenes.lab.coverage import covered
from scenes.lab.pieces import piece
from tests.game.test_overlays import Crowd, play_screen, press, stepped

ROOT = Path(__file__).resolve().parent.parent
EXAMPLES = ROOT / "docs" / "examples"
LISTING = {"example/bounce": "bounce:Bounce"}
PIECES = {"diamond": "Diamond", "layer_speeds": "Speeds", "rope": "Rope"}  # shape, overlay, kind of joint


@pytest.fixture
def registry(monkeypatch):
    monkeypatch.syspath_prepend(str(EXAMPLES))
    return Registry(LISTING)


def test_every_example_is_tried_here_and_short():
    files = sorted(EXAMPLES.glob("*.py"))
    assert {path.stem for path in files} == {place.split(":")[0] for place in LISTING.values()} | PIECES.keys()
    for path in files:
        assert len(path.read_text().splitlines()) <= 40, path.name


@pytest.mark.parametrize("name", LISTING)
def test_an_example_is_a_scene_that_its_bot_wins(name, registry, capsys):
    assert issubclass(registry.scene_class(name), Scene)
    assert run(["--scene", name, "--headless", "--bot", "--frames", "300", "--json"], registry) == 0
    reported = json.loads(capsys.readouterr().out)
    assert reported["frames"] == 300 and reported["check"] == {"ok": True, "failures": [], "pending": []}


def test_the_ball_is_judged(registry, monkeypatch, capsys):
    """The goal of the example scene fails if the ball's restitution is not that of its slider, and is met otherwise."""
    bounce = registry.scene_class("example/bounce")
    monkeypatch.setattr(bounce, "sliders", (Slider("restitution", 0.4, 0.9, 0.5, step=0.1),))
    scene = bounce(seed=1)
    scene.values["restitution"] = 0.9
    for _ in range(240):
        scene.update(None)
    assert [goal.met for goal in scene.check()] == [False]
    scene.restart()
    for _ in range(240):
        scene.update(None)
    assert [goal.met for goal in scene.check()] == [True], "the slider holds from the restart on"


def test_it_draws_a_ball_where_it_is(registry):
    scene = registry.scene_class("example/bounce")(seed=1)

    class Canvas:
        surface = pygame.Surface((480, 270))

    scene.draw(Canvas, 0.0)
    assert Canvas.surface.get_at((240, 40)) == pygame.Color("gold")
    assert Canvas.surface.get_at((240, 100)) == pygame.Color("navy")


def test_contributing_shows_the_example_as_it_is():
    """CONTRIBUTING.md names each example file, and its links and commands exist."""
    text = (ROOT / "CONTRIBUTING.md").read_text()
    links = re.findall(r"\]\(([^)#:]+)\)", text)
    assert {f"docs/examples/{path.name}" for path in EXAMPLES.glob("*.py")} <= set(links)
    for link in links:
        assert (ROOT / link).exists(), f"CONTRIBUTING.md links to {link}, which is not there"
    for command in re.findall(r"python -m (tests\.\w+|assets[\w.]*|scenes[\w.]*)", text):
        place = ROOT / command.replace(".", "/")
        assert place.with_suffix(".py").exists() or (place / "__main__.py").exists(), command


# --- the joint --------------------------------------------------------------------------------------------------------


@pytest.fixture
def rope(monkeypatch):
    monkeypatch.syspath_prepend(str(EXAMPLES))
    kind = import_module("rope").Rope
    monkeypatch.setattr("physics.joints.kinds.KINDS", KINDS)
    KINDS.append(kind)
    yield kind
    KINDS.remove(kind)


@pytest.mark.parametrize("slack", [1.0, 1.3, 2.5])
@pytest.mark.parametrize("broadphase", BROADPHASES)
def test_a_kind_of_joint_from_the_page_does_what_a_distance_with_limits_does(broadphase, slack, rope, tmp_path):
    def played(make):
        world = World(Effects.rigid_bodies().with_(joints=True), BROADPHASES[broadphase]())
        balls = [world.add_body(Circle(6.0), position=(30.0 * k, 4.0 * k)) for k in range(1, 5)]
        for a, b in zip([None, *balls], balls, strict=False):
            start = (0.0, 0.0) if a is None else a.position
            world.add_joint(make(a, b, start, b.position))
        for _ in range(30):
            world.step()
        world.snapshot().save(tmp_path / "rope.npz")
        world.restore(Snapshot.load(tmp_path / "rope.npz"))
        for _ in range(90):
            world.step()
        return world

    new = played(lambda a, b, start, end: rope(a, b, at_a=start, at_b=end, slack=slack))
    known = played(lambda a, b, start, end: Distance(a, b, start, end, limits=(None, slack * math.dist(start, end))))
    assert new.bodies["x"].tolist() == known.bodies["x"].tolist()
    assert new.joint(0).kind == "Rope" and new.joints["separation"].max() < 0.2
    ids = new.add_joints(rope, [0, 1], [2, 3], at_a=[(0, 0), (9, 0)], at_b=[(0, 8), (9, 5)], slack=2.0)
    assert new.joints["upper"][-2:].tolist() == [16.0, 10.0] and len(ids) == 2


def test_a_kind_of_joint_from_the_page_is_named_and_checked(rope):
    world = World(Effects.rigid_bodies().with_(joints=True))
    ball = world.add_body(Circle(6.0), position=(30.0, 0.0))
    with pytest.raises(TypeError, match="Rope"):
        world.add_joint("rope")
    with pytest.raises(ValueError, match="slack must be finite and >= 1"):
        world.add_joint(rope(None, ball, at_a=(0, 0), at_b=(30, 0), slack=0.5))


# --- the shape --------------------------------------------------------------------------------------------------------

SIZES = ((30.0, 20.0, 0.0), (8.0, 8.0, 0.0), (3.0, 50.0, 2.5), (0.02, 0.03, 0.0), (400.0, 300.0, 40.0))
POSES = ((0.0, 0.0, 0.0), (3.0, -2.0, 0.7), (1000.5, -77.25, -2.1))
OTHERS = {
    "circle": Circle(6.0, (1.0, 2.0)),
    "capsule": Capsule((-5.0, 0.0), (6.0, 1.0), 3.0),
    "box": Polygon.box(12.0, 7.0),
    "segment": Segment((-9.0, 1.0), (8.0, -2.0)),
    "chain": Chain([(-60.0, 3.0), (0.0, 0.0), (60.0, 9.0)]),
    "tiles": TileGrid(np.ones((2, 5), bool), 8.0, slopes=None),
    "mask": PixelMask(np.hypot(*np.mgrid[-6.5:7, -6.5:7]) < 6.0),
    "exact mask": PixelMask(np.hypot(*np.mgrid[-6.5:7, -6.5:7]) < 6.0, snap=False),
    "bounds": Bounds(Circle(5.0)),
}


@pytest.fixture
def diamond_class(monkeypatch):
    """Return the class of the example shape, not yet added to the list of shapes."""
    monkeypatch.syspath_prepend(str(EXAMPLES))
    return import_module("diamond").Diamond


@pytest.fixture
def diamond(diamond_class):
    """Yield the class of the example shape while it is in the list of shapes."""
    SHAPES.append(diamond_class)
    yield diamond_class
    SHAPES.remove(diamond_class)


@pytest.fixture(params=SIZES, ids=str)
def twins(diamond, request):
    """Return (example shape, Polygon with the same corners)."""
    shape = diamond(*request.param)
    return shape, Polygon(shape.points, shape.radius)


def beside(shape, pose, share=0.35):
    """Return a pose that is offset from `pose` to near the edge of a shape, off its axes of symmetry."""
    left, top, right, bottom = shape.bounds
    return pose[0] + share * (right - left), pose[1] + 0.8 * share * (bottom - top), pose[2] + 0.3


def same_contact(found, wanted, size):
    assert len(found) == len(wanted)
    assert found.normal == pytest.approx(wanted.normal, abs=1e-9)
    rows = [np.column_stack([each.points, each.separations]) for each in (found, wanted) if len(each)]
    if rows:
        assert np.sort(rows[0], axis=0) == pytest.approx(np.sort(rows[1], axis=0), abs=1e-9 * (1.0 + size))
    assert found.area == pytest.approx(wanted.area)


def test_a_shape_that_is_not_in_the_list_is_refused(diamond_class):
    shape = diamond_class(8.0, 6.0)
    for call in (lambda: World().add_body(shape), lambda: collide(shape, (0, 0), shape, (0, 0)), lambda: Bounds(shape)):
        with pytest.raises(TypeError, match="shape"):
            call()


def test_bad_arguments_of_the_shape_are_named(diamond):
    for arguments, name in (((0.0, 4.0), "width"), ((4.0, math.nan), "height"), ((4.0, 4.0, -1.0), "radius")):
        with pytest.raises(ValueError, match=name):
            diamond(*arguments)
    with pytest.raises(TypeError, match="height"):
        diamond(4.0, "x")
    assert diamond(4, 2) == diamond(4.0, 2.0) != diamond(4.0, 3.0) and hash(diamond(4, 2)) == hash(diamond(4.0, 2.0))
    assert [each.name for each in dataclasses.fields(diamond) if each.init] == ["width", "height", "radius"]


def test_messages_list_the_shape(diamond):
    world = World(Effects(response=True, carving=True))
    body = world.add_body(PixelMask(np.ones((4, 4), bool)))
    for call in (
        lambda: Bounds(TileGrid(np.ones((1, 1), bool), 8)),
        lambda: body.carve(Segment((0, 0), (1, 1)), (0, 0)),
        lambda: Character(world, Segment((0, 0), (1, 1)), (0, 0)),
        lambda: measure(PixelMask(np.ones((4, 4), bool)), Segment((0, 0), (1, 1))),
        lambda: sat_axes(TileGrid(np.ones((1, 1), bool), 8), (0, 0), Circle(1), (0, 0)),
    ):
        with pytest.raises(TypeError, match="Circle.*Diamond"):
            call()


def test_its_mass_is_shapelys(twins):
    shapely = pytest.importorskip("shapely")
    from tests.physics.test_measure import second_moment

    shape, twin = twins
    figure = shapely.Polygon(shape.points)
    figure = figure.buffer(shape.radius, quad_segs=400) if shape.radius else figure
    found = mass_of(shape, 2.0)
    assert found.mass == pytest.approx(2.0 * figure.area, rel=1e-5)
    assert found.center == pytest.approx(figure.centroid.coords[0], abs=1e-6)
    assert found.inertia == pytest.approx(2.0 * second_moment(figure), rel=1e-5)
    assert found == mass_of(twin, 2.0) and shape.min_half_extent == twin.min_half_extent
    both = (shape.with_(material=Material(density=5.0)), Circle(4.0))
    assert mass_of(both, 1.0) == mass_of((twin.with_(material=Material(density=5.0)), Circle(4.0)), 1.0)


@pytest.mark.parametrize("pose", POSES, ids=str)
@pytest.mark.parametrize("other", OTHERS)
def test_it_meets_what_an_equal_polygon_meets(twins, other, pose):
    shape, twin = twins
    other, size = OTHERS[other], 1e3 + max(shape.bounds)
    at = beside(shape, pose)
    at = at if other._may_turn else (*at[:2], 0.0)
    same_contact(collide(shape, pose, other, at), collide(twin, pose, other, at), size)
    same_contact(collide(other, at, shape, pose, margin=3.0), collide(other, at, twin, pose, margin=3.0), size)
    for a, b in ((at, pose), ((at[0] + 3.0 * size, at[1], at[2]), pose)):
        gaps = [distance(other, a, each, b) for each in twins]
        assert gaps[0].distance == pytest.approx(gaps[1].distance, abs=1e-9 * size)
        assert gaps[0].normal == pytest.approx(gaps[1].normal, abs=1e-9)
    end = (pose[0] + 9.0, pose[1] + 2.0, pose[2] + 1.0)
    start = (at[0] + 3.0 * size, at[1], at[2])
    stop = (pose[0] - size, pose[1], at[2])
    impacts = [time_of_impact(each, pose, end, other, start, stop) for each in twins]
    assert impacts[0].hit == impacts[1].hit
    assert impacts[0].fraction == pytest.approx(impacts[1].fraction, abs=1e-12)


def test_a_world_of_it_is_a_world_of_polygons(twins):
    """A world of example shapes equals a world of polygons to the bit, because they have the same rows."""
    digests, scale = [], max(twins[0].bounds)
    for shape in twins:
        world = World(pixels_per_meter=max(scale, 0.5), gravity=(0.0, 30.0 * scale))
        world.add_body(Polygon.box(40 * scale, 2 * scale), position=(0, 6 * scale), kind="static")
        world.add_body(Chain([(-9 * scale, 4 * scale), (0, 5 * scale)]), kind="static")
        for k in range(6):
            place = (scale * (1.9 * k - 4.0), -2.0 * scale * (k % 2))
            world.add_body(shape, position=place, angle=0.4 * k, velocity=(scale, 0.0), bullet=k == 3)
        for _ in range(90):
            world.step()
        assert len(world.contacts)
        digests.append(world.digest())
    assert digests[0] == digests[1]


def world_of(shape, pose):
    world = World(Effects(response=True, sensors=True))
    world.add_body(Circle(5.0), position=(pose[0] - 900.0, pose[1]), kind="static")
    world.add_body(shape, position=pose[:2], angle=pose[2], kind="static", filter=Filter(2))
    world.add_body(Bounds(shape), position=(pose[0], pose[1] + 900.0), angle=pose[2], kind="static")
    return world


@pytest.mark.parametrize("pose", POSES, ids=str)
def test_queries_find_it_where_an_equal_polygon_is(twins, pose):
    asked = []
    for shape in twins:
        world, (x, y, _) = world_of(shape, pose), pose
        far = 2.0 * max(shape.bounds) + 5.0
        hits = [world.ray_cast((x - far, y + 0.1 * far), (2.0 * far, -0.2 * far))]
        hits += [world.shape_cast(each, (x - far, y, 0.2), (2.0 * far, 0.0)) for each in (Circle(0.5), shape, twins[1])]
        hits += world.ray_cast_all((x - 0.25, y - far), (0.5, 2.0 * far))
        found = [[each.body.id, *each.point, *each.normal, each.fraction] for each in hits]
        body, point, gap = world.closest((x + far, y))
        found.append([body.id, *point, gap])
        met = [world.overlap(each, pose) for each in (Circle(0.1), shape)]
        met += [world.query_point((x, y)), world.query_aabb((x - 1, y - 1), (x + 1, y + 1))]
        found += [[each.id for each in bodies] for bodies in met]
        found += [list(body.bounds) for body in world]
        asked.append(found)
    assert [len(each) for each in asked[0]] == [len(each) for each in asked[1]]
    for one, two in zip(*asked, strict=True):
        assert one == pytest.approx(two, abs=1e-9)


def test_a_character_walks_in_its_shape(diamond):
    walks = []
    for shape in (diamond(12.0, 20.0), Polygon(diamond(12.0, 20.0).points), Bounds(diamond(12.0, 20.0))):
        world = World(Effects(response=True))
        world.add_body(Chain([(-99, 50), (0, 50), (60, 30), (200, 30)]), kind="static")
        world.add_body(diamond(20.0, 30.0), position=(90.0, 20.0), kind="static")
        hero = Character(world, shape, (-40, 20))
        walks.append([(*hero.move(1.0, 2.0)[:5], *hero.position) for _ in range(160)])
    assert walks[0] == walks[1] and walks[0][-1][3] == 1, "it came to the other one and stopped"
    assert walks[2] != walks[0], "its box has corners"


def test_snapshots_bring_it_back(twins, tmp_path):
    shape, _ = twins
    world, other = (World(pixels_per_meter=max(shape.bounds)) for _ in range(2))
    world.add_body(shape.with_(material=Material(friction=0.1)), Bounds(shape), angle=0.5)
    world.add_body(shape, Circle(3.0), position=(9.0, 9.0), kind="static")
    for _ in range(5):
        world.step()
    world.snapshot().save(tmp_path / "s.npz")
    other.restore(Snapshot.load(tmp_path / "s.npz"))
    assert [body.shapes for body in other] == [body.shapes for body in world]
    assert type(other.body(0).shapes[0]) is type(shape) and other.body(0).shapes[0].material.friction == 0.1
    for _ in range(20):
        world.step()
        other.step()
    assert world.digest() == other.digest()
    for body in world:  # the shapes of a library that is tidied are its own
        body.set_shapes(shape)
    assert world.library.shape_of(world.shapes[0]) == shape


def test_it_carves_and_stands_for_a_sprite(twins):
    disc = PixelMask(np.hypot(*np.mgrid[-15.5:16, -15.5:16]) < 15.0)
    left = []
    for shape in twins:
        world = World(Effects(response=True, carving=True))
        body = world.add_body(disc, kind="static")
        carved = body.carve(shape, (4.0, 3.0, 0.3))
        left.append((carved.removed, carved.crumbs, len(carved.fragments)))
    assert left[0] == left[1]
    assert measure(disc, twins[0]) == measure(disc, twins[1])


def test_it_needs_no_kernel_of_its_own(diamond):
    """The example shape calls only kernels that the warm-up compiles for polygons."""
    calls = []
    for shape in (Polygon(diamond(8.0, 6.0).points), diamond(8.0, 6.0)):
        with tiers.collecting(all_calls=True) as found:
            world = world_of(shape, POSES[1])
            world.add_body(shape, position=(3.0, -20.0), velocity=(0.0, 99.0))
            for _ in range(30):
                world.step()
            world.ray_cast((-90, 0), (200, 0))
            world.shape_cast(shape, (-90, 0), (200, 0))
            collide(shape, (0, 0), shape, (1, 1))
            distance(shape, (0, 0), shape, (9, 9))
            time_of_impact(shape, (0, 0), (5, 5), shape, (9, 9), (9, 9, 1))
        calls.append(set(found))
    assert calls[1] <= calls[0]


def test_it_is_drawn_where_it_is(twins):
    """The example shape is drawn as an equal Polygon, by the overlay of outlines and in the style of the labs."""
    shape, twin = twins
    pictures = []
    for each in twins:
        scene = Crowd()
        scene.world.clear()
        scene.world.add_body(each, position=(240.0, 135.0), angle=0.4)
        scene = stepped(scene, 1)
        (outline,) = debug.outlines(scene.world)
        assert outline[0] == ("rounded" if shape.radius else "polygon") and len(outline[1]) == 4
        overlays = Overlays(["outlines"])
        frame = Picture().draw_scene(scene, overlays)
        assert overlays.legend()[0][1] == "shapes 1 of 1"
        pictures.append(pygame.surfarray.array3d(frame.surface))
    assert (pictures[0] == pictures[1]).all()
    if shape.bounds[2] < 200.0:
        looks = [pygame.surfarray.array3d(piece(each, "wood")) for each in twins]
        assert (looks[0] == looks[1]).all()
    x, y = np.meshgrid(np.linspace(-40.0, 40.0, 61), np.linspace(-40.0, 40.0, 61))
    assert (covered((shape,), x, y) == covered((twin,), x, y)).all()
    rounds = [gjk_steps(each, (0, 0), Circle(3.0), (5, 1)) for each in twins]
    assert len(rounds[0]) == len(rounds[1])
    axes = [sat_axes(each, POSES[1], OTHERS["box"], POSES[0])["separation"] for each in twins]
    assert axes[0] == pytest.approx(axes[1])


# --- the overlay ------------------------------------------------------------------------------------------------------


@pytest.fixture
def speeds(monkeypatch):
    """Yield the class of the example overlay while it is in the list of layers."""
    monkeypatch.syspath_prepend(str(EXAMPLES))
    layer = import_module("layer_speeds").Speeds
    LAYERS.append(layer)
    yield layer
    LAYERS.remove(layer)


def test_the_overlay_is_there_by_name_and_by_key(speeds, registry, capsys):
    assert layer_names()[-1] == "speeds" and Overlays().layers[-1].name == "speeds"
    keys = [layer.key for layer in LAYERS]
    assert len(set(keys)) == len(keys)
    arguments = ["--scene", "example/bounce", "--headless", "--bot", "--frames", "60", "--json"]
    digests = []
    for layers in ("none", "speeds", "all"):
        assert run([*arguments, "--overlay", layers], registry) == 0
        digests.append(json.loads(capsys.readouterr().out)["digest"])
    assert digests[0] == digests[1] == digests[2]
    assert run([*arguments, "--overlay", "speed"], registry) == 2 and "speeds" in capsys.readouterr().err
    play = play_screen()
    assert press(play, pygame.K_y) and play.overlays.on == {"speeds"}
    assert press(play, pygame.K_y) and not play.overlays.on


def test_the_overlay_draws_what_moves_and_only_reads(speeds):
    scene = stepped(Crowd())
    before = scene_digest(scene)
    plain = pygame.surfarray.array3d(Picture().draw_scene(scene, Overlays()).surface)
    overlays = Overlays(["speeds"])
    frame = Picture().draw_scene(scene, overlays)
    shown = pygame.surfarray.array3d(frame.surface)
    assert scene_digest(scene) == before
    ((color, note),) = overlays.legend()
    assert note == "speeds 46 of 46, 0.25 s long"
    lens = frame.lens(scene.camera)
    body = next(body for body in scene.world if body.velocity[0] > 0.0)
    x, y = lens.points(*(body.center + 0.125 * body.velocity))
    assert tuple(shown[round(x), round(y)]) == frame.tone(color) != tuple(plain[round(x), round(y)])


def test_the_overlay_keeps_to_its_view_and_its_budget(speeds, monkeypatch):
    scene = stepped(Crowd())
    monkeypatch.setattr("layer_speeds.SPEED_BUDGET", 3)
    overlays = Overlays(["speeds"])
    Picture().draw_scene(scene, overlays)
    assert overlays.legend()[0][1].startswith("speeds 3 of 46")
    scene.camera.place(1e5, 1e5)
    Picture().draw_scene(scene, overlays)
    assert overlays.layers[-1].drawn == 0
    scene.world.clear()
    Picture().draw_scene(stepped(scene, 1), overlays)
