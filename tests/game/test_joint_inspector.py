"""The joint inspector: a click on a joint of a paused scene shows its settings, and each stage's result, with units."""

import re
from math import hypot, inf

import numpy as np
import pygame
import pytest

from game.drawing.number_text import amount_text, count_text, plain_name
from game.input.inputs import InputState
from game.measure import joint_inspector
from game.measure.joint_batch import JointBatch
from game.measure.joint_inspector import cost_of, explain, near, title_of, tree_rows, untimed
from game.overlays.layer_joints import anchored
from game.overlays.stack import Overlays
from game.run.digest import scene_digest
from game.run.picture import Picture
from game.run.session import Session
from game.run.sources import BotSource, ScriptSource
from game.screens.parts.inspector_view import JointSubject, subjects_at
from physics import (
    JIT,
    Circle,
    Distance,
    Drive,
    Effects,
    Gear,
    Motor,
    Polygon,
    Prismatic,
    Pulley,
    Ratchet,
    Revolute,
    Spring,
    Target,
    Weld,
    World,
)
from physics.joints.kinds import KINDS
from physics.solver.joint_direct import list_tree_joints
from tests.game.reading import assert_text_is_apart
from tests.game.test_layer_joints import Workshop, every_kind
from tests.game.test_step_inspector import key, screen
from tests.lockstep import make_scene

JOINTED = Effects.rigid_bodies().with_(joints=True)
TIERS = ("iterative", "direct", "auto")
SOLVERS = ("soft_step", "sequential_impulse")
SIZES = [(480, 270), (640, 360), (960, 540), (1280, 720), (1440, 810), (1100, 900)]
MACHINES = 6
# Words after a number that give it a unit, and words before a number that need none.
UNITS = "px mm rad rad/s px/s Hz mass density deg % us ns x a to in other others loop loops equations".split()
NAMED = "body joint ratio".split()


def jointed(solver="soft_step", tier="auto", gravity=300.0):
    """Return a scene with a joint of each of the twelve kinds, after five steps."""
    scene = every_kind(Workshop(seed=1))
    world = scene.world
    box = world.add_body(Polygon.box(12, 12), position=(460, 60))
    world.add_joint(Motor(None, box, max_force=1e6, max_torque=1e6))
    world.solver, world.joint_solver, world.gravity = solver, tier, (0.0, gravity)
    return scene.stepped(5)


def said(world, identity):
    return {part.stage.partition(",")[0]: part.text for part in explain(world, identity)}


def bare_numbers(text):
    """Return the numbers of a text that no unit follows and no name precedes."""
    words, found = re.sub(r"[()<,;:]", " ", text).split(), []
    for before, word, after in zip(["", *words], words, [*words[1:], ""], strict=False):
        if re.fullmatch(r"-?[\d.]+(e-?\d+)?[kMGT]?", word) and after not in UNITS and before not in NAMED:
            found.append(f"{before} {word} {after}")
    return found


def hung(kind="weld", tier="auto", solver="soft_step", **given):
    """Return (world, joint) of a box that hangs from the world, after 25 steps: it is at rest and not yet asleep."""
    world = World(JOINTED, solver=solver, gravity=(0.0, 320.0))
    world.joint_solver = tier
    box = world.add_body(Polygon.box(20, 20), position=(100, 100))
    makers = {
        "weld": lambda: Weld(None, box, at=(100, 100), **given),
        "rope": lambda: Distance(None, box, at_a=(100, 50), at_b=(100, 100), limits=(0, 50), **given),
        "slider": lambda: Prismatic(None, box, at=(100, 100), axis=(0, 1), **given),
        "hinge": lambda: Revolute(None, box, at=(100, 100), **given),
    }
    joint = world.add_joint(makers[kind]())
    for _ in range(25):
        world.step()
    return world, joint


