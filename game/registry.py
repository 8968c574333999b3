"""Scenes by name. The list itself is scenes/__init__.py; main.py hands it in, since game never imports scenes."""

from collections.abc import Mapping
from importlib import import_module

from game.errors import unknown_name
from game.scene import Scene


class Registry:
    """Scene classes, imported when first asked for, so that one scene's start costs one scene."""

    def __init__(self, listing: Mapping[str, str]) -> None:
        self.listing = dict(listing)  # name -> "module:Class", in menu order
        self.classes = {}

    @property
    def names(self) -> tuple[str, ...]:
        """Scene names in menu order."""
        return tuple(self.listing)

    def scene_class(self, name: str) -> type[Scene]:
        """The class of a scene. An unknown name raises UsageError naming the valid ones."""
        if name not in self.listing:
            raise unknown_name("scene", name, self.names)
        if name not in self.classes:
            module, attribute = self.listing[name].split(":")
            self.classes[name] = getattr(import_module(module), attribute)
        return self.classes[name]

    def all_classes(self) -> list[type[Scene]]:
        """Every scene class in menu order."""
        return [self.scene_class(name) for name in self.names]
