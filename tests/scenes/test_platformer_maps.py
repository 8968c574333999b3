"""Levels with a mistake give an error with file, position and reason; correct ones work: copied, changed or minimal."""

import json
import os

import pytest

from game.errors import FileError
from game.places import LEVELS
from game.run.session import Session
from game.run.sources import IdleSource
from scenes.platformer.level import level_of
from scenes.platformer.level_rules import HINTS, KINDS
from scenes.platformer.runner import Runner
from scenes.platformer.scene import Platformer

OWN = json.loads((LEVELS / "platformer.tmj").read_text(encoding="utf-8"))


def small():
    """Return a level of 30 x 17 tiles with a floor, a start, a goal and one walking enemy."""
    row = [0] * 30
    solid = row * 15 + [1] * 30 + [1] * 30
    objects = [
        {"id": 1, "type": "hero_start", "x": 32, "y": 220, "width": 10, "height": 20},
        {"id": 2, "type": "goal", "x": 400, "y": 192, "width": 32, "height": 48},
        {
            "id": 3,
            "type": "walker",
            "x": 200,
            "y": 224,
            "width": 20,
            "height": 16,
            "properties": [{"name": "range", "type": "int", "value": 32}],
        },
    ]
    return {
        "type": "map",
        "orientation": "orthogonal",
        "infinite": False,
        "width": 30,
        "height": 17,
        "tilewidth": 16,
        "tileheight": 16,
        "tilesets": [dict(OWN["tilesets"][0])],
        "layers": [
            {"type": "tilelayer", "name": "solid", "data": solid},
            {"type": "objectgroup", "name": "things", "objects": objects},
        ],
    }


def save(folder, level):
    path = folder / "mine.tmj"
    path.write_text(json.dumps(level), encoding="utf-8")
    return path


def objects(level):
    return level["layers"][1]["objects"]


def test_a_small_map_is_played_from_any_folder(tmp_path):
    scene = Platformer(level=str(save(tmp_path, small())))
    session = Session(scene, IdleSource())
    for _ in range(30):
        session.step()
    assert scene.hero.grounded and len(scene.things.enemies) == 1 and scene.things.coins_in_all == 0
    names = [goal.name for goal in scene.check()]
    assert "ladder" not in names and "all secrets" not in names and "reached the goal" in names


def test_a_changed_map_is_read_anew(tmp_path):
    path = save(tmp_path, small())
    first = level_of(path)
    assert level_of(str(path)) is first
    changed = small()
    objects(changed).append({"id": 4, "type": "coin", "x": 64, "y": 200, "width": 14, "height": 14})
    save(tmp_path, changed)
    os.utime(path, ns=(1, 1))
    assert len(level_of(path).map.things_of("coin")) == 1


def test_another_level_is_another_scene(tmp_path):
    assert Platformer(level=str(save(tmp_path, small()))).level is not Platformer().level


def change(index, **values):
    return lambda level: objects(level)[index].update(values)


def give(index, name, value):
    return lambda level: objects(level)[index].update(properties=[{"name": name, "value": value}])


def add(**values):
    return lambda level: objects(level).append({"id": 9, "x": 64, "y": 64, "width": 16, "height": 16} | values)


MISTAKES = [
    (lambda level: objects(level).pop(0), "objects", "exactly 1 hero_start, this one has 0"),
    (lambda level: objects(level).append(dict(objects(level)[1])), "objects", "exactly 1 goal, this one has 2"),
    (change(2, type="wlaker"), "layers[1].objects[2]", "unknown type 'wlaker'"),
    (change(2, type=""), "layers[1].objects[2]", "unknown type ''"),
    (lambda level: objects(level)[2].pop("properties"), "layers[1].objects[2] (walker)", "needs the property 'range'"),
    (give(2, "range", "far"), "objects[2] (walker).range", "must be a number"),
    (give(2, "range", -1), "objects[2] (walker).range", "must be a number 0.."),
    (give(2, "range", True), "objects[2] (walker).range", "must be a number"),
    (change(1, x=4000), "layers[1].objects[1] (goal)", "is outside the map"),
    (change(0, y=-40), "layers[1].objects[0] (hero_start)", "is outside the map"),
    (change(1, width=0), "layers[1].objects[1] (goal)", "must have a size"),
    (change(0, y=244), "layers[1].objects[0]", "inside the solid tile at column 2 row 16"),
    (lambda level: level.update(width=29), "layers[0].data", "must hold 493 tiles"),
    (lambda level: level["layers"].pop(0), "layers", "no tile layer 'solid'"),
    (lambda level: level["layers"][0].update(name="walls"), "layers", "no tile layer 'solid'; there are walls"),
    (lambda level: level["layers"][0]["data"].__setitem__(7, 9999), "layers[0].data[7]", "is not in the tileset"),
    (
        lambda level: [each.update(tilewidth=32, tileheight=32) for each in (level, *level["tilesets"])],
        "tilewidth",
        "must be 16",
    ),
    (
        lambda level: level["tilesets"][0].update(image="none.png"),
        "tilesets[0].image",
        "there is no picture 'none.png'",
    ),
    (lambda level: level["tilesets"][0].update(image="../images/ui.png", columns=64), "tilesets[0].image", "too small"),
    (add(type="sign"), "(sign)", "needs the property 'text'"),
    (
        add(type="platform", properties=[{"name": "to_x", "value": 9}, {"name": "to_y", "value": 9}]),
        "(platform)",
        "'period'",
    ),
    (
        add(
            type="platform",
            properties=[{"name": "to_x", "value": 9}, {"name": "to_y", "value": 9}, {"name": "period", "value": 0}],
        ),
        "(platform).period",
        "must be a number 0.5..120",
    ),
    (add(type="belt"), "(belt)", "needs the property 'speed'"),
    (
        add(type="zone", properties=[{"name": "act", "value": "beach"}]),
        "(zone).act",
        "must be one of meadow, cave, keep",
    ),
    (
        add(type="hint", properties=[{"name": "order", "value": 1}, {"name": "act", "value": "swim"}]),
        "(hint).act",
        "must be one of",
    ),
]


@pytest.mark.parametrize("spoil, place, reason", MISTAKES)
def test_a_mistake_is_named_by_file_place_and_reason(tmp_path, spoil, place, reason):
    level = small()
    spoil(level)
    with pytest.raises(FileError) as caught:
        Platformer(level=str(save(tmp_path, level)))
    message = str(caught.value)
    assert "mine.tmj" in message and place in message and reason in message, message


def test_a_map_that_is_too_small_or_too_large_is_refused(tmp_path):
    level = small() | {"width": 10}
    level["layers"][0]["data"] = level["layers"][0]["data"][: 10 * 17]
    with pytest.raises(FileError, match="must be 30..1024 tiles"):
        Platformer(level=str(save(tmp_path, level)))


@pytest.mark.parametrize("text", ["", "[]", "{", '{"width": 3}'])
def test_what_is_no_map_at_all(tmp_path, text):
    path = tmp_path / "mine.tmj"
    path.write_text(text)
    with pytest.raises(FileError, match="mine.tmj"):
        Platformer(level=str(path))
    with pytest.raises(FileError, match="No such file"):
        Platformer(level=str(tmp_path / "none.tmj"))


def test_the_bot_knows_every_act_and_the_level_every_kind():
    assert all(hasattr(Runner, f"_{act}") for act in HINTS)
    used = {thing["type"] for layer in OWN["layers"] if layer["type"] == "objectgroup" for thing in layer["objects"]}
    assert used == set(KINDS)
