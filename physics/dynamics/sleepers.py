"""What sleeps: islands with the contacts that they keep, and the pairs that touch among what stands."""

from typing import NamedTuple

import numpy as np

from physics.tables.contact import EVENT
from physics.tables.manifold import MANIFOLD
from physics.tables.rows import joined
from physics.tables.world_tables import WorldTables


class Island(NamedTuple):
    """What sleeps together, and what it keeps."""

    bodies: np.ndarray  # ids
    manifolds: np.ndarray
    anchors: np.ndarray
    touching: np.ndarray  # EVENT rows: its pairs that touch


class Sleepers:
    """The sleeping islands of a world, by the lowest id of their bodies; and the pairs that touch among what stands."""

    def __init__(self) -> None:
        self.islands = {}
        self.links = {}  # id of a body that is in none of them, or in another -> islands with a manifold that names it
        self.touching = np.zeros(0, EVENT)  # pairs of which neither side is awake, nor asleep in an island
        self.sensing = np.zeros(0, EVENT)

    def put(self, key: int, island: Island) -> None:
        """Keep an island."""
        self.islands[key] = island
        self._link(self._named(island), [key])

    def put_many(self, keys: list[int], islands: list[Island], named: list[int], owners: list[int]) -> None:
        """Keep many islands; named, owners: ids that manifolds name and that are none of their island's bodies, and the
        island of each."""
        self.islands.update(zip(keys, islands, strict=True))
        for identity, key in set(zip(named, owners, strict=True)):
            self._link([identity], [key])

    def _link(self, named, keys):
        for identity in named:
            self.links.setdefault(identity, set()).update(keys)

    def take(self, key: int) -> Island:
        """Give an island back."""
        island = self.islands.pop(key)
        for identity in self._named(island):
            keys = self.links[identity]
            keys.discard(key)
            if not keys:
                del self.links[identity]
        return island

    @staticmethod
    def _named(island) -> list:
        """Ids that the manifolds of an island name, and that are none of its bodies."""
        named = np.union1d(island.manifolds["body_a"], island.manifolds["body_b"])
        return np.setdiff1d(named, island.bodies).tolist()

    def take_naming(self, identity: int) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """The (manifolds, anchors, touching) of other islands that name a body, taken out of them."""
        found = []
        for key in sorted(self.links.get(identity, ())):
            island = self.take(key)
            m, t = island.manifolds, island.touching
            goes = (m["body_a"] == identity) | (m["body_b"] == identity)
            told = (t["body_a"] == identity) | (t["body_b"] == identity)
            found.append((m[goes], island.anchors[goes], t[told]))
            self.put(key, Island(island.bodies, m[~goes], island.anchors[~goes], t[~told]))
        return found

    def keep_touching(self, rows: np.ndarray, parked: np.ndarray, keys: np.ndarray) -> None:
        """Give islands that have just been put aside the pairs of theirs that touch, EVENT rows."""
        place = np.searchsorted(parked["shape_a"] << 32 | parked["shape_b"], rows["shape_a"] << 32 | rows["shape_b"])
        owners = keys[place]
        order = np.argsort(owners, kind="stable")
        names, starts = np.unique(owners[order], return_index=True)
        for key, part in zip(names.tolist(), np.split(rows[order], starts[1:]), strict=True):
            self.islands[key] = self.islands[key]._replace(touching=part)

    def naming(self, identity: int, own: int) -> np.ndarray:
        """MANIFOLD rows that sleep and name a body; own: its island, if it sleeps in one."""
        parts = [np.zeros(0, MANIFOLD)]
        for key in sorted({own, *self.links.get(identity, ())} & self.islands.keys()):
            m = self.islands[key].manifolds
            parts.append(m[(m["body_a"] == identity) | (m["body_b"] == identity)])
        return in_order(joined(parts))

    def manifolds(self) -> np.ndarray:
        """MANIFOLD rows of all islands in the order of shape ids."""
        return in_order(joined([np.zeros(0, MANIFOLD), *(each.manifolds for each in self.islands.values())]))

    def keep_told(self, tables: WorldTables) -> None:
        """Put the pairs aside that touch, or are sensed, and of which neither side is in the step any longer."""
        self.touching = np.concatenate([self.touching, tables.touching.take_resting(tables.bodies)])
        self.sensing = np.concatenate([self.sensing, tables.sensing.take_resting(tables.bodies)])

    def return_all(self, tables: WorldTables) -> None:
        """Bring all pairs that stand aside back into the step."""
        for name in ("touching", "sensing"):
            getattr(tables, name).give_back(getattr(self, name))
            setattr(self, name, np.zeros(0, EVENT))

    def return_told(self, tables: WorldTables, ids: np.ndarray) -> None:
        """Bring the pairs that name one of these bodies back into the step."""
        for name in ("touching", "sensing"):
            kept = getattr(self, name)
            if len(kept):
                back = np.isin(kept["body_a"], ids) | np.isin(kept["body_b"], ids)
                getattr(tables, name).give_back(kept[back])
                setattr(self, name, kept[~back])


def order_of(manifolds: np.ndarray) -> np.ndarray:
    """The order of shape ids; the manifolds of a pair keep theirs."""
    return np.lexsort((np.arange(len(manifolds)), manifolds["shape_b"], manifolds["shape_a"]))


def in_order(manifolds: np.ndarray) -> np.ndarray:
    """Manifolds in the order of shape ids."""
    return manifolds[order_of(manifolds)]
