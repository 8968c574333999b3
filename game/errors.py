"""Errors that end the program with one line instead of a traceback, and their exit codes."""

from collections.abc import Iterable
from pathlib import Path

LONGEST = 400  # letters of a path, a place or a reason: names in files from elsewhere may have thousands


class UsageError(Exception):
    """Wrong use: an unknown name, a damaged file, no display. The text is the line to print; exit 2."""

    exit_code = 2
    headline = "That does not work"

    @property
    def parts(self) -> tuple[tuple[str, str], ...]:
        """(label, text) of what is said under the headline, where there is room for more than a line."""
        return (("reason", str(self)),)


class FileError(UsageError):
    """A file that cannot be used: names the file, the place in it and the reason, each within LONGEST letters."""

    headline = "This file cannot be used"

    def __init__(self, path: str | Path, place: str, reason: str) -> None:
        super().__init__(f"{brief(path)}: {brief(place)}: {brief(reason)}")
        self.path, self.place, self.reason = path, place, reason

    @property
    def parts(self) -> tuple[tuple[str, str], ...]:
        """The file, the place and the reason."""
        return ("file", brief(self.path)), ("place", brief(self.place)), ("reason", brief(self.reason))


class ReplayDiverged(Exception):
    """The simulation differs from the recording; names the frame; exit 1."""

    exit_code = 1


class StrictFailure(Exception):
    """What --strict objects to: a warning, a broken invariant; exit 1."""

    exit_code = 1


def brief(text: object) -> str:
    """Text for a line: what is longer than LONGEST loses its middle, what cannot be printed is a question mark."""
    line = str(text)
    if len(line) > LONGEST:
        line = f"{line[: LONGEST // 2]} ... {line[-LONGEST // 2 + 5 :]}"
    return "".join(letter if letter.isprintable() else "?" for letter in line)


def unknown_name(what: str, name: object, valid: Iterable[str]) -> UsageError:
    """A UsageError for a name that is none of `valid`, with the nearest one as a guess."""
    from difflib import get_close_matches

    valid = list(valid)
    guess = get_close_matches(str(name)[:60], valid, n=1)
    hint = f"; did you mean {guess[0]}?" if guess else ""
    return UsageError(f"no {what} {name!r:.60}; valid: {', '.join(valid)}{hint}")
