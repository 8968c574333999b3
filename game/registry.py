"""Scenes by name. The list is in scenes/__init__.py. main.py passes it in, because game/ never imports scenes/."""

from collections.abc import Mapping
from importlib import import_module

from game.errors import unknown_name
from game.scene import Scene


class Registry:
    """Scene classes by name.

    Each class is imported at its first use, so that the start of one scene imports only this scene.
    """

    def __init__(self, listing: Mapping[str, str]) -> None:
        self.listing = dict(listing)  # name -> "module:Class", in menu order
        self.classes = {}

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all scenes, in menu order."""
        return tuple(self.listing)

    def scene_class(self, name: str) -> type[Scene]:
        """Return the class of the scene `name`. For an unknown name, raise UsageError, which names the valid scenes."""
        if name not in self.listing:
            raise unknown_name("scene", name, self.names)
        if name not in self.classes:
            module, attribute = self.listing[name].split(":")
            self.classes[name] = getattr(import_module(module), attribute)
        return self.classes[name]

    def all_classes(self) -> list[type[Scene]]:
        """Return the classes of all scenes, in menu order."""
        return [self.scene_class(name) for name in self.names]
