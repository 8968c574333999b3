"""Scenes by name. The list is in scenes/__init__.py. main.py passes it, because game/ never imports scenes/."""

from collections.abc import Mapping
from importlib import import_module

from game.errors import unknown_name
from game.scene import Scene


class Registry:
    """Scene classes by name. Each is imported at its first use, so that starting one scene imports one scene."""

    def __init__(self, listing: Mapping[str, str]) -> None:
        self.listing = dict(listing)  # name -> "module:Class", in menu order
        self.classes = {}

    @property
    def names(self) -> tuple[str, ...]:
        """Scene names in menu order."""
        return tuple(self.listing)

    def scene_class(self, name: str) -> type[Scene]:
        """Return the class of a scene. Raises UsageError, which names the valid scenes, for an unknown name."""
        if name not in self.listing:
            raise unknown_name("scene", name, self.names)
        if name not in self.classes:
            module, attribute = self.listing[name].split(":")
            self.classes[name] = getattr(import_module(module), attribute)
        return self.classes[name]

    def all_classes(self) -> list[type[Scene]]:
        """Return every scene class in menu order."""
        return [self.scene_class(name) for name in self.names]
