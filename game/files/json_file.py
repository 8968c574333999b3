"""Reads a JSON file, or says which file cannot be used, where and why."""

import json
from pathlib import Path
from typing import Any

from game.errors import FileError


def read_json(path: str | Path) -> Any:
    """The content of a JSON file. Raises FileError naming file, place and reason, also for nesting without end."""
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except OSError as error:
        raise FileError(path, "file", error.strerror or str(error)) from error
    except UnicodeDecodeError as error:
        raise FileError(path, f"byte {error.start}", "not UTF-8 text") from error
    except json.JSONDecodeError as error:
        raise FileError(path, f"line {error.lineno} column {error.colno}", error.msg) from error
    except ValueError as error:  # a number of thousands of digits
        raise FileError(path, "file", str(error)) from error
    except RecursionError as error:
        raise FileError(path, "file", "nested too deeply") from error