# --- the text -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("value, text", [
    (0.0, "0"), (-0.0, "0"), (1.0, "1"), (-12.345, "-12.3"), (999.4, "999"), (999.6, "1k"), (1234.0, "1.23k"),
    (-20_000.0, "-20k"), (3_141_592.0, "3.14M"), (9.9996e8, "1G"), (5e12, "5T"), (1e16, "1e+16"), (1.5e-9, "1.5e-09"),
])  # fmt: skip
def test_an_amount_has_three_digits(value, text):
    assert amount_text(value) == text


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("tier", TIERS)
def test_every_kind_is_explained_with_units(tier, solver):
    world, kinds = jointed(solver, tier).world, set()
    for row in world.joints:
        identity = int(row["id"])
        kinds.add(KINDS[row["kind"]].__name__)
        parts = explain(world, identity)
        names = [part.stage for part in parts]
        assert names[:3] == ["bodies", "setting", "islands"] and title_of(world, identity).endswith("?")
        if KINDS[row["kind"]].__name__ == "NoContact":
            assert names[3:] == ["broad phase"] and "no forces" in parts[-1].text
        else:
            solved = "direct" if row["direct"] else "iterative"
            stages = f"substeps, by load; joint solver, {solved}; warm start; solver, {plain_name(solver)}; joints"
            assert names[3:] == stages.split("; ")
            assert f'joint_solver is "{tier}"' in parts[4].text
            assert (solved == "direct") <= (tier != "iterative")
        for part in parts:
            assert not bare_numbers(part.text), (part.stage, part.text)
            assert "inf" not in part.text and "nan" not in part.text, (part.stage, part.text)
    assert kinds == {kind.__name__ for kind in KINDS}


def test_the_equations_of_a_tree_are_those_of_the_solver():
    world = jointed().world
    rows, n = world.joints, len(world.joints)
    order, counts = np.zeros(n, np.int64), np.zeros(n, np.int32)
    list_tree_joints(np.arange(n, dtype=np.int32), rows, order, counts, np.zeros(n, np.int32), np.zeros(n, np.int32))
    asked = [tree_rows({name: row[name].item() for name in rows.dtype.names}) for row in rows]
    assert asked == counts.tolist() and set(asked) == {0, 1, 2, 3}


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("tier", TIERS)
@pytest.mark.parametrize("share", [0.004, 0.25, 0.8])
def test_force_and_share_of_the_breaking_force(share, tier, solver):
    world, joint = hung(tier=tier, solver=solver)
    weight = joint.body_b.mass * 320.0
    joint.breaks = (weight / share, None)
    world.step()
    text = said(world, joint.id)["solver"]
    assert text.startswith(f"{amount_text(joint.force)} mass px/s2 on B at -90 deg (1 x the weight")
    assert joint.force == pytest.approx(weight, rel=2e-3)
    assert ("less than 1 %" if share < 0.01 else f"{100 * share:.0f} %") + " of its break force" in text
    assert f"breaks above {amount_text(weight / share)} mass px/s2" in said(world, joint.id)["setting"]


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("tier", TIERS)
@pytest.mark.parametrize(
    "limits, words",
    [
        ((-30.0, 10.0), "at its upper limit"),
        ((-30.0, 0.0), "at its upper limit"),
        ((-30.0, 1e6), "between its limits"),
        ((None, 1e6), "off its limit"),
        ((-1.0, None), "off its limit"),
    ],
)
def test_limits_reached_or_not(limits, words, tier, solver):
    world, joint = hung("slider", tier, solver, limits=limits)
    assert words in said(world, joint.id)["solver"]
    assert "translation" in said(world, joint.id)["joints"]


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("gravity, words", [(320.0, "rope taut"), (-320.0, "rope slack")])
def test_a_pulley_is_taut_or_slack(gravity, words, solver):
    world = World(JOINTED, solver=solver, gravity=(0.0, gravity))
    a, b = (world.add_body(Circle(8), position=(x, 100)) for x in (100, 140))
    rope = world.add_joint(Pulley(a, b, at_a=(100, 100), at_b=(140, 100), ground_a=(100, 40), ground_b=(140, 40)))
    for _ in range(5):
        world.step()
    assert words in said(world, rope.id)["solver"]


