"""Gallery pages about loads: crooked columns, mass ratios, cards, a load that is removed.

In all functions, `side` is a Side: one of the page's two worlds while it runs.
"""

from math import cos, radians, sin

import numpy as np

from physics import Effects, Material, Polygon
from scenes.lab.gallery.page import KEPT, LAST, METER, MM, SOFT, Page, Way, auto, dynamic, floor
from scenes.lab.piles import deepest

PILE = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True)
ALIGNED = PILE.with_(friction=False)  # one above the other, without sliding
FOUR = Way("four substeps", {"substeps": 4})
AUTO = Way('substeps="auto"', {"substeps": "auto"})
FORCES_KEPT = Way("forces kept", auto(5).world)
FORCES_FORGOTTEN = Way("forces forgotten", FORCES_KEPT.world)
CRATE = Polygon.box(METER, METER)
CRATES, ASKEW = 80, 0.02 * METER
HUGE = 16.0 * METER
TINY = 0.5 * METER
GONE = 180  # step before which the load is removed
LEAN = radians(25.0)
CARD = (0.02 * METER, 1.0 * METER)  # half thickness and half height


def build_column(side):
    """Build a column of 80 crates, each shifted sideways at random by up to 2 cm.

    side: one of the page's two worlds (page.Side).
    """
    floor(side.world)
    aside = np.random.default_rng(1).uniform(-ASKEW, ASKEW, CRATES)
    side.world.add_bodies(CRATE, np.column_stack([aside, -(np.arange(CRATES) + 0.5) * METER]))
    side.kept["x"] = dynamic(side.world)["x"].copy()


def sway(side):
    """Return the greatest horizontal distance of a body from its starting position [mm].

    side: one of the page's two worlds (page.Side).
    """
    return MM * float(np.abs(dynamic(side.world)["x"] - side.kept["x"]).max())


def build_heavy(side):
    """Build a crate, and on top of it a crate of a thousand times its mass.

    side: one of the page's two worlds (page.Side).
    """
    floor(side.world)
    side.world.add_body(CRATE, position=(0.0, -0.5 * METER))
    side.world.add_body(CRATE, position=(0.0, -1.5 * METER), material=Material(density=1000.0))


def build_huge(side):
    """Build a large crate of 16 m, which stands on two crates of half a metre and carries a third one.

    side: one of the page's two worlds (page.Side).
    """
    floor(side.world)
    tiny, top = Polygon.box(TINY, TINY), -TINY - HUGE
    for x in (-0.4 * HUGE, 0.4 * HUGE):
        side.world.add_body(tiny, position=(x, -0.5 * TINY))
    side.kept["load"] = side.world.add_body(Polygon.box(HUGE, HUGE), position=(0.0, -TINY - HUGE / 2))
    side.kept["y"] = -TINY - HUGE / 2
    side.world.add_body(tiny, position=(0.0, top - 0.5 * TINY))


def sunk(side):
    """Return how far the large crate is from the height at which it would rest if crates were rigid [mm].

    side: one of the page's two worlds (page.Side).
    """
    return MM * abs(side.kept["load"].position[1] - side.kept["y"])


def overlap(side):
    """Return the depth of the deepest contact in the world [mm]; 0 without overlap.

    side: one of the page's two worlds (page.Side).
    """
    return MM * deepest(side.world)


def build_leaning(side):
    """Build a tower of ten crates, each shifted by 8 cm to the right of the one below it.

    With a shift of 10 cm the tower would fall. side: one of the page's two worlds (page.Side).
    """
    floor(side.world)
    rows = np.arange(10)
    side.world.add_bodies(CRATE, np.column_stack([0.08 * METER * rows, -(rows + 0.5) * METER]))
    side.kept["x"] = dynamic(side.world)["x"].copy()


def build_struck(side):
    """Build a pyramid of ten rows without its top, and above it a crate of 300 times the mass.

    The heavy crate falls three metres onto the pyramid. side: one of the page's two worlds (page.Side).
    """
    floor(side.world)
    places = [
        ((column - (9 - row) / 2) * 1.01 * METER, -(row + 0.5) * METER)
        for row in range(9)
        for column in range(10 - row)
    ]
    side.world.add_bodies(CRATE, places)
    side.world.add_body(CRATE, position=(0.0, -12.5 * METER), material=Material(density=300.0))


def build_load(side):
    """Build a column of two crates, with a load on top: a crate of a thousand times their mass.

    side: one of the page's two worlds (page.Side).
    """
    floor(side.world)
    side.world.add_body(CRATE, position=(0.0, -0.5 * METER))
    side.kept["top"] = side.world.add_body(CRATE, position=(0.0, -1.5 * METER))
    side.kept["load"] = side.world.add_body(CRATE, position=(0.0, -2.5 * METER), material=Material(density=1000.0))


