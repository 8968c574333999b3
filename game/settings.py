"""Settings: JSON with a version, written whole or not at all, read with patience.

A damaged file never stops the game: what cannot be used falls back to its default, the file is kept
beside under another name, and one line says where and why.
"""

import json
from dataclasses import asdict, dataclass, field, fields

from game.bindings import DEFAULT_KEYS, key_codes
from game.data_folder import data_folder, keep_beside, write_atomically

VERSION = 1
FILE = "settings.json"


@dataclass
class Settings:
    """What the player chose."""

    window_scale: int = 0          # 0: the largest that fits the desktop; else 1..8
    fullscreen: bool = False
    volume: float = 0.7            # of effects, 0..1
    shake: bool = True             # camera shake
    show_fps: bool = False
    keys: dict = field(default_factory=lambda: {action: list(keys) for action, keys in DEFAULT_KEYS.items()})


def settings_path():
    """Where this user's settings are."""
    return data_folder() / FILE


def load_settings(path=None):
    """(settings, message). The message is "" or one line: file, place, reason, and where the old file is kept."""
    path = path or settings_path()
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        return Settings(), ""
    except (OSError, UnicodeDecodeError) as error:
        return Settings(), _report(path, "file", str(error))
    try:
        data = json.loads(text)
    except json.JSONDecodeError as error:
        return Settings(), _report(path, f"line {error.lineno} column {error.colno}", error.msg)
    if not isinstance(data, dict) or data.get("version") != VERSION:
        return Settings(), _report(path, "version", f"must be {VERSION}")
    settings, problem = Settings(), ("", "")
    for entry in fields(Settings):
        if entry.name not in data:
            continue            # a file from before that setting existed
        reason = _refusal(entry.name, data[entry.name])
        if reason:
            problem = problem if problem[0] else (entry.name, reason)
        else:
            setattr(settings, entry.name, data[entry.name])
    return settings, _report(path, *problem) if problem[0] else ""


def save_settings(settings, path=None):
    """Write the file; raises OSError when that is not possible."""
    data = {"version": VERSION, **asdict(settings)}
    write_atomically(path or settings_path(), json.dumps(data, indent=2) + "\n")


def _report(path, place, reason):
    """Keep the damaged file and say what is wrong with it."""
    try:
        kept = f"; defaults are used, the old file is kept as {keep_beside(path).name}"
    except OSError as error:
        kept = f"; defaults are used, the old file could not be copied ({error})"
    return f"{path}: {place}: {reason}{kept}"


def _refusal(name, value):
    """Why a value cannot be used, or ""."""
    if name in ("fullscreen", "shake", "show_fps"):
        return "" if isinstance(value, bool) else f"must be true or false (got {value!r})"
    if name == "window_scale":
        whole = isinstance(value, int) and not isinstance(value, bool)
        return "" if whole and 0 <= value <= 8 else f"must be a whole number 0..8 (got {value!r})"
    if name == "volume":
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        return "" if number and 0 <= value <= 1 else f"must be a number 0..1 (got {value!r})"
    return _keys_refusal(value)


def _keys_refusal(value):
    if not isinstance(value, dict) or set(value) != set(DEFAULT_KEYS):
        return f"must name each of {', '.join(DEFAULT_KEYS)}"
    for action, keys in value.items():
        if not isinstance(keys, list) or not keys or not all(isinstance(key, str) for key in keys):
            return f"{action} must be a list of key names"
    try:
        key_codes(value)
    except ValueError as error:
        return str(error)
    return ""
