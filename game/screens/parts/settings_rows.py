"""The rows of each page of the settings screen. They show and change the values of a Settings object."""

from collections.abc import Callable
from functools import partial

from game.drawing.colors import FOG
from game.files.accessibility import PALETTES
from game.files.settings import FRAME_CAPS, LARGEST_SCALE, SLOWEST, Settings
from game.input.bindings import REBOUND, shown
from game.input.rebinding import default_table
from game.screens.parts.rows import Row

PAGES = ("Sound", "Picture", "Comfort", "Keyboard", "Controller")
STEP = 0.1  # of a volume or the shake, by key
SPEED_STEP = 0.05
CAPS = {0: "none", 30: "30 a second", 60: "60 a second", 120: "120 a second"}
PALETTE_HINTS = {
    "standard": "As painted.",
    "safe": "Overlays and bullets in colours that stay apart for colour-blind eyes.",
    "contrast": "Safe colours, brighter, over a darker picture.",
}


def rows_of(
    page: str, settings: Settings, changed: Callable[[], None], wait_for: Callable[[str, str], None]
) -> list[Row]:
    """Return the rows of the settings page `page`. changed() is called after each change.

    wait_for(device, action) asks the screen to bind the next key or button to an action.
    """
    if page in ("Keyboard", "Controller"):
        return _binding_rows("keys" if page == "Keyboard" else "buttons", settings, changed, wait_for)
    return {"Sound": _sound_rows, "Picture": _picture_rows, "Comfort": _accessibility_rows}[page](settings, changed)


def _sound_rows(s, changed):
    return [
        _slider(s, changed, "Everything", "master", "How loud all of it is."),
        _slider(s, changed, "Music", "music", "How loud the tunes are."),
        _slider(s, changed, "Effects", "effects", "How loud shots, jumps and menus are."),
    ]


def _picture_rows(s, changed):
    scale = "fit" if s.window_scale == 0 else f"x{s.window_scale}"
    return [
        Row(
            "Window size",
            scale,
            turn=partial(_turn_scale, s, changed),
            hint="Whole steps, so that every pixel stays square.",
        ),
        _switch(s, changed, "Full screen", "fullscreen", "F11 does the same, anywhere."),
        _switch(s, changed, "Wait for the screen", "vsync", "No torn pictures (vsync), where the system has it."),
        Row(
            "Picture limit",
            CAPS[s.frame_cap],
            turn=partial(_turn_choice, s, changed, "frame_cap", FRAME_CAPS),
            hint="More pictures a second are smoother and cost power. The game runs the same.",
        ),
        _switch(s, changed, "Show frame rate", "show_fps", "Milliseconds of a picture, in the corner."),
    ]


def _accessibility_rows(s, changed):
    return [
        Row("FOR EYES AND HANDS", head=True),
        _slider(s, changed, "Screen shake", "shake", "How much the picture shakes when something breaks."),
        _switch(s, changed, "Reduced flashing", "reduced_flashing", "No flash fills the picture, and nothing blinks."),
        Row(
            "Colours",
            s.palette,
            turn=partial(_turn_choice, s, changed, "palette", PALETTES),
            hint=PALETTE_HINTS[s.palette],
        ),
        _switch(s, changed, "Rumble", "rumble", "The controller shakes when you are hit."),
        Row("HELP IN GAMES", head=True),
        Row(
            "Game speed",
            f"{s.speed:.0%}",
            turn=partial(_turn_share, s, changed, "speed", SPEED_STEP, SLOWEST),
            put=partial(_put_share, s, changed, "speed", SPEED_STEP, SLOWEST),
            share=(s.speed - SLOWEST) / (1 - SLOWEST),
            hint="Slower, if you like. Scores are then marked assisted.",
        ),
        _switch(s, changed, "Invincible", "invincible", "Nothing hurts you. Scores are then marked assisted."),
        _switch(s, changed, "Hit-stop", "hit_stop", "A blink of stillness when something heavy is hit."),
        _switch(s, changed, "Ghost of the best run", "ghost", "Runs beside you where a game keeps one."),
    ]


def _binding_rows(device, settings, changed, wait_for):
    table = getattr(settings, device)
    rows = [
        Row(
            action.capitalize(),
            ", ".join(shown(each) for each in table[action]),
            press=partial(wait_for, device, action),
            hint=f"Enter, then the new {'key' if device == 'keys' else 'button'} for {action}.",
        )
        for action in REBOUND
    ]
    rows.append(
        Row(
            "All as they were",
            press=partial(_reset, settings, device, changed),
            color=FOG,
            hint="Every action gets back what it had at first.",
        )
    )
    return rows


def _slider(s, changed, label, name, hint):
    value = getattr(s, name)
    return Row(
        label,
        f"{value:.0%}",
        turn=partial(_turn_share, s, changed, name, STEP, 0.0),
        put=partial(_put_share, s, changed, name, STEP / 2, 0.0),
        share=value,
        hint=hint,
    )


def _switch(s, changed, label, name, hint):
    return Row(label, "on" if getattr(s, name) else "off", turn=partial(_toggle, s, changed, name), hint=hint)


def _toggle(s, changed, name, way):
    setattr(s, name, not getattr(s, name))
    changed()


def _turn_share(s, changed, name, step, least, way):
    _set_share(s, changed, name, getattr(s, name) + way * step, step, least)


def _put_share(s, changed, name, step, least, share):
    _set_share(s, changed, name, least + share * (1.0 - least), step, least)


def _set_share(s, changed, name, value, step, least):
    value = round(min(1.0, max(least, round(value / step) * step)), 2)
    if value != getattr(s, name):
        setattr(s, name, value)
        changed()


def _turn_choice(s, changed, name, choices, way):
    setattr(s, name, choices[(choices.index(getattr(s, name)) + way) % len(choices)])
    changed()


def _turn_scale(s, changed, way):
    s.window_scale = (s.window_scale + way) % (LARGEST_SCALE + 1)
    changed()


def _reset(settings, device, changed):
    setattr(settings, device, default_table(device))
    changed()
