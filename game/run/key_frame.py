"""Key frame: a compact copy of the complete state of a scene, which can be restored into the same scene.

Restoring changes the contents of the scene's objects but not the objects themselves, so that references to them remain
valid. The contents are pickled, with arrays outside the pickle. Constant objects are stored only by reference:
pictures, shapes, code, and objects whose deep copy is the object itself.
"""

import io
import pickle
import sys
from collections.abc import Iterable
from operator import is_
from types import FunctionType
from typing import Any

import numpy as np
import pygame

from game.run.chunks import Chunks, bytes_of
from game.scene import Scene
from physics import World
from physics.tables.table import Table

OUTSIDE = ("accessibility", "ghost", "best", "figures")  # attributes that others set on a scene; not restored
TRAIL = "trail"  # attribute of a scene that only grows, so its length is enough to restore it
KEPT = (type, FunctionType, np.dtype, pygame.Surface)  # types of constant objects


class KeyFrame:
    """Stored state of a scene.

    before: an earlier key frame of the scene, with which unchanged data are shared, or None.
    """

    def __init__(self, scene: Scene, before: "KeyFrame | None" = None) -> None:
        self.scene = scene
        self.trail, self.steps = scene.trail, len(scene.trail)
        stream = io.BytesIO()
        writer = _Writer(stream, scene)
        writer.dump({name: value for name, value in vars(scene).items() if name not in (*OUTSIDE, TRAIL)})
        for world in writer.worlds:  # more are appended meanwhile
            writer.tables = {id(value) for value in vars(world).values() if isinstance(value, Table)}
            writer.dump(world.__getstate__())
        self.worlds = _same(tuple(writer.worlds), before and before.worlds)
        self.kept = _same(tuple(writer.kept), before and before.kept)
        raw = [stream.getbuffer(), *(buffer.raw() for buffer in writer.buffers)]
        self.chunks = Chunks(raw, [0, *writer.widths], before and before.chunks)

    def restore(self) -> None:
        """Restore the stored state into the scene."""
        stream, *buffers = self.chunks.contents()
        reader = _Reader(io.BytesIO(stream), self.kept, buffers)
        scene = self.scene
        outside = {name: vars(scene)[name] for name in OUTSIDE}
        state = reader.load()
        vars(scene).clear()
        vars(scene).update(state, **outside, **{TRAIL: self.trail[: self.steps]})
        for world in self.worlds:
            state = reader.load()
            vars(world).clear()
            world.__setstate__(state)


def bytes_held(frames: Iterable[KeyFrame]) -> int:
    """Return the total memory of several key frames [bytes]. Data that they share count once."""
    lists = {id(kept): kept for frame in frames for kept in (frame.kept, frame.worlds)}
    return sum(map(sys.getsizeof, lists.values())) + bytes_of([frame.chunks for frame in frames])


def table_of(rows: np.ndarray, capacity: int) -> Table:
    """Return a table with the given rows and capacity.

    The function is called on unpickling, because a pickle contains only the used rows of a table.
    """
    table = Table(rows.dtype, capacity)
    table.append(len(rows)).view(np.uint8)[:] = rows.view(np.uint8)
    return table


def shared(number: int) -> object:
    """Represent the object `kept[number]` of a key frame in the key frame's pickle.

    The key frame's own reader replaces this function. A call of the function itself raises LookupError.
    """
    raise LookupError(f"object {number} is not in this pickle: a key frame holds it")


class _Writer(pickle.Pickler):
    """Pickler of a key frame. kept: the objects that are stored by reference.

    worlds: the worlds among these objects. Their state is pickled separately.
    """

    def __init__(self, file, scene):
        self.buffers, self.widths = [], []
        super().__init__(file, 5, buffer_callback=self._take)
        self.scene = scene
        self.kept, self.worlds = [], []
        self.numbers = {}  # index in `kept` by id
        self.tables: set[int] = set()  # ids of the tables that belong to the world alone
        self.width = 0  # bytes of an item of the array that is being pickled

    def _take(self, buffer):
        self.buffers.append(buffer)
        self.widths.append(self.width)

    def reducer_override(self, obj):
        kind = type(obj)
        if kind is np.ndarray:
            self.width = obj.itemsize
            return NotImplemented
        if kind is Table and id(obj) in self.tables:
            return table_of, (obj.rows, len(obj.data))
        if obj is shared or not (obj is self.scene or isinstance(obj, (World, *KEPT)) or hasattr(kind, "__deepcopy__")):
            return NotImplemented
        number = self.numbers.get(id(obj))
        if number is None:
            number = self.numbers[id(obj)] = len(self.kept)
            self.kept.append(obj)
            if isinstance(obj, World):
                self.worlds.append(obj)
        return shared, (number,)


class _Reader(pickle.Unpickler):
    def __init__(self, file, kept, buffers):
        super().__init__(file, buffers=buffers)
        self.kept = kept

    def find_class(self, module_name: str, global_name: str) -> Any:
        if (module_name, global_name) == (shared.__module__, shared.__name__):
            return self.kept.__getitem__
        return super().find_class(module_name, global_name)


def _same(new, old):
    """Return `old` if it contains the same objects as `new`, otherwise `new`. new, old: tuples, or old is None.

    A tuple with the same objects is thus stored once.
    """
    if old is not None and len(new) == len(old) and all(map(is_, new, old)):
        return old
    return new
