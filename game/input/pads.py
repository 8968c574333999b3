"""The connected controllers by instance id, which is unique while the program runs."""

from types import ModuleType

import pygame


def controller_module() -> ModuleType | None:
    """Return pygame._sdl2.controller, with uniform button names, or None if pygame lacks it, as pygame 2.6.1 does."""
    try:
        from pygame._sdl2 import controller
    except ImportError:
        return None
    return controller


class Pads:
    """The open pads. SDL sends events of open pads only, so each pad is opened when it is connected."""

    def __init__(self) -> None:
        self.controllers, self.joysticks = {}, {}
        self.module = controller_module()
        pygame.joystick.init()
        if self.module is not None:
            self.module.init()

    def added(self, device_index: int) -> None:
        """Open the pad with this device index.

        A pad that SDL announces twice, as joystick and as controller, is opened once.
        """
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
            return  # disconnected since the event; its removal follows

    def removed(self, instance_id: int) -> None:
        """Forget a pad that was disconnected."""
        self.controllers.pop(instance_id, None)
        self.joysticks.pop(instance_id, None)

    def knows(self, instance_id: int) -> bool:
        """Return whether the pad is open."""
        return instance_id in self.controllers or instance_id in self.joysticks

    def is_controller(self, instance_id: int) -> bool:
        """Return whether SDL has a mapping of this pad's buttons."""
        return instance_id in self.controllers

    def rumble(self, low: float, high: float, milliseconds: int) -> None:
        """Run the motors of every pad with an SDL mapping for some milliseconds.

        low, high: strength 0..1 of the motors of low and of high pitch.
        """
        for controller in self.controllers.values():
            controller.rumble(low, high, milliseconds)
