"""Settings of the player: a JSON file with a version, written atomically, and read with tolerance for damage.

A damaged file never stops the game. Each unusable value is replaced by its default, and the file is kept under another
name. One line of text names the place and the reason of the damage. A file of a newer version is kept but not read.
"""

import json
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path

from game.errors import FileError
from game.files.accessibility import PALETTES, Accessibility
from game.files.data_folder import data_folder, is_there, refusal, write_atomically
from game.files.json_file import read_json
from game.input.bindings import REBOUND, button_actions, key_codes
from game.input.rebinding import FIXED, clash, completed, default_table

VERSION = 2
FILE = "settings.json"
LARGEST_SCALE = 8
FRAME_CAPS = (60, 120, 30, 0)  # pictures a second; 0: no cap
SLOWEST = 0.5  # of real time, for players who want more time to react
LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-"  # of initials


@dataclass
class Settings:
    """Choices of the player. Volumes and other factors are 0..1."""

    master: float = 0.8
    music: float = 0.6
    effects: float = 0.8
    window_scale: int = 0  # 0: the largest that fits the desktop; else 1..8
    fullscreen: bool = False
    vsync: bool = True
    frame_cap: int = FRAME_CAPS[0]
    show_fps: bool = False
    shake: float = 1.0
    hit_stop: bool = True
    reduced_flashing: bool = False
    palette: str = PALETTES[0]
    speed: float = 1.0  # of real time
    invincible: bool = False
    ghost: bool = True  # show the best run beside this one
    rumble: bool = True
    hint_seen: bool = False  # the card of the first game was closed
    labs_seen: list = field(default_factory=list)  # names of the labs whose card was closed
    initials: str = "AAA"  # those entered last
    keys: dict = field(default_factory=lambda: default_table("keys"))
    buttons: dict = field(default_factory=lambda: default_table("buttons"))

    def accessibility(self) -> Accessibility:
        """Return the settings that the drawing of a scene needs."""
        return Accessibility(self.shake, not self.reduced_flashing, self.palette)

    def assists(self) -> dict[str, bool]:
        """Return the settings that affect the rules of a scene: {name in game.scene.ASSISTS: value}."""
        return {"invincible": self.invincible, "hit_stop": self.hit_stop}


def settings_path() -> Path:
    """Return the path of this user's settings file."""
    return data_folder() / FILE


def load_settings(path: Path | None = None) -> tuple[Settings, str]:
    """Return (Settings, message). path: settings file; None means this user's file.

    The message is "", or one line with the file, the place, the reason and the name of the kept copy.
    """
    path = path or settings_path()
    if not is_there(path):
        return Settings(), ""
    try:
        data = _upgraded(path, read_json(path))
    except FileError as error:
        why = "newer" if error.place == "version" else "damaged"
        return Settings(), refusal(path, error.place, error.reason, "defaults are used", why)
    settings, problem = Settings(), None
    for entry in fields(Settings):
        if entry.name not in data:
            continue
        reason = _refusal_of(entry.name, data[entry.name])
        if reason:
            problem = problem or (entry.name, reason)
        else:
            setattr(settings, entry.name, data[entry.name])
    return settings, refusal(path, *problem, "the default is used") if problem else ""


def save_settings(settings: Settings, path: Path | None = None) -> None:
    """Write the settings to a file. path: the file; None means this user's settings file. Raises OSError."""
    data = {"version": VERSION, **asdict(settings)}
    write_atomically(path or settings_path(), json.dumps(data, indent=2) + "\n")


def _upgraded(path, data):
    """Return the content `data` of a settings file of version 1 or 2, converted to version 2.

    Raises FileError for other versions.
    """
    version = data.get("version") if isinstance(data, dict) else None
    if version not in (1, VERSION) or isinstance(version, bool):
        raise FileError(path, "version", f"{version!r:.40} cannot be read here; this program reads 1 to {VERSION}")
    data = dict(data)
    if version == 1:
        # Version 1 had one volume, for the effects, and shake on or off. Its keys named some that are fixed in version
        # 2, and lacked others.
        if "volume" in data:
            data["effects"] = data.pop("volume")
        if isinstance(data.get("shake"), bool):
            data["shake"] = 1.0 if data["shake"] else 0.0
        table = data.get("keys")
        if isinstance(table, dict) and all(_are_names(keys) for keys in table.values()):
            kept = {
                action: [key for key in keys if key not in FIXED["keys"]]
                for action, keys in table.items()
                if action in REBOUND
            }
            data["keys"] = completed(kept, "keys")
    return data


def _refusal_of(name, value):
    """Return the reason why `value` is unusable for the setting `name`; "" if it is usable."""
    if name in ("keys", "buttons"):
        return _table_refusal(name, value)
    if name == "labs_seen":
        return "" if _are_names(value) else f"must be a list of names (got {value!r:.60})"
    default = getattr(Settings, name)
    if isinstance(default, bool):
        return "" if isinstance(value, bool) else f"must be true or false (got {value!r:.60})"
    if isinstance(default, float):
        least = SLOWEST if name == "speed" else 0
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        return "" if number and least <= value <= 1 else f"must be a number {least}..1 (got {value!r:.60})"
    if name == "window_scale":
        whole = isinstance(value, int) and not isinstance(value, bool)
        return "" if whole and 0 <= value <= LARGEST_SCALE else f"must be a whole number 0..8 (got {value!r:.60})"
    if name == "initials":
        fits = isinstance(value, str) and len(value) == 3 and all(letter in LETTERS for letter in value)
        return "" if fits else f"must be three of {LETTERS} (got {value!r:.60})"
    valid = {"frame_cap": FRAME_CAPS, "palette": PALETTES}[name]
    known = isinstance(value, type(valid[0])) and not isinstance(value, bool) and value in valid
    return "" if known else f"must be one of {', '.join(map(str, valid))} (got {value!r:.60})"


def _are_names(controls):
    return isinstance(controls, list) and all(isinstance(each, str) for each in controls)


def _table_refusal(device, value):
    if not isinstance(value, dict) or set(value) != set(REBOUND):
        return f"must name each of {', '.join(REBOUND)}"
    for action, controls in value.items():
        if not _are_names(controls) or not controls:
            return f"{action} must be a list of names"
        taken = [each for each in controls if each in FIXED[device]]
        if taken:
            return f"{action} cannot have {taken[0]}, which always does the same"
    try:
        (key_codes if device == "keys" else button_actions)(value)
    except ValueError as error:
        return str(error)
    found = clash(value)
    return f"{found[0]} and {found[1]} both have {found[2]}" if found else ""
