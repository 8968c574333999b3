"""Errors that end the program with one line instead of a traceback, and their exit codes."""

from collections.abc import Iterable
from pathlib import Path


class UsageError(Exception):
    """Wrong use: an unknown name, a damaged file, no display. The text is the line to print; exit 2."""

    exit_code = 2
    headline = "That does not work"

    @property
    def parts(self) -> tuple[tuple[str, str], ...]:
        """(label, text) of what is said under the headline, where there is room for more than a line."""
        return (("reason", str(self)),)


class FileError(UsageError):
    """A file that cannot be used: names the file, the place in it and the reason."""

    headline = "This file cannot be used"

    def __init__(self, path: str | Path, place: str, reason: str) -> None:
        super().__init__(f"{path}: {place}: {reason}")
        self.path, self.place, self.reason = path, place, reason

    @property
    def parts(self) -> tuple[tuple[str, str], ...]:
        """The file, the place and the reason."""
        return ("file", str(self.path)), ("place", str(self.place)), ("reason", str(self.reason))


class ReplayDiverged(Exception):
    """The simulation differs from the recording; names the frame; exit 1."""

    exit_code = 1


class StrictFailure(Exception):
    """A warning turned into a failure by --strict; exit 1."""

    exit_code = 1


def unknown_name(what: str, name: object, valid: Iterable[str]) -> UsageError:
    """A UsageError for a name that is none of `valid`, with the nearest one as a guess."""
    from difflib import get_close_matches

    valid = list(valid)
    guess = get_close_matches(str(name), valid, n=1)
    hint = f"; did you mean {guess[0]}?" if guess else ""
    return UsageError(f"no {what} {name!r}; valid: {', '.join(valid)}{hint}")
