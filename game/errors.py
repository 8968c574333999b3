"""Errors that end the program with one line instead of a traceback, and their exit codes."""

from collections.abc import Iterable, Sequence
from pathlib import Path

LONGEST = 300  # characters of a message: file names and file contents may have thousands


class UsageError(Exception):
    """Error for wrong use: an unknown name, a damaged file, no display. The program then ends with exit code 2.

    The text is printed as one line of at most LONGEST characters. The attributes `valid` (the valid names) and `hint`
    (text with the nearest valid name) are printed after it and are never shortened.
    """

    exit_code = 2
    headline = "That does not work"

    def __init__(self, text: str, valid: Iterable[str] = (), hint: str = "") -> None:
        super().__init__(text)
        self.valid, self.hint = tuple(valid), hint

    def __str__(self) -> str:
        names = f"; valid: {', '.join(self.valid)}" if self.valid else ""
        return brief(self.args[0]) + names + self.hint

    @property
    def parts(self) -> tuple[tuple[str, str], ...]:
        """The error as a tuple of (label, text), for an error screen with the title `headline`."""
        return (("reason", brief(self)),)


class FileError(UsageError):
    """Error for an unusable file.

    The error's text names the file, the place in the file and the reason, in at most LONGEST characters.
    """

    headline = "This file cannot be used"

    def __init__(self, path: str | Path, place: str, reason: str) -> None:
        self.path, self.place, self.reason = path, place, reason
        super().__init__(": ".join(self._texts()))

    def _texts(self):
        return share((self.path, self.place, self.reason), LONGEST - 4)

    @property
    def parts(self) -> tuple[tuple[str, str], ...]:
        """The file, the place in the file and the reason, as a tuple of (label, text)."""
        return tuple(zip(("file", "place", "reason"), self._texts(), strict=True))


class ReplayDiverged(Exception):
    """Error for a replay whose simulation differs from the recording. Its text names the frame. Exit code 1."""

    exit_code = 1


class StrictFailure(Exception):
    """Error for a run with --strict that emits a warning or breaks an invariant. Exit code 1."""

    exit_code = 1


def brief(text: object, most: int = LONGEST) -> str:
    """Return a text as one line of at most `most` characters.

    In a longer text, the middle is cut out. Unprintable characters are replaced by question marks.
    """
    line = str(text)
    if len(line) > most:
        last = max(0, most - 5) // 2
        line = f"{line[: max(0, most - 5 - last)]} ... {line[len(line) - last :]}"[:most]
    return "".join(letter if letter.isprintable() else "?" for letter in line)


def share(texts: Sequence[object], room: int) -> list[str]:
    """Return the texts, shortened so that they have at most `room` characters in total.

    Each text may have an equal part of `room`. Characters that short texts do not need are given to longer texts.
    """
    lines = [str(text) for text in texts]
    by_length = sorted(range(len(lines)), key=lambda number: len(lines[number]))
    for left, number in zip(range(len(lines), 0, -1), by_length, strict=True):
        lines[number] = brief(lines[number], room // left)
        room -= len(lines[number])
    return lines


def unknown_name(what: str, name: object, valid: Iterable[str]) -> UsageError:
    """Return a UsageError for a name that is not in `valid`, with the nearest valid name as a hint.

    what: the kind of the name, such as "scene".
    """
    from difflib import get_close_matches

    valid = list(valid)
    guess = get_close_matches(str(name)[:60], valid, n=1)
    hint = f"; did you mean {guess[0]}?" if guess else ""
    return UsageError(f"no {what} {name!r:.60}", valid, hint)