@pytest.mark.parametrize("tier", TIERS)
@pytest.mark.parametrize("share", [0.25, 0.5, 1.0])
def test_share_of_the_motors_maximum(share, tier):
    """A motor that stands still against gravity bears the weight; one that is too weak gives all it has."""
    weight = 20 * 20 * 320.0
    world, joint = hung("slider", tier, motor=Drive(0.0, max=weight / share))
    assert f"motor at {100 * share:.0f} % of its maximum" in said(world, joint.id)["solver"]
    weak = hung("slider", tier, motor=Drive(0.0, max=0.5 * weight))
    assert "motor at 100 % of its maximum" in said(weak[0], weak[1].id)["solver"]


@pytest.mark.parametrize("scale", [1.0, 32.0, 100.0])
def test_the_gap_is_in_pixels_and_millimetres(scale):
    world = World(JOINTED, gravity=(0.0, 0.0), pixels_per_meter=scale)
    box = world.add_body(Polygon.box(20, 20), position=(100, 100))
    target = world.add_joint(Target(box, at=(100, 100), point=(106, 108), max_force=1.0))
    world.step()
    assert target.separation == pytest.approx(10.0, rel=1e-3)
    text = said(world, target.id)["joints"]
    gap, mm = re.search(r"anchors apart by (\S+) px \((\S+) mm\)", text).groups()
    assert gap == "10" and mm == amount_text(1e3 * target.separation / scale)


def test_settings_of_gears_pulleys_and_ratchets():
    world = World(JOINTED)
    a, b = (world.add_body(Circle(8), position=(x, 100)) for x in (100, 140))
    hinges = [world.add_joint(Revolute(None, each, at=each.position)) for each in (a, b)]
    slide = world.add_joint(Prismatic(a, b, at=(120, 100)))
    texts = [
        said(world, world.add_joint(each).id)["setting"]
        for each in (
            Gear(*hinges, ratio=2.0),
            Gear(slide, a, ratio=-3.0),
            Pulley(a, b, at_a=(100, 100), at_b=(140, 100), ground_a=(100, 40), ground_b=(140, 40), ratio=1.5),
            Ratchet(None, a, ratchet=0.25),
        )
    ]
    assert "keeps joint 0 + 2 x joint 1 at 0 rad" in texts[0]
    assert f"keeps joint {slide.id} - 3 x body {a.id} at 0 px" in texts[1]
    assert "a rope of 150 px over two wheels, ratio 1.5" in texts[2]
    assert "a tooth every 0.25 rad" in texts[3]


@pytest.mark.parametrize(
    "given, words",
    [
        ({"limits": (-0.5, 1.0)}, ["angle from -0.5 to 1 rad", "without motor or spring"]),
        ({"limits": (None, 1.0)}, ["angle at most 1 rad"]),
        ({"limits": (0.0, None)}, ["angle at least 0 rad"]),
        ({"limits": (0.0, 0.0)}, ["angle held at 0 rad"]),
        ({}, ["angle without limits, motor or spring", "never breaks", "no contacts between"]),
        ({"motor": Drive(2.0, max=5e6)}, ["motor to 2 rad/s with up to 5M mass px2/s2", "without limits or spring"]),
        ({"spring": Spring(3.0, 0.5)}, ["spring of 3 Hz, damping ratio 0.5, rest at 0 rad"]),
        ({"breaks": (None, 4e7), "contacts": True}, ["breaks above 40M mass px2/s2", ", contacts between"]),
    ],
)
def test_settings_of_a_hinge(given, words):
    world, joint = hung("hinge", **given)
    setting = said(world, joint.id)["setting"]
    assert all(each in setting for each in words), setting
    joint.enabled = False
    world.step()
    assert said(world, joint.id)["setting"].startswith("switched off")
    assert cost_of(world, joint.id) is None and "not solved" in untimed(world, joint.id)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("count, closed", [(3, False), (3, True), (6, False), (6, True)])
