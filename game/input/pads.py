"""The connected controllers (pads), by SDL instance id, which is unique while the program runs."""

from types import ModuleType

import pygame


def controller_module() -> ModuleType | None:
    """Return pygame._sdl2.controller, which gives buttons uniform names.

    Return None if pygame lacks it (pygame 2.6.1 does).
    """
    try:
        from pygame._sdl2 import controller
    except ImportError:
        return None
    return controller


class Pads:
    """The open controllers (pads). SDL sends events only of open pads, so each pad is opened when it is connected."""

    def __init__(self) -> None:
        self.controllers, self.joysticks = {}, {}
        self.module = controller_module()
        pygame.joystick.init()
        if self.module is not None:
            self.module.init()

    def added(self, device_index: int) -> None:
        """Open the pad with this device index.

        SDL may announce a pad twice, as joystick and as controller. Such a pad is opened once.
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
        """Remove a pad that was disconnected."""
        self.controllers.pop(instance_id, None)
        self.joysticks.pop(instance_id, None)

    def knows(self, instance_id: int) -> bool:
        """Return whether the pad with this id is open."""
        return instance_id in self.controllers or instance_id in self.joysticks

    def is_controller(self, instance_id: int) -> bool:
        """Return whether the pad is open as a controller, which means that SDL has a mapping of its buttons."""
        return instance_id in self.controllers

    def rumble(self, low: float, high: float, milliseconds: int) -> None:
        """Run the motors of every pad that has an SDL mapping, for the given time.

        low, high: strengths 0..1 of the low-frequency and the high-frequency motors.
        """
        for controller in self.controllers.values():
            controller.rumble(low, high, milliseconds)
