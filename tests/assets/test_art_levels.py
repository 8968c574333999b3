"""The level is valid Tiled JSON of sufficient size, with known tiles and objects and checked text."""

import json

import pytest

from assets import FOLDER
from assets.craft import png
from assets.platformer.decoration import TILE
from assets.platformer.level_text import Map
from assets.platformer.level_things import walking_range
from assets.platformer.level_tiles import cover_names

KINDS = {"solid", "one_way", "slope", "spikes", "decor"}
TYPES = {
    "hero_start",
    "blast_wall",
    "bridge",
    "bomb",
    "coin",
    "secret",
    "spring",
    "crate",
    "walker",
    "hedgehog",
    "bat",
    "platform",
    "belt",
    "crumble",
    "ladder",
    "spikes",
    "goal",
    "sign",
    "checkpoint",
    "zone",
    "cover",
}
SOLID, THINGS, HINTS = 2, 4, 5  # which layers hold objects


@pytest.fixture(scope="module")
def tmj():
    return json.loads((FOLDER / "levels" / "platformer.tmj").read_text(encoding="utf-8"))


def things(tmj, kind):
    return [thing for thing in tmj["layers"][THINGS]["objects"] if thing["type"] == kind]


def properties(entry):
    return {row["name"]: row["value"] for row in entry["properties"]}


def kind_at(tmj, x, y):
    gid = tmj["layers"][SOLID]["data"][y * tmj["width"] + x]
    return properties(tmj["tilesets"][0]["tiles"][gid - 1])["kind"] if gid else None


def test_level_is_large_and_every_gid_exists(tmj):
    assert tmj["width"] >= 240 and tmj["height"] >= 40
    assert [layer["name"] for layer in tmj["layers"]] == ["wall", "decor", "solid", "cover", "things", "bot hints"]
    count = tmj["tilesets"][0]["tilecount"]
    for layer in tmj["layers"][:THINGS]:
        assert len(layer["data"]) == tmj["width"] * tmj["height"]
        assert all(0 <= gid <= count for gid in layer["data"])


def test_tileset_fits_its_picture_and_names_its_kinds(tmj):
    tileset = tmj["tilesets"][0]
    picture = png.decode((FOLDER / "levels" / tileset["image"]).read_bytes())
    assert picture.shape[:2] == (tileset["imageheight"], tileset["imagewidth"])
    sheet = json.loads((FOLDER / "images" / "tiles.json").read_text(encoding="utf-8"))["frames"]
    assert len(tileset["tiles"]) == tileset["tilecount"] == len(sheet)
    for tile in tileset["tiles"]:
        values = properties(tile)
        place = sheet[values["name"]]
        row, column = divmod(tile["id"], tileset["columns"])
        assert (place["x"], place["y"]) == (column * TILE, row * TILE)
        assert values["kind"] in KINDS
        if values["kind"] == "slope":
            assert {values["left"], values["right"]} in ({0.0, 1.0}, {0.0, 0.5}, {0.5, 1.0})


def test_level_uses_every_kind_of_ground(tmj):
    tiles = tmj["tilesets"][0]["tiles"]
    used = {properties(tiles[gid - 1])["name"] for gid in tmj["layers"][SOLID]["data"] if gid}
    assert {"slope_down", "slope_up_low", "slope_up_high", "ladder_top"} <= used
    assert all(any(name.startswith(kind) for name in used) for kind in ("plank_", "stone_", "ground_", "rock_"))


def test_objects_are_known_and_inside(tmj):
    assert {thing["type"] for thing in tmj["layers"][THINGS]["objects"]} == TYPES
    ids = [thing["id"] for layer in tmj["layers"][THINGS:] for thing in layer["objects"]]
    assert len(set(ids)) == len(ids) and max(ids) < tmj["nextobjectid"]
    for thing in tmj["layers"][THINGS]["objects"]:
        assert 0 <= thing["x"] and thing["x"] + thing["width"] <= tmj["width"] * TILE
        assert 0 <= thing["y"] and thing["y"] + thing["height"] <= tmj["height"] * TILE
    assert len(things(tmj, "hero_start")) == 1 and len(things(tmj, "goal")) == 1
    assert (
        len(things(tmj, "coin")) >= 60 and len(things(tmj, "secret")) == 4 and 6 <= len(things(tmj, "checkpoint")) <= 9
    )


def decks(tmj):
    """Return (left, top, right) [px] of the platforms, crates and belts, which the character can stand on besides
    tiles.
    """
    return [
        (thing["x"], thing["y"], thing["x"] + thing["width"])
        for kind in ("platform", "crate", "belt")
        for thing in things(tmj, kind)
    ]


