"""Keys and pad buttons that act on the screen of a played scene and do not control the game itself."""

import pygame

from game.screens.parts.played import Played

KEPT_ACTIONS = {"confirm", "cancel", "pause"}  # a key bound to any other action controls the game
PANEL_BUTTONS = {
    "dpad up": pygame.K_UP,
    "dpad down": pygame.K_DOWN,
    "dpad left": pygame.K_LEFT,
    "dpad right": pygame.K_RIGHT,
    "a": pygame.K_RETURN,
}


def press(play: Played, key: int) -> bool:
    """Process a key that acts on the screen of a played scene. Return whether the key has such a function."""
    if set(play.devices.keys.get(key, ())) - KEPT_ACTIONS:
        return False  # the player has bound the key to an action of the game
    layers = {getattr(pygame, f"K_{layer.key}"): layer.name for layer in play.overlays.layers}
    if key in layers:
        play.overlays.toggle(layers[key])
    elif key == pygame.K_0:
        play.overlays.toggle_all()
    elif key == pygame.K_TAB:
        play.toggle_panel()
    elif key == pygame.K_m:
        play.toggle_costs()
    elif key == pygame.K_ESCAPE:
        play.stop()
    elif key == pygame.K_b:
        play.switches.broadphase(1)
    elif key == pygame.K_v:
        play.switch_solver(1)
    elif key == pygame.K_t:
        play.switches.tier(1)
    elif key == pygame.K_n:
        play.switches.narrowphase()
    elif key == pygame.K_r:
        play.request_restart()
    elif key == pygame.K_p:
        play.toggle_pause()  # not through the input of a step: a paused game makes no steps
    elif key == pygame.K_o:
        play.single_step()
    elif key == pygame.K_e:
        play.toggle_step_inspector()
    elif key == pygame.K_k:
        play.toggle_split()
    elif key == pygame.K_MINUS:
        play.clock.slower()
    elif key in (pygame.K_EQUALS, pygame.K_PLUS):
        play.clock.faster()
    elif key == pygame.K_F9:
        play.save_figures()
    elif key == pygame.K_F12:
        play.wants_screenshot = True
    else:
        return False
    return True


def press_button(play: Played, button: str) -> bool:
    """Process a pad button that acts on the screen of a played scene.

    Return False if the button controls the game instead.
    """
    panel = play.open_panel
    if button == "start":
        play.stop()
    elif button == "back":
        play.toggle_pause()
    elif button == "y" or (button == "b" and panel is not None and panel.focused):
        play.toggle_panel()
    elif panel is not None and panel.focused and button in PANEL_BUTTONS:
        panel.key(PANEL_BUTTONS[button])
    else:
        return False
    return True
