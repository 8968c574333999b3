"""Errors that end the program with one line instead of a traceback, and their exit codes."""

from collections.abc import Iterable, Sequence
from pathlib import Path

LONGEST = 300  # letters of a message: names in files, and those of files, may have thousands


class UsageError(Exception):
    """Wrong use: an unknown name, a damaged file, no display. The text is the line to print; exit 2.

    The line has at most LONGEST letters. `valid` are the program's own names that would be right, and `hint` the
    nearest of them: they follow the line, and are never cut.
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
        """(label, text) of what is said under the headline, where there is room for more than a line."""
        return (("reason", brief(self)),)


class FileError(UsageError):
    """A file that cannot be used: names the file, the place in it and the reason, in LONGEST letters."""

    headline = "This file cannot be used"

    def __init__(self, path: str | Path, place: str, reason: str) -> None:
        self.path, self.place, self.reason = path, place, reason
        super().__init__(": ".join(self._texts()))

    def _texts(self):
        return share((self.path, self.place, self.reason), LONGEST - 4)

    @property
    def parts(self) -> tuple[tuple[str, str], ...]:
        """The file, the place and the reason."""
        return tuple(zip(("file", "place", "reason"), self._texts(), strict=True))


class ReplayDiverged(Exception):
    """The simulation differs from the recording; names the frame; exit 1."""

    exit_code = 1


class StrictFailure(Exception):
    """What --strict objects to: a warning, a broken invariant; exit 1."""

    exit_code = 1


def brief(text: object, most: int = LONGEST) -> str:
    """Return text for one line: past `most` letters it loses its middle; what cannot be printed is a question mark."""
    line = str(text)
    if len(line) > most:
        last = max(0, most - 5) // 2
        line = f"{line[: max(0, most - 5 - last)]} ... {line[len(line) - last :]}"[:most]
    return "".join(letter if letter.isprintable() else "?" for letter in line)


def share(texts: Sequence[object], room: int) -> list[str]:
    """Return the texts in at most `room` letters: what is shorter than its share leaves the rest to the others."""
    lines = [str(text) for text in texts]
    by_length = sorted(range(len(lines)), key=lambda number: len(lines[number]))
    for left, number in zip(range(len(lines), 0, -1), by_length, strict=True):
        lines[number] = brief(lines[number], room // left)
        room -= len(lines[number])
    return lines


def unknown_name(what: str, name: object, valid: Iterable[str]) -> UsageError:
    """A UsageError for a name that is none of `valid`, with the nearest one as a guess."""
    from difflib import get_close_matches

    valid = list(valid)
    guess = get_close_matches(str(name)[:60], valid, n=1)
    hint = f"; did you mean {guess[0]}?" if guess else ""
    return UsageError(f"no {what} {name!r:.60}", valid, hint)
