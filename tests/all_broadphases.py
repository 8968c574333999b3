"""Variants of the four broad phases that also run the other three in every update and query, and compare all results.

A broad phase affects a world only through the pairs it finds. If all four find equal pairs in every step, all four give
equal digests. One run with such a variant therefore replaces four runs, and it names the wrong pair.
"""

import numpy as np

from physics import BROADPHASES
from physics.broadphase.proxies import Arena

NAMED = 5  # pairs or slots that a message names at most


class StrategiesDisagree(AssertionError):
    """Error: another broad phase found other pairs or slots than the broad phase of the world."""


class AsksAll:
    """Mixin for a broad phase that compares its results with those of the other three on the same proxies."""

    def fresh(self):
        """Return a copy without state that also compares itself with the others."""
        return asking_all(super().fresh())

    def update(self, arena):
        """Update all four strategies."""
        super().update(arena)
        for other, its in self.others:
            its.proxies, its.changed = arena.proxies, arena.changed
            other.update(its)

    def query(self, arena):
        """Return the query function of this broad phase; it raises StrategiesDisagree if
        another one finds other pairs.
        """
        ask = super().query(arena)

        def ask_all(pairs, work):
            count = ask(pairs, work)
            if count <= len(pairs):  # else it is asked again, with room
                wanted = keys_of(pairs[:count])
                for other, its in self.others:
                    number = its.collect(other.query(its))
                    self.compare("pairs", other.name, wanted, keys_of(its.pairs[:number]), number)
            return count

        return ask_all

    def query_box(self, proxies, box, slots, work):
        """Write the slots near a box to `slots` and return their number.

        Raises StrategiesDisagree if another broad phase finds other slots.
        """
        count = super().query_box(proxies, box, slots, work)
        wanted = meeting(proxies, box, slots[:count])
        for other, _ in self.others:
            found = np.zeros_like(slots)
            found = meeting(proxies, box, found[: other.query_box(proxies, box, found, np.zeros_like(work))])
            self.compare(f"slots near {box}", other.name, wanted, found, len(found))
        return count

    def compare(self, what, name, wanted, found, number):
        """Raise StrategiesDisagree unless `found` equals `wanted`.

        what: kind of result, for the message. name: broad phase that found `found`. number: how many results it
        reported.
        """
        if number == len(wanted) and np.array_equal(wanted, found):
            return
        more, less = (np.setdiff1d(*each)[:NAMED].tolist() for each in ((found, wanted), (wanted, found)))
        if what == "pairs":
            more, less = ([(key >> 32, key & 0xFFFFFFFF) for key in each] for each in (more, less))
        raise StrategiesDisagree(
            f"{name} finds {number} {what}, {self.name} {len(wanted)}: only {name} {more}, only {self.name} {less}"
        )


def meeting(proxies, box, slots):
    """Return the slots that every broad phase must find, sorted: those whose box is up to date and overlaps `box`.

    A broad phase may report more slots, because leaves of the tree are enlarged and cells are large. They are ignored
    here, as queries ignore them.
    """
    rows = proxies[slots]
    meets = (rows["lower_x"] <= box[2]) & (rows["upper_x"] >= box[0])
    meets &= (rows["lower_y"] <= box[3]) & (rows["upper_y"] >= box[1])
    return np.sort(slots[meets & (rows["row"] >= 0) & ~rows["changed"]])


def keys_of(pairs):
    """Return one integer for each pair of slots, sorted; the order of the slots in a pair does not matter."""
    ordered = np.sort(pairs.astype(np.int64), axis=1)
    return np.sort(ordered[:, 0] << 32 | ordered[:, 1])


ASKING = {strategy: type(f"AsksAll{strategy.__name__}", (AsksAll, strategy), {}) for strategy in BROADPHASES.values()}
globals().update({each.__name__: each for each in ASKING.values()})  # copies look their class up by its name


def asking_all(strategy):
    """Return a broad phase of the same kind and options, without state, that compares itself with the others."""
    made = strategy.fresh()
    if not isinstance(made, AsksAll):
        made.__class__ = ASKING[type(made)]
    made.others = [(make(), Arena()) for name, make in BROADPHASES.items() if name != made.name]
    return made


def scene_asking_all(scene_class):
    """Return a subclass of a scene whose worlds compare all broad phases, whichever one is selected."""

    class Asking(scene_class):
        def add_world(self, *arguments, **settings):
            world = super().add_world(*arguments, **settings)
            world.broadphase = asking_all(world.broadphase)
            return world

        def set_broadphase(self, name):
            super().set_broadphase(name)
            for world in self.worlds:
                world.broadphase = asking_all(world.broadphase)

    Asking.__name__, Asking.__doc__ = scene_class.__name__, scene_class.__doc__
    return Asking