@pytest.mark.parametrize("kind", ["hero_start", "spring", "walker", "hedgehog", "crate", "goal", "checkpoint"])
def test_what_stands_has_ground_under_it(tmj, kind):
    for thing in things(tmj, kind):
        bottom = thing["y"] + thing["height"]
        assert bottom % TILE == 0
        middle = int(thing["x"] + thing["width"] / 2)
        carried = any(top == bottom and left <= middle < right for left, top, right in decks(tmj))
        assert carried or kind_at(tmj, middle // TILE, bottom // TILE) == "solid", (
            f"{kind} {thing['id']} hangs in the air"
        )
        assert kind_at(tmj, middle // TILE, bottom // TILE - 1) is None, f"{kind} {thing['id']} is in the ground"


def test_bats_hang_from_a_ceiling_and_ladders_lead_from_a_floor_to_a_plank(tmj):
    for bat in things(tmj, "bat"):
        assert kind_at(tmj, (bat["x"] + 10) // TILE, bat["y"] // TILE - 1) == "solid"
    for ladder in things(tmj, "ladder"):
        column, top = ladder["x"] // TILE, ladder["y"] // TILE
        assert kind_at(tmj, column, top) == "one_way"
        assert kind_at(tmj, column, top + ladder["height"] // TILE) == "solid"


def test_every_coin_and_gem_is_in_the_open(tmj):
    for kind in ("coin", "secret"):
        for thing in things(tmj, kind):
            assert kind_at(tmj, (thing["x"] + 7) // TILE, (thing["y"] + 7) // TILE) != "solid", thing


def test_platforms_dock_flush_and_walkers_have_room(tmj):
    for platform in things(tmj, "platform"):
        values = properties(platform)
        assert values["period"] > 0
        start, end = (platform["x"], platform["y"]), (values["to_x"], values["to_y"])
        docks = [
            "solid"
            in (kind_at(tmj, x // TILE - 1, y // TILE), kind_at(tmj, (x + platform["width"]) // TILE, y // TILE))
            for x, y in (start, end)
        ]
        assert docks == [True, True]
    for kind in ("walker", "hedgehog"):
        assert all(properties(walker)["range"] >= TILE for walker in things(tmj, kind))
    assert all(properties(sign)["text"] for sign in things(tmj, "sign"))


def test_each_secret_is_under_a_cover_that_looks_like_solid_ground_or_behind_a_wall_to_be_blown(tmj):
    covers = things(tmj, "cover")
    cells = tmj["layers"][3]["data"]
    (wall,) = things(tmj, "blast_wall")
    *covered, walled = sorted(things(tmj, "secret"), key=lambda gem: 0 < wall["x"] - gem["x"] < 8 * TILE)
    assert wall["y"] < walled["y"] < wall["y"] + wall["height"]
    for gem in covered:
        assert any(
            c["x"] <= gem["x"]
            and gem["x"] + gem["width"] <= c["x"] + c["width"]
            and c["y"] <= gem["y"] <= c["y"] + c["height"]
            for c in covers
        )
        assert cells[(gem["y"] + 7) // TILE * tmj["width"] + (gem["x"] + 7) // TILE]


def test_the_hints_lead_from_the_start_to_the_goal_by_all_secrets(tmj):
    hints = tmj["layers"][HINTS]["objects"]
    assert [properties(hint)["order"] for hint in hints] == list(range(len(hints)))
    (goal,) = things(tmj, "goal")
    assert abs(hints[-1]["x"] - goal["x"]) < 3 * TILE
    for gem in things(tmj, "secret"):
        assert any(abs(hint["x"] - gem["x"]) < 3 * TILE and abs(hint["y"] - gem["y"]) < 4 * TILE for hint in hints)


def test_level_text_is_checked():
    with pytest.raises(ValueError, match="row 2 has 2 tiles"):
        Map("[map]\n...\n..\n", "x.txt")
    with pytest.raises(ValueError, match=r"1 'P' on the map, 0 in \[platforms\]"):
        Map("[map]\nP\n", "x.txt")
    with pytest.raises(ValueError, match="x y seconds width"):
        Map("[map]\nP\n[platforms]\n3 four 5 3\n", "x.txt")
    with pytest.raises(ValueError, match="a zone is one of meadow, cave, keep"):
        Map("[map]\n..\n[zones]\nbeach 0 0 9 9\n", "x.txt")
    with pytest.raises(ValueError, match="a cover is"):
        Map("[map]\n..\n[covers]\n1 2 3\n", "x.txt")
    with pytest.raises(ValueError, match="a hint is"):
        Map("[map]\n..\n[hints]\n1 up\n", "x.txt")
    with pytest.raises(ValueError, match="before the first"):
        Map("...\n", "x.txt")


def test_walkers_stop_before_edges_and_walls():
    level = Map("[map]\n........\n..w....#\n########\n", "x.txt")
    assert walking_range(level, 2, 1) == 2 * TILE  # outside the map counts as ground
    level = Map("[map]\n#..w....\n####.###\n", "x.txt")
    assert walking_range(level, 3, 0) == 0


def test_a_walker_on_a_deck_stays_on_it_and_one_beside_does_not_step_onto_it():
    level = Map("[map]\n..w........\n###P...####\n[platforms]\n0 3 4.0 4\n", "x.txt")
    assert walking_range(level, 2, 0) == 0
    level = Map("[map]\n....w......\n###P...####\n[platforms]\n0 3 4.0 4\n", "x.txt")
    assert walking_range(level, 4, 0) == TILE


def test_a_cover_is_the_ground_that_would_be_there():
    level = Map("[map]\n#####\n#...#\n#####\n#####\n[covers]\n1 1 3 1\n", "x.txt")
    names = cover_names(level)
    assert {(1, 1), (2, 1), (3, 1)} <= names.keys() and all(name.startswith("ground_") for name in names.values())
    assert cover_names(Map("[map]\n#.#\n", "x.txt")) == {}