def test_the_tree_and_its_loops_are_counted(count, closed, solver):
    world = World(JOINTED, solver=solver, gravity=(0.0, 0.0))
    boxes = [world.add_body(Circle(5), position=(20 * k, 100)) for k in range(count)]
    ids = [world.add_joint(Revolute(a, b, at=b.position)).id for a, b in zip(boxes, boxes[1:], strict=False)]
    if closed:
        ids.append(world.add_joint(Revolute(boxes[-1], boxes[0], at=(10 * count, 150))).id)
    other = world.add_joint(Revolute(None, world.add_body(Circle(5), position=(500, 0)), at=(500, 0)))
    world.step()
    for identity in ids:
        text = said(world, identity)["joint solver"]
        assert f"exact, with {count_text(len(ids) - 1, 'other')} in its tree" in text and ("1 loop" in text) == closed
    assert "alone in its tree" in said(world, other.id)["joint solver"]


def test_a_mesh_is_explained_by_its_loops():
    """In a net, "auto" leaves the exact solver; the card names the bound."""
    world = World(JOINTED, gravity=(0.0, 0.0))
    grid = [[world.add_body(Circle(3), position=(10 * x, 10 * y)) for x in range(14)] for y in range(14)]
    for y in range(14):
        for x in range(14):
            for dx, dy in ((1, 0), (0, 1)):
                if x + dx < 14 and y + dy < 14:
                    at = (10 * x + 5 * dx, 10 * y + 5 * dy)
                    world.add_joint(Revolute(grid[y][x], grid[y + dy][x + dx], at=at))
    world.step()
    assert not world.joints["direct"].any()
    assert "loops have more than 96 equations" in said(world, 100)["joint solver"]


def test_asleep_and_awake():
    scene = Workshop(seed=1)
    world = scene.world
    world.add_body(Polygon.box(400, 20), position=(240, 200), kind="static")
    pair = [world.add_body(Polygon.box(20, 20), position=(x, 180)) for x in (230, 250)]
    joint = world.add_joint(Weld(*pair, at=(240, 180)))
    scene.stepped(5)
    assert "awake" in said(world, joint.id)["islands"] and cost_of(world, joint.id) is not None
    scene.stepped(300)
    reported = said(world, joint.id)
    assert "asleep" in reported["islands"] and reported["joint solver"] == "not solved in this step"
    assert cost_of(world, joint.id) is None and "costs nothing" in untimed(world, joint.id)


@pytest.mark.parametrize("count", [1, 4, 16])
def test_fixed_substeps(count):
    world, joint = hung()
    world.substeps = count
    world.step()
    assert said(world, joint.id)["substeps"] == f"{count} a step: world.substeps"
    world.substeps = "auto"
    assert said(world, joint.id)["substeps"] == f"of its group: {world.bodies['substeps'][0]} in the next"


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("tier", TIERS)
def test_substeps_by_load(tier, solver):
    """The group of a chain under load took the number of substeps that the step before chose, another group its own."""
    world = World(JOINTED, solver=solver, gravity=(0.0, 320.0))
    world.joint_solver = tier
    before, chain = None, []
    for k in range(6):
        link = world.add_body(Polygon.box(12, 4), position=(100 + 12 * k, 100), mass=1.0 if k < 5 else 300.0)
        chain.append(world.add_joint(Revolute(before, link, at=(94 + 12 * k, 100))))
        before = link
    ball = world.add_body(Circle(5), position=(400, 100))
    alone = world.add_joint(Revolute(None, ball, at=ball.position))
    assert said(world, alone.id)["substeps"] == "not solved in this step"
    world.step()
    taken = set()
    for _ in range(20):
        chosen = world.bodies["substeps"].copy()
        world.step()
        for joint in (*chain, alone):
            row = int(world.rows([joint.body_b.id])[0])
            now, following = chosen[row], world.bodies["substeps"][row]
            text = said(world, joint.id)["substeps"]
            assert text == f"its group took {now} in this step, {following} in the next"
            taken.add(int(now))
    assert (len(taken) > 1) == (tier == "iterative"), "a tree does not sag"


