"""Broad phases that ask the other three in every update and every query, and compare the results of all four.

Strategies differ only in which pairs they test; a world depends on nothing else of them. Four equal lists in every step
therefore give four equal digests: one run with these strategies replaces one run under each, and names the pair.
"""

import numpy as np

from physics import BROADPHASES
from physics.broadphase.proxies import Arena

NAMED = 5  # pairs or slots that a message names at most


class StrategiesDisagree(AssertionError):
    """A strategy found other pairs or boxes than the one whose results the world uses."""


class AsksAll:
    """Compare the results of a strategy with those of the others on the same proxies. Mixed into the strategy."""

    def fresh(self):
        """Return a copy without state that asks the others too."""
        return asking_all(super().fresh())

    def update(self, arena):
        """Update all four strategies."""
        super().update(arena)
        for other, its in self.others:
            its.proxies, its.changed = arena.proxies, arena.changed
            other.update(its)

    def query(self, arena):
        """Return the query of this strategy; it raises StrategiesDisagree if another finds other pairs."""
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
        """List the slots near a box. Raises StrategiesDisagree if another strategy lists others."""
        count = super().query_box(proxies, box, slots, work)
        wanted = meeting(proxies, box, slots[:count])
        for other, _ in self.others:
            found = np.zeros_like(slots)
            found = meeting(proxies, box, found[: other.query_box(proxies, box, found, np.zeros_like(work))])
            self.compare(f"slots near {box}", other.name, wanted, found, len(found))
        return count

    def compare(self, what, name, wanted, found, number):
        """Raise StrategiesDisagree unless the strategy `name` found what is wanted; number: its count."""
        if number == len(wanted) and np.array_equal(wanted, found):
            return
        more, less = (np.setdiff1d(*each)[:NAMED].tolist() for each in ((found, wanted), (wanted, found)))
        if what == "pairs":
            more, less = ([(key >> 32, key & 0xFFFFFFFF) for key in each] for each in (more, less))
        raise StrategiesDisagree(
            f"{name} finds {number} {what}, {self.name} {len(wanted)}: only {name} {more}, only {self.name} {less}"
        )


def meeting(proxies, box, slots):
    """Return the sorted slots that every strategy must list: those that are up to date, and whose box meets `box`.

    A strategy may list others besides (leaves of the tree are fat, cells are large); queries drop those.
    """
    rows = proxies[slots]
    meets = (rows["lower_x"] <= box[2]) & (rows["upper_x"] >= box[0])
    meets &= (rows["lower_y"] <= box[3]) & (rows["upper_y"] >= box[1])
    return np.sort(slots[meets & (rows["row"] >= 0) & ~rows["changed"]])


def keys_of(pairs):
    """Return one number for each pair of slots, sorted; the order within a pair does not matter."""
    ordered = np.sort(pairs.astype(np.int64), axis=1)
    return np.sort(ordered[:, 0] << 32 | ordered[:, 1])


ASKING = {strategy: type(f"AsksAll{strategy.__name__}", (AsksAll, strategy), {}) for strategy in BROADPHASES.values()}
globals().update({each.__name__: each for each in ASKING.values()})  # copies look their class up by its name


def asking_all(strategy):
    """Return a strategy of the same kind and options, without state, that asks the others too."""
    made = strategy.fresh()
    if not isinstance(made, AsksAll):
        made.__class__ = ASKING[type(made)]
    made.others = [(make(), Arena()) for name, make in BROADPHASES.items() if name != made.name]
    return made


def scene_asking_all(scene_class):
    """Return a subclass of a scene whose worlds ask all broad phases, whichever is chosen."""

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
