"""Validation of a JSON file: classes for the types of its fields, each with a method read(reader, place, value).

read() returns the value as the game uses it. For an invalid value, read() raises FileError, which names the field. The
attribute `default` is the value of a missing field; REQUIRED means that the field must be present.
"""

from difflib import get_close_matches
from math import isfinite

from game.errors import FileError

REQUIRED = object()


class Number:
    """A field type: a number from `low` to `high`. whole: whether only integers are valid."""

    def __init__(self, low, high, default=REQUIRED, whole=False):
        self.low, self.high, self.default, self.whole = low, high, default, whole

    def read(self, reader, place, value):
        """Return `value` if it is a valid number. Raises FileError, which names `place`, if it is not.

        reader: Reader of the file; place: position of the field in the file, such as "events[2].at".
        """
        kind = "a whole number" if self.whole else "a number"
        whole = isinstance(value, int) and not isinstance(value, bool)
        if not whole and (self.whole or not isinstance(value, float) or not isfinite(value)):
            reader.fail(place, f"must be {kind} (got {value!r:.60})")
        if not self.low <= value <= self.high:
            reader.fail(place, f"must be {self.low:g}..{self.high:g} (got {value!r:.60})")
        return value if self.whole else float(value)


class Text:
    """A field type: a text of printable ASCII characters, at least 1 and at most `most`."""

    def __init__(self, most, default=REQUIRED):
        self.most, self.default = most, default

    def read(self, reader, place, value):
        """Return `value` if it is a valid text. Raises FileError, which names `place`, if it is not.

        reader: Reader of the file; place: position of the field in the file, such as "events[2].at".
        """
        if not isinstance(value, str):
            reader.fail(place, f"must be text (got {value!r:.60})")
        if not 1 <= len(value) <= self.most:
            reader.fail(place, f"must have 1..{self.most} characters (has {len(value)})")
        strange = [c for c in value if not " " <= c <= "~"]
        if strange:
            reader.fail(place, f"may hold letters, digits and signs of ASCII only (got {strange[0]!r:.60})")
        return value


class Choice:
    """A field type: one of the texts `names`."""

    def __init__(self, names, default=REQUIRED):
        self.names, self.default = tuple(names), default

    def read(self, reader, place, value):
        """Return `value` if it is one of the texts `names`.

        Raises FileError otherwise; the message suggests the most similar text. reader: Reader of the file; place:
        position of the field in the file, such as "events[2].at".
        """
        if value not in self.names:
            reader.fail(place, f"must be one of {', '.join(self.names)} (got {value!r:.60}){guess(value, self.names)}")
        return value


class List:
    """A field type: a list of `fewest` to `most` entries, each of the field type `entry`."""

    def __init__(self, entry, fewest, most, default=REQUIRED):
        self.entry, self.fewest, self.most, self.default = entry, fewest, most, default

    def read(self, reader, place, value):
        """Return the entries of the list `value` as a tuple. Raises FileError if the list or an entry is invalid.

        reader: Reader of the file; place: position of the field in the file, such as "events[2].at".
        """
        if not isinstance(value, list):
            reader.fail(place, f"must be a list (got {value!r:.40})")
        if not self.fewest <= len(value) <= self.most:
            wanted = self.fewest if self.fewest == self.most else f"{self.fewest}..{self.most}"
            reader.fail(place, f"must have {wanted} entries (has {len(value)})")
        return tuple(self.entry.read(reader, f"{place}[{number}]", each) for number, each in enumerate(value))


class Record:
    """A field type: a JSON object with the given fields {name: field type}. make(**values) builds the result."""

    def __init__(self, make, default=REQUIRED, **fields):
        self.make, self.fields, self.default = make, fields, default

    def read(self, reader, place, value):
        """Return the object that make() builds from the fields of the JSON object `value`.

        Raises FileError if a field is invalid, missing or unknown. reader: Reader of the file; place: position of the
        object in the file, such as "events[2]".
        """
        return self.make(**reader.fields(place, value, self.fields))


class Variant:
    """A field type: a JSON object whose field `tag` decides which other fields it has.

    records: {value of the tag: Record}; shared: {name: field type} of the fields that all variants have.
    """

    def __init__(self, tag, records, **shared):
        self.tag, self.shared, self.records = tag, shared, records

    def read(self, reader, place, value):
        """Read the JSON object `value` with the Record that its tag selects. Return the object that this Record
        builds.

        Raises FileError if a field is invalid. reader: Reader of the file; place: position of the object in the file,
        such as "events[2]".
        """
        tag = Choice(self.records)
        if not isinstance(value, dict) or self.tag not in value:
            reader.fields(place, value, {self.tag: tag}, others=True)
        name = tag.read(reader, join(place, self.tag), value[self.tag])
        record = self.records[name]
        found = reader.fields(place, value, {self.tag: tag, **self.shared, **record.fields})
        return record.make(**found)


class Reader:
    """Reader of one JSON file. Its errors contain the file's path."""

    def __init__(self, path):
        self.path = path

    def fail(self, place, reason):
        """Raise FileError for the position `place` in the file, with a reason."""
        raise FileError(self.path, place, reason)

    def fields(self, place, value, wanted, others=False):
        """Return {name: value} of the fields of the JSON object `value`.

        place: position of the object in the file; wanted: {name: field type}; others: whether unknown fields are
        allowed.
        """
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
    """Return the position of the field `name` of the object at `place` in a file, such as "events[2].at"."""
    return f"{place}.{name}" if place else str(name)


def guess(name, names):
    """Return a question that suggests the entry of `names` most similar to `name`, or "" if none is similar."""
    near = get_close_matches(str(name), list(names), n=1)
    return f"; did you mean {near[0]}?" if near else ""