def take_away(side):
    """Remove the load before step GONE. side: one of the page's two worlds (page.Side).

    A side with the Way FORCES_KEPT does not remove the load but sets its x to a far position. In this way, the other
    contacts keep their impulses of the last step.
    """
    if side.steps != GONE:
        return
    load = side.kept["load"]
    if side.way is FORCES_KEPT:
        side.world.bodies["x"][side.world.rows([load.id])] = 100.0 * METER
        side.world.touch([load.id])
    else:
        side.world.remove_body(load)


def rise(side):
    """Return the height by which the upper crate has risen since the load was removed [mm].

    It is 0 before that. side: one of the page's two worlds (page.Side).
    """
    return MM * max(0.0, -1.5 * METER - side.kept["top"].position[1]) if side.steps > GONE else 0.0


def build_cards(side):
    """Build a house of cards with four storeys. A card is 4 cm x 2 m.

    Two cards that lean on each other, at 25 degrees, make a pair. One card lies across every two neighbouring pairs.
    side: one of the page's two worlds (page.Side).
    """
    floor(side.world, material=Material(friction=0.7))
    thick, high = CARD
    reach, up = thick * cos(LEAN) + high * sin(LEAN), high * cos(LEAN) + thick * sin(LEAN)
    card, lying = Polygon.box(2 * thick, 2 * high), Polygon.box(1.78 * METER, 2 * thick)
    apart, left, foot = 1.8 * METER, -2.7 * METER, 0.0
    options = {"material": Material(friction=0.7)}
    for pairs in range(4, 0, -1):
        for k in range(pairs):
            x = left + apart * k
            side.world.add_body(card, position=(x - reach, -foot - up), angle=LEAN, **options)
            side.world.add_body(card, position=(x + reach, -foot - up), angle=-LEAN, **options)
        top = foot + 2 * up
        for k in range(pairs - 1):
            side.world.add_body(lying, position=(left + apart * (k + 0.5), -top - thick), **options)
        foot, left = top + 2 * thick, left + apart / 2
    side.kept["x"] = dynamic(side.world)["x"].copy()


PAGES = (
    Page(
        "column",
        "80 crates, 2 cm askew",
        "Left the column buckles and falls; right it stands as it was set up.",
        "A contact is a spring; eighty in a row buckle unless substeps make them stiff enough for their load.",
        FOUR,
        AUTO,
        PILE,
        build_column,
        sway,
        "mm sideways",
        30.0,
        600,
        (0.0, -41.0 * METER, 118.0 * METER),
    ),
    Page(
        "heavy",
        "1000 : 1 on one crate",
        "Left the crate below is squashed; right it bears a thousand of its kind.",
        "A contact sags by F / (m w^2), and m is the lower crate's: a higher w, more substeps, is what helps.",
        FOUR,
        auto(6),
        ALIGNED,
        build_heavy,
        overlap,
        "mm overlap",
        6.0,
        300,
        (0.0, -1.0 * METER, 7.0 * METER),
        judged=LAST,
    ),
    Page(
        "huge",
        "Tiny under huge, tiny on huge",
        "A crate of 16 m stands on two of half a metre: left it crushes them.",
        "512 : 1 on each. What the last step bore says how many substeps this island takes, and no other.",
        FOUR,
        auto(6),
        PILE,
        build_huge,
        sunk,
        "mm sunk",
        6.0,
        300,
        (0.0, -8.0 * METER, 27.0 * METER),
        judged=LAST,
    ),
    Page(
        "cards",
        "A house of cards",
        "Left the house slumps to the side; right it stands nearly as it was built.",
        "26 cards of 4 cm bear each other by friction alone; a contact that gives lets each of them lean.",
        FOUR,
        AUTO,
        PILE,
        build_cards,
        sway,
        "mm sideways",
        20.0,
        600,
        (0.0, -4.0 * METER, 14.0 * METER),
        judged=LAST,
    ),
    Page(
        "unloaded",
        "A load is taken away",
        "A thousand times its mass lay on the upper crate: left it jumps when that is gone.",
        "Contacts start from the forces of the step before; what bore a heavy load that is gone starts from none.",
        FORCES_KEPT,
        FORCES_FORGOTTEN,
        ALIGNED,
        build_load,
        rise,
        "mm up",
        5.0,
        300,
        (0.0, -1.5 * METER, 8.0 * METER),
        act=take_away,
    ),
    Page(
        "leaning",
        "A leaning tower",
        "Each crate is 8 cm further out; 10 cm is the limit. Left the tower falls.",
        "One edge of each crate bears nearly all: where that gives, the tower leans further, and it gives the more.",
        KEPT,
        SOFT,
        PILE,
        build_leaning,
        sway,
        "mm sideways",
        10.0,
        240,
        (0.5 * METER, -5.0 * METER, 17.0 * METER),
    ),
    Page(
        "struck",
        "300 : 1 falls on a pyramid",
        "A crate of 300 times the mass falls three metres: left it ploughs the pyramid.",
        "The blow passes through nine rows within a step or two; the island takes 32 substeps until it is quiet.",
        KEPT,
        auto(5),
        PILE,
        build_struck,
        overlap,
        "mm overlap",
        5.0,
        240,
        (0.0, -5.5 * METER, 17.0 * METER),
        judged=LAST,
    ),
)
