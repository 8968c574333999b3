"""Errors that end the program with one line instead of a traceback, and their exit codes."""


class UsageError(Exception):
    """Wrong use: an unknown name, a damaged file, no display. The text is the line to print; exit 2."""

    exit_code = 2


class FileError(UsageError):
    """A file that cannot be used: names the file, the place in it and the reason."""

    def __init__(self, path, place, reason):
        super().__init__(f"{path}: {place}: {reason}")
        self.path, self.place, self.reason = path, place, reason


class ReplayDiverged(Exception):
    """The simulation differs from the recording; names the frame; exit 1."""

    exit_code = 1


class StrictFailure(Exception):
    """A warning turned into a failure by --strict; exit 1."""

    exit_code = 1


def unknown_name(what, name, valid):
    """A UsageError for a name that is none of `valid`, with the nearest one as a guess."""
    from difflib import get_close_matches

    guess = get_close_matches(str(name), list(valid), n=1)
    hint = f"; did you mean {guess[0]}?" if guess else ""
    return UsageError(f"no {what} {name!r}; valid: {', '.join(valid)}{hint}")
