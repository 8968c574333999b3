"""A reader of JSON files whose errors name the file, the place and the reason."""

import codecs
import json
from pathlib import Path
from typing import Any

from game.errors import FileError

LARGEST = 256 * 2**20  # bytes: ten hours of a recording in which every frame differs
CHUNK = 2**20  # bytes that are read and checked at a time


def read_json(path: str | Path) -> Any:
    """Return the content of a JSON file. A byte order mark is allowed. Raises FileError for an unusable file."""
    try:
        return json.loads("".join(_texts(path)))
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


def _texts(path):
    """Yield the text of a file in parts of CHUNK bytes, so that an endless device is rejected early."""
    decoder, read = codecs.getincrementaldecoder("utf-8")(), 0
    with open(path, "rb") as file:
        while chunk := file.read(CHUNK):
            if read == 0 and chunk.startswith(codecs.BOM_UTF8):
                chunk, read = chunk[len(codecs.BOM_UTF8) :], len(codecs.BOM_UTF8)
            if b"\0" in chunk:
                raise FileError(path, f"byte {read + chunk.index(0)}", "a zero: this is no text")
            try:
                yield decoder.decode(chunk)
            except UnicodeDecodeError as error:
                raise FileError(path, f"byte {read + error.start}", "not UTF-8 text") from error
            read += len(chunk)
            if read > LARGEST:
                raise FileError(path, "file", f"is larger than {LARGEST >> 20} MB")
    try:
        yield decoder.decode(b"", final=True)
    except UnicodeDecodeError as error:
        raise FileError(path, f"byte {read}", "not UTF-8 text, or cut off") from error