def test_nothing_is_changed_and_a_joint_that_is_gone_is_refused():
    scene = jointed()
    before = scene_digest(scene)
    for identity in scene.world.joints["id"].tolist():
        explain(scene.world, identity)
        cost_of(scene.world, identity)
    assert scene_digest(scene) == before
    scene.world.joint(0).remove()
    for ask in (explain, cost_of, title_of, untimed):
        with pytest.raises(KeyError, match="joint 0"):
            ask(scene.world, 0)
    assert not joint_inspector.is_there(scene.world, 0)


# --- the cost -------------------------------------------------------------------------------------------------------


@pytest.mark.skipif(not JIT, reason="a thousand copies need compiled kernels")
@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("tier", TIERS)
def test_a_joint_alone_is_timed_on_a_thousand_of_it(tier, solver):
    world = jointed(solver, tier).world
    for identity in world.joints["id"].tolist():
        cost = cost_of(world, identity)
        if world.joint(identity).kind == "NoContact":
            assert cost is None
        else:
            assert cost.pieces >= 1000 and cost.runs == 5 and 0.0 <= cost.least <= cost.median < 1e-3


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("tier", TIERS)
@pytest.mark.parametrize("kind", range(4))
def test_copies_move_as_the_joint_does(kind, tier, solver):
    """Each copy of a joint whose bodies have no other joint makes the step that the joint makes next."""
    world = World(JOINTED, solver=solver, gravity=(10.0, 320.0), substeps=4)
    world.joint_solver = tier
    a, b = (world.add_body(Polygon.box(20, 10), position=(x, 100), angle=0.2) for x in (100, 130))
    world.bodies["angular_velocity"][0] = 2.0
    hinges = []
    if kind == 0:
        joint = world.add_joint(Revolute(None, a, at=(95, 100), motor=Drive(2.0, max=1e6)))
    elif kind == 1:
        joint = world.add_joint(Weld(a, b, at=(115, 100), spring=Spring(3.0, 0.5)))
    elif kind == 2:
        joint = world.add_joint(
            Pulley(a, b, at_a=(100, 100), at_b=(130, 100), ground_a=(100, 20), ground_b=(130, 20), ratio=2.0)
        )
    else:
        hinges = [world.add_joint(Revolute(None, each, at=each.position)) for each in (a, b)]
        joint = world.add_joint(Gear(*hinges, ratio=3.0))
    for _ in range(5):
        world.step()
    batch = JointBatch(world, joint.id, 5, 4)
    assert len(batch.jointed.joints) == 5 * (1 + len(hinges)) and len(batch.bare.joints) == 5 * len(hinges)
    batch.seconds()
    world.step()
    own, rows = world.joints[-1], batch.jointed.joints[-5:]
    for name in ("angle", "translation", "speed", "separation", "force_x", "force_y", "torque"):
        assert rows[name] == pytest.approx(np.full(5, own[name]), rel=1e-6, abs=1e-6), name
    assert (rows["direct"] == own["direct"]).all()


# --- clicks ---------------------------------------------------------------------------------------------------------


def test_the_nearest_joint_is_found_by_its_anchors_and_its_line():
    scene = Workshop(seed=1)
    world = scene.world
    a, b = (world.add_body(Circle(6), position=(x, 100)) for x in (100, 200))
    rod = world.add_joint(Distance(a, b, at_a=(100, 100), at_b=(200, 100)))
    pin = world.add_joint(Revolute(None, b, at=(203, 100)))
    assert [each.joint for each in near(world, 150.0, 103.0, 5.0)] == [rod.id], "between the anchors of the rod"
    assert near(world, 150.0, 106.0, 5.0) == []
    assert [each.joint for each in near(world, 202.5, 100.0, 5.0)] == [pin.id, rod.id]
    assert near(World(JOINTED), 0.0, 0.0, 5.0) == []


