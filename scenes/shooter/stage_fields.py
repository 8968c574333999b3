"""Fields of a data file, with errors for unknown, missing and invalid ones that name the place."""

from difflib import get_close_matches
from math import isfinite

from game.errors import FileError

REQUIRED = object()


class Number:
    """A number low..high; `whole` ones have no fraction."""

    def __init__(self, low, high, default=REQUIRED, whole=False):
        self.low, self.high, self.default, self.whole = low, high, default, whole

    def read(self, reader, place, value):
        """Return the number, or FileError."""
        kind = "a whole number" if self.whole else "a number"
        whole = isinstance(value, int) and not isinstance(value, bool)
        if not whole and (self.whole or not isinstance(value, float) or not isfinite(value)):
            reader.fail(place, f"must be {kind} (got {value!r:.60})")
        if not self.low <= value <= self.high:
            reader.fail(place, f"must be {self.low:g}..{self.high:g} (got {value!r:.60})")
        return value if self.whole else float(value)


class Text:
    """Text of 1 to `most` characters of the game's font."""

    def __init__(self, most, default=REQUIRED):
        self.most, self.default = most, default

    def read(self, reader, place, value):
        """Return the text, or FileError."""
        if not isinstance(value, str):
            reader.fail(place, f"must be text (got {value!r:.60})")
        if not 1 <= len(value) <= self.most:
            reader.fail(place, f"must have 1..{self.most} characters (has {len(value)})")
        strange = [c for c in value if not " " <= c <= "~"]
        if strange:
            reader.fail(place, f"may hold letters, digits and signs of ASCII only (got {strange[0]!r:.60})")
        return value


class Choice:
    """One of some names."""

    def __init__(self, names, default=REQUIRED):
        self.names, self.default = tuple(names), default

    def read(self, reader, place, value):
        """Return the name, or FileError with the nearest one as a suggestion."""
        if value not in self.names:
            reader.fail(place, f"must be one of {', '.join(self.names)} (got {value!r:.60}){guess(value, self.names)}")
        return value


class List:
    """A list of `fewest` to `most` entries, each read by `entry`."""

    def __init__(self, entry, fewest, most, default=REQUIRED):
        self.entry, self.fewest, self.most, self.default = entry, fewest, most, default

    def read(self, reader, place, value):
        """Return the entries as a tuple, or FileError."""
        if not isinstance(value, list):
            reader.fail(place, f"must be a list (got {value!r:.40})")
        if not self.fewest <= len(value) <= self.most:
            wanted = self.fewest if self.fewest == self.most else f"{self.fewest}..{self.most}"
            reader.fail(place, f"must have {wanted} entries (has {len(value)})")
        return tuple(self.entry.read(reader, f"{place}[{number}]", each) for number, each in enumerate(value))


class Record:
    """Named fields, passed to `make(**fields)`."""

    def __init__(self, make, default=REQUIRED, **fields):
        self.make, self.fields, self.default = make, fields, default

    def read(self, reader, place, value):
        """Return the result of make(), or FileError."""
        return self.make(**reader.fields(place, value, self.fields))


class Variant:
    """Named fields, of which one, `tag`, selects the others: `records` by its value."""

    def __init__(self, tag, records, **shared):
        self.tag, self.shared, self.records = tag, shared, records

    def read(self, reader, place, value):
        """Return the result of the chosen record's make(), or FileError."""
        tag = Choice(self.records)
        if not isinstance(value, dict) or self.tag not in value:
            reader.fields(place, value, {self.tag: tag}, others=True)
        name = tag.read(reader, join(place, self.tag), value[self.tag])
        record = self.records[name]
        found = reader.fields(place, value, {self.tag: tag, **self.shared, **record.fields})
        return record.make(**found)


class Reader:
    """Reader of one file, whose path its errors name."""

    def __init__(self, path):
        self.path = path

    def fail(self, place, reason):
        """Raise FileError."""
        raise FileError(self.path, place, reason)

    def fields(self, place, value, wanted, others=False):
        """Return {name: value} of all wanted fields; unknown ones are refused except `others`."""
        if not isinstance(value, dict):
            self.fail(place or "file", f"must be an object with {', '.join(wanted)} (got {value!r:.40})")
        if not others:
            for name in value:
                if name not in wanted:
                    self.fail(join(place, name), f"unknown field; allowed: {', '.join(wanted)}{guess(name, wanted)}")
        found = {}
        for name, field in wanted.items():
            if name in value:
                found[name] = field.read(self, join(place, name), value[name])
            elif field.default is REQUIRED:
                self.fail(join(place, name), "is missing")
            else:
                found[name] = field.default
        return found


def join(place, name):
    """Return the place of a field in a record."""
    return f"{place}.{name}" if place else str(name)


def guess(name, names):
    """Return the nearest of some names as a question, or ""."""
    near = get_close_matches(str(name), list(names), n=1)
    return f"; did you mean {near[0]}?" if near else ""
