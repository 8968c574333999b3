"""The body of a Character, removed characters and joints, and functions of debug and warmup with wrong arguments."""

import pytest

from physics import Character, Circle, Effects, Joint, Polygon, World, debug, warmup

EFFECTS = Effects.rigid_bodies().with_(joints=True)


def made():
    """Return a world with a floor, a ball, a character on the floor and a kinematic lift, after two steps."""
    world = World(EFFECTS)
    world.add_body(Polygon.box(400, 20), position=(0, 10), kind="static")
    world.add_body(Circle(5), position=(-60, -5))
    character = Character(world, Polygon.box(8, 16), (50, -8))
    world.add_body(Polygon.box(20, 4), position=(0, -90), kind="kinematic")
    for _ in range(2):
        world.step()
        character.move(0, 1)
    return world, character


PLACED = {
    "position": lambda w, b: setattr(b, "position", (5, -30)),
    "angle": lambda w, b: setattr(b, "angle", 0.5),
    "velocity": lambda w, b: setattr(b, "velocity", (60, 0)),
    "angular_velocity": lambda w, b: setattr(b, "angular_velocity", 1.0),
    "move_to": lambda w, b: b.move_to((5, -30)),
    "set_target": lambda w, b: b.set_target((51, -8)),
    "move": lambda w, b: w.move([1, b], [(-60, -5), (5, -30)]),
}


@pytest.mark.parametrize("call", PLACED.values(), ids=PLACED)
def test_a_characters_body_is_placed_by_the_character_alone(call):
    """Its place was changed only until the next move, which began at the old one."""
    world, character = made()
    before, place = world.digest(), character.position
    with pytest.raises(ValueError, match=r"of body 2 is set by its Character: write character.move_to\(position\)"):
        call(world, character.body)
    assert world.digest() == before and character.position == character.body.position == place
    character.move_to((5, -30))
    moved = character.move(3, 0)
    assert character.position == (8, -30) and moved.x == 3


@pytest.mark.parametrize("call", PLACED.values(), ids=PLACED)
def test_other_kinematic_bodies_are_placed_as_before(call):
    world, _ = made()
    call(world, world.body(3)) if call is not PLACED["set_target"] else world.body(3).set_target((1, -90))
    world.step()
    body = world.body(3)
    assert (body.position, body.angle) != ((0, -90), 0.0)


@pytest.mark.parametrize(
    "name, words",
    [
        ("position", "Character.position cannot be set: write character.move_to((5, 6))"),
        ("x", "Character has no attribute x: write character.move_to((5, 6))"),
        ("velocity", "write character.move(dx, dy)"),
        ("user", "write character.body.user = (5, 6)"),
        ("max_slope", "Character.max_slope cannot be set: write Character(…, max_slope=(5, 6))"),
        ("body", "Character.body cannot be set"),
        ("world", "Character.world cannot be set"),
        ("positoin", "did you mean position?"),
        ("colour", "Character has no attribute colour"),
    ],
)
def test_setting_an_attribute_of_a_character_says_what_to_write(name, words):
    _, character = made()
    with pytest.raises(AttributeError) as caught:
        setattr(character, name, (5, 6))
    assert words in str(caught.value), str(caught.value)
    assert name == "colour" or not hasattr(character, "colour")


class Hero(Character):
    """A subclass with an attribute of its own."""

    def __init__(self, world, place):
        self.coins = 0
        super().__init__(world, Polygon.box(8, 16), place)
        self.life = 3


def test_a_subclass_of_character_may_have_attributes():
    hero = Hero(World(EFFECTS), (0, 0))
    hero.coins, hero.shield = 5, True
    assert (hero.coins, hero.life, hero.shield) == (5, 3, True)
    with pytest.raises(AttributeError, match="cannot be set"):
        hero.position = (0, 0)
    with pytest.raises(AttributeError, match="did you mean position"):
        hero.positoin = (0, 0)


@pytest.mark.parametrize(
    "call",
    [
        lambda c: c.move(1, 0),
        lambda c: c.blocked(1, 0),
        lambda c: c.move_to((0, 0)),
        lambda c: c.max_slope,
        lambda c: c.previous,
        lambda c: c.surface_speed,
    ],
)
@pytest.mark.parametrize("remove", [lambda c: c.remove(), lambda c: c.body.remove()])
def test_a_removed_character_is_named(call, remove):
    _, character = made()
    remove(character)
    with pytest.raises(KeyError) as caught:
        call(character)
    assert str(caught.value) == "character 2 was removed"


@pytest.mark.parametrize("args, words", [((5, 1), "world must be a World"), ((None, "a"), "joint must be a Joint")])
def test_a_joint_of_nothing_is_refused(args, words):
    world = args[0] or World(EFFECTS)
    with pytest.raises(TypeError, match=words):
        Joint(world, args[1])


@pytest.mark.parametrize("value", [None, 5, "world", made()[1], made()[0].body(1), made()[0].bodies])
@pytest.mark.parametrize("name", sorted({*debug.__all__} - {"visited"}))
def test_debug_functions_take_a_world_alone(name, value):
    with pytest.raises(TypeError, match=rf"^world must be a World \(got .*\): write debug.{name}\(world\)$"):
        getattr(debug, name)(value)


@pytest.mark.parametrize(
    "given, error, words",
    [
        ({"effects": "gravity"}, TypeError, "effects must be an Effects (got 'gravity')"),
        ({"effects": 5}, TypeError, "effects must be an Effects (got 5)"),
        ({"broadphase": "quad"}, KeyError, "broadphase must be one of brute, sweep, hash, tree, all (got 'quad')"),
        ({"broadphase": ["hash"]}, KeyError, "got ['hash']"),
        ({"solver": "pgs"}, ValueError, "solver must be one of"),
        ({"progress": 5}, TypeError, "progress must be a function (done, total, name), or None (got 5)"),
        ({"pieces": "masks"}, TypeError, "pieces must be a list of names, or None (got 'masks')"),
        ({"pieces": 5}, TypeError, "pieces must be a list"),
        ({"pieces": ["masks", "sprites"]}, KeyError, "no piece 'sprites'"),
    ],
)
def test_wrong_arguments_of_warmup_are_named(given, error, words):
    with pytest.raises(error) as caught:
        warmup(**{"effects": Effects(), **given})
    assert words in str(caught.value), str(caught.value)