@pytest.mark.parametrize("aside, kind", [(0.0, "JointSubject"), (6.0, "ContactSubject")])
def test_the_nearest_of_contact_and_joint_wins(aside, kind):
    world = World(JOINTED, gravity=(0.0, 320.0))
    world.add_body(Polygon.box(200, 20), position=(100, 200), kind="static")
    box = world.add_body(Polygon.box(20, 20), position=(100, 180))
    for _ in range(30):
        world.step()
    touch = world.contacts[0]
    x, y = float(touch["point_x"]), float(touch["point_y"])
    world.add_joint(Revolute(None, box, at=(x + 1.0, y)))
    found = subjects_at(world, x + (1.0 if kind == "JointSubject" else -1.0), y, 5.0)
    assert type(found[0]).__name__ == kind and len(found) == 1


@pytest.fixture
def play():
    scene = make_scene("lab/joints")
    scene.change("slider:machine", 4)  # gears: each is where a hinge is, too
    play = screen(scene, ScriptSource([]), 20 if JIT else 3)
    yield play
    play.close()


def words(frame):
    return " ".join(text for _, text in frame.boxes)


def click(play, identity):
    """Click on anchor B of a joint, until its card is open. Return whether a card is open."""
    world, lens = play.inspector.lenses[0]
    rows = anchored(world)
    row = rows[int(np.searchsorted(rows["joint"], identity))]
    x, y = lens.points(float(row["bx"]), float(row["by"]))
    for _ in range(9):
        used = play.feed(pygame.event.Event(pygame.MOUSEBUTTONDOWN, button=1, pos=(round(x), round(y))))
        if used and play.inspector.chosen is not None and play.inspector.chosen[1] == JointSubject(identity):
            return True
    return False


def test_a_click_on_a_joint_opens_its_card_and_another_one_closes_it(play):
    picture = Picture(pygame.Surface((960, 540)))
    play.draw(picture)
    assert not click(play, 0), "the scene runs"
    key(play, pygame.K_p)
    before = scene_digest(play.scene)
    play.draw(picture)
    assert click(play, 0)
    reported = words(play.draw(picture))
    for each in (
        "Revolute 0 hold body 3 to",
        "joint solver, iterative",
        "warm start",
        "this joint alone",
        "copies in a step",
    ):
        assert each in reported, each
    play.feed(pygame.event.Event(pygame.MOUSEBUTTONDOWN, button=1, pos=(300, 420)))
    assert play.inspector.chosen is None and "Revolute 0" not in words(play.draw(picture))
    assert click(play, 0) and scene_digest(play.scene) == before
    key(play, pygame.K_p)
    assert "Revolute 0" not in words(play.draw(picture)) and play.inspector.chosen is None


def test_clicks_in_one_place_open_one_card_after_the_other(play):
    picture = Picture(pygame.Surface((960, 540)))
    key(play, pygame.K_p)
    play.draw(picture)
    assert click(play, 1)
    seen, (_, first) = [], play.inspector.chosen
    for _ in range(play.inspector.others + 1):
        seen.append(play.inspector.title)
        assert f"{play.inspector.others} more here" in words(play.draw(picture))
        click_again = play.inspector.chosen[1]
        world, lens = play.inspector.lenses[0]
        row = anchored(world)[1]
        x, y = lens.points(float(row["bx"]), float(row["by"]))
        play.feed(pygame.event.Event(pygame.MOUSEBUTTONDOWN, button=1, pos=(round(x), round(y))))
        assert play.inspector.chosen[1] != click_again
    assert play.inspector.chosen[1] == first and len(set(seen)) == len(seen) > 1
    assert any("Gear" in each for each in seen) and any("Revolute" in each for each in seen)


def test_a_joint_that_breaks_takes_its_card_with_it(play):
    picture = Picture(pygame.Surface((960, 540)))
    key(play, pygame.K_p)
    play.draw(picture)
    assert click(play, 0)
    play.scene.world.joint(0).remove()
    play.draw(picture)
    assert play.inspector.chosen is None


# --- the picture ----------------------------------------------------------------------------------------------------


