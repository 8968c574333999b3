"""The controllers that are plugged in, by instance id, which never changes and is never used again in one run."""

from types import ModuleType

import pygame


def controller_module() -> ModuleType | None:
    """pygame._sdl2.controller (uniform button names), or None where SDL has none, as in pygame 2.6.1."""
    try:
        from pygame._sdl2 import controller
    except ImportError:
        return None
    return controller


class Pads:
    """Opens pads as they are plugged in; an open pad is what makes SDL send its events."""

    def __init__(self) -> None:
        self.controllers, self.joysticks = {}, {}
        self.module = controller_module()
        pygame.joystick.init()
        if self.module is not None:
            self.module.init()

    def added(self, device_index: int) -> None:
        """Open the pad at this moment's device index. A pad both modules announce is opened once."""
        try:
            joystick = pygame.joystick.Joystick(device_index)
            instance = joystick.get_instance_id()
            if self.knows(instance):
                return
            if self.module is not None and self.module.is_controller(device_index):
                self.controllers[instance] = self.module.Controller(device_index)
            else:
                self.joysticks[instance] = joystick
        except pygame.error:
            return  # pulled out again between the event and now; its removal follows

    def removed(self, instance_id: int) -> None:
        """Forget a pad."""
        self.controllers.pop(instance_id, None)
        self.joysticks.pop(instance_id, None)

    def knows(self, instance_id: int) -> bool:
        """True if the pad is open."""
        return instance_id in self.controllers or instance_id in self.joysticks

    def is_controller(self, instance_id: int) -> bool:
        """True if SDL maps this pad's buttons."""
        return instance_id in self.controllers

    def rumble(self, low: float, high: float, milliseconds: int) -> None:
        """Shake every mapped pad's motors, 0..1 each, those that have any."""
        for controller in self.controllers.values():
            controller.rumble(low, high, milliseconds)
