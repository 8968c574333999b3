"""Reading an attribute of another engine, or a column as an attribute, names what to write instead."""

import copy
import pickle
import pydoc
import re
from abc import ABC, abstractmethod

import numpy as np
import pytest

from physics import (
    Body,
    Character,
    Circle,
    Distance,
    Drive,
    Effects,
    Joint,
    Polygon,
    Revolute,
    Spring,
    Target,
    Vec2,
    World,
    debug,
    hints,
)
from physics.events import Events

EFFECTS = Effects.rigid_bodies().with_(joints=True)


def made():
    """Return a world after a step, and one object of each class with foreign names."""
    world = World(EFFECTS)
    body = world.add_body(Circle(5), position=(3, 4), user="ball")
    world.add_body(Polygon.box(50, 5), position=(0, 11), kind="static")
    spring, drive = Spring(2.0, 0.5), Drive(1.0, 5.0)
    other = world.add_body(Circle(5), position=(3, -20))
    joint = world.add_joint(Distance(other, body, (3, -20), (3, 4), spring=spring, motor=drive, limits=(1, 90)))
    character = Character(world, Polygon.box(8, 16), (90, -20), user="hero")
    world.step()
    row = world.contacts[0]
    things = {
        "Body": body,
        "Joint": joint,
        "World": world,
        "Events": world.events,
        "Character": character,
        "Record": row,
    }
    return things | {
        "world": world,
        "body": body,
        "joint": joint,
        "events": world.events,
        "character": character,
        "row": row,
    }


THINGS = made()
NAMES = [(kind, name) for kind, names in hints.READ.items() for name in names]
CLASSES = {"Body": Body, "Joint": Joint, "World": World, "Events": Events, "Character": Character}


def test_every_class_with_names_is_tested():
    assert {*hints.READ} == {*CLASSES, "Record"}


@pytest.mark.parametrize("kind, name", NAMES)
def test_reading_a_foreign_name_says_what_to_write(kind, name):
    thing = THINGS[kind]
    with pytest.raises(AttributeError) as caught:
        getattr(thing, name)
    text = str(caught.value)
    assert text == f"{type(thing).__name__} has no attribute {name}: write {hints.READ[kind][name]}"
    assert not hasattr(thing, name) and getattr(thing, name, 7) == 7
    assert not hasattr(type(thing), name)


@pytest.mark.parametrize("kind, name", NAMES)
def test_what_a_hint_says_to_write_can_be_read(kind, name):
    """The expression of a hint is evaluated; in calls the name alone, as their arguments are placeholders."""
    expression = re.split(r"[;,] |,? and |\(", hints.READ[kind][name].replace("moved = ", ""))[0]
    if "row[" not in expression and "world.rows" in hints.READ[kind][name]:
        expression = 'world.bodies["force_x"]'
    things = THINGS | {"joint": THINGS["world"].add_joint(Target(0, (3, 4)))} if name == "target" else THINGS
    assert eval(expression, {"debug": debug, "copy": copy, "Vec2": Vec2}, things) is not None


@pytest.mark.parametrize("kind", CLASSES)
def test_foreign_names_are_in_no_listing(kind):
    names, thing = {*hints.READ[kind]}, THINGS[kind]
    assert not names & {*dir(CLASSES[kind])} and not names & {*dir(thing)}
    text = re.sub(r"[\w.]*\.", "", pydoc.render_doc(CLASSES[kind], renderer=pydoc.plaintext))
    listed = {*re.findall(r"^ \|  (\w+)(?: = |\(|$)", text, re.MULTILINE)}
    assert "world" in listed or kind in ("World", "Events", "Character")
    assert not names & listed
    public = {each for each in dir(thing) if not each.startswith("_")}
    assert public and all(hasattr(thing, each) or kind == "Joint" for each in public)


@pytest.mark.parametrize("kind", CLASSES)
def test_a_name_that_nobody_knows_is_plain(kind):
    with pytest.raises(AttributeError, match=f"'{kind}' object has no attribute 'colour_of_it'"):
        THINGS[kind].colour_of_it  # noqa: B018


@pytest.mark.parametrize("name", ["contacts", "begin", "hits", "quarantined", "broken"])
def test_a_column_read_as_an_attribute_is_shown_as_a_column(name):
    world = made()["world"]
    table = world.contacts if name == "contacts" else getattr(world.events, name)
    row = np.zeros(1, table.dtype)[0]
    for column in table.dtype.names:
        with pytest.raises(AttributeError) as caught:
            getattr(row, column)
        assert str(caught.value) == f'{type(row).__name__} has no attribute {column}: write row["{column}"]'
        assert row[column] == row[column] and not hasattr(row, column)
    with pytest.raises(AttributeError, match=rf"^{type(row).__name__} has no attribute colour$"):
        row.colour  # noqa: B018
    assert copy.deepcopy(row) == row == pickle.loads(pickle.dumps(row)) and repr(row).startswith(type(row).__name__)


def test_setting_a_foreign_name_still_says_what_to_set():
    for kind, name, hint in (("Body", "x", "body.position = (x, y)"), ("World", "fps", "world.dt = 1 / 3")):
        with pytest.raises(AttributeError, match=rf"{kind} has no attribute {name}: write ") as caught:
            setattr(THINGS[kind], name, 3)
        assert hint in str(caught.value)


class Level(World, ABC):
    """A subclass with a second base, and with attributes that have foreign names."""

    space = 12

    def __init__(self):
        super().__init__(EFFECTS)
        self.update = "now"

    @property
    def fps(self):
        """Steps per second."""
        return 1 / self.dt

    @abstractmethod
    def copy(self):
        """Return nothing."""


class First(Level):
    """A level that can be made."""

    def copy(self):
        return 5


def test_a_subclass_may_have_attributes_of_these_names():
    with pytest.raises(TypeError, match="abstract"):
        Level()  # pyright: ignore[reportAbstractUsage]
    level = First()
    assert (level.space, level.update, round(level.fps), level.copy()) == (12, "now", 60, 5)
    assert {"space", "update", "fps", "copy"} <= {*dir(level)} and "damping" not in dir(level)
    with pytest.raises(AttributeError, match="write world.drag"):
        level.damping  # noqa: B018  # pyright: ignore[reportAttributeAccessIssue]
    body = level.add_body(Circle(3))
    assert isinstance(level, World) and isinstance(body, Body) and not isinstance(level, Body)
    assert body in level and body.id in level and np.int64(0) in level and True not in level and "ball" not in level
    hinge = level.add_joint(Revolute(None, body, (0, 0)))
    assert hinge in level and hinge not in THINGS["world"]


def test_these_classes_have_no_getattr():
    """It would make all reading of their attributes slower, as CPython then does not specialize LOAD_ATTR."""
    for kind in (*CLASSES.values(), First):
        assert kind.__getattribute__ is object.__getattribute__ and not hasattr(kind, "__getattr__")