def cards(play, size):
    """Yield (frame, joint id) of a picture with the card of one joint of each kind in the shown world."""
    picture = Picture(pygame.Surface(size))
    play.draw(picture)
    world = play.inspector.lenses[0][0]
    _, firsts = np.unique(world.joints["kind"], return_index=True)
    for identity in {*world.joints["id"][firsts].tolist(), world.joints["id"].tolist()[-1]}:
        play.inspector.chosen = None
        play.draw(picture)
        if click(play, identity):
            yield play.draw(picture), identity


def assert_card_is_whole(play, frame):
    """Assert that every line of the open card is in the picture, and that no two texts overlap."""
    assert_text_is_apart(frame.boxes, frame.rect)
    shown, card = words(frame), frame.fixed[-1]
    assert frame.rect.contains(card)
    for part in play.inspector.parts:
        assert part.stage in shown
    lines = [box for box, _ in frame.boxes if card.contains(box)]
    text = " ".join(text for box, text in frame.boxes if card.contains(box))
    assert all(word in text for part in play.inspector.parts for word in part.text.split())
    assert lines and max(box.bottom for box in lines) <= card.bottom


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("machine", range(MACHINES))
def test_the_cards_of_the_lab_are_whole_at_any_size(machine, size):
    scene = make_scene("lab/joints")
    scene.change("slider:machine", machine)
    scene.change("slider:joints", machine % len(TIERS))
    play = screen(scene, ScriptSource([]), 40 if JIT else 3)
    key(play, pygame.K_p)
    seen = 0
    for frame, _ in cards(play, size):
        assert_card_is_whole(play, frame)
        seen += 1
    assert seen
    play.close()


@pytest.fixture(scope="module")
def flown():
    """Return a lander, played by its bot until it has carried a load on its line for half a second."""
    scene = make_scene("lander")
    session = Session(scene, BotSource())
    while scene.line.load is None:
        session.step()
    for _ in range(30):
        session.step()
    return scene


@pytest.mark.skipif(not JIT, reason="900 steps of the lander")
@pytest.mark.parametrize("size", SIZES)
def test_the_cards_of_the_landers_line_are_whole_at_any_size(flown, size):
    play = screen(flown, ScriptSource([]), 0)
    key(play, pygame.K_p)
    seen = 0
    for frame, identity in cards(play, size):
        assert_card_is_whole(play, frame)
        assert '"line"' in words(frame) and flown.world.joint(identity).kind == "Revolute"
        seen += 1
    assert seen == 2
    play.close()


@pytest.mark.parametrize("tier", TIERS)
def test_the_mark_is_on_the_anchors_and_changes_nothing(tier):
    scene = jointed(tier=tier)
    before = scene_digest(scene)
    frame = Picture(pygame.Surface((1440, 810))).draw_scene(scene, Overlays(()))
    lens = frame.lens(scene.camera)
    bare = pygame.surfarray.array3d(frame.surface)
    rows = anchored(scene.world)
    for row in rows:
        frame = Picture(pygame.Surface((1440, 810))).draw_scene(scene, Overlays(()))
        marks = JointSubject(int(row["joint"])).draw(frame, lens, scene.world)
        pixels = pygame.surfarray.array3d(frame.surface)
        changed = (pixels != bare).any(axis=-1)
        for side in ("a", "b"):
            x, y = (round(each) for each in lens.points(float(row[f"{side}x"]), float(row[f"{side}y"])))
            assert changed[x - 12 : x + 13, y - 12 : y + 13].any(), (row["joint"], side)
            assert any(mark.collidepoint(x, y) for mark in marks), (row["joint"], side)
        force = hypot(float(row["force_x"]), float(row["force_y"]))
        assert 0.0 <= force < inf
    assert scene_digest(scene) == before


def test_every_machine_can_be_asked_in_every_step():
    for machine in range(MACHINES):
        scene = make_scene("lab/joints")
        scene.change("slider:machine", machine)
        inputs = InputState()
        for _ in range(12 if JIT else 2):
            scene.step(inputs)
        for world in scene.worlds:
            for identity in world.joints["id"].tolist():
                assert explain(world, identity)
