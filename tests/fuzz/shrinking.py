"""Reduction of a failing program: fewer lines first, then simpler lines, while it fails in the same way."""

import re

from tests.fuzz.running import failure_of

NUMBER = re.compile(r"(?<![\w.])-?\d+\.?\d*(?:e[-+]?\d+)?(?![\w.])")
ARGUMENT = re.compile(r", (?:\w+=)(?:'[^']*'|[\w.]+(?:\([^()]*\))?|\([^()]*\)|-?[\d.e+-]+)(?=[,)])")


def shrink(lines, failure, strategy=None, tries=4000):
    """Return the lines of a shorter program with the same kind of failure. tries: greatest
    number of programs to run.
    """
    left = [tries]

    def fails(candidate):
        left[0] -= 1
        if left[0] < 0:
            return False
        found = failure_of(candidate, strategy)
        return found is not None and found.kind == failure.kind

    lines = lines[: failure.line + 1]
    before = None
    while lines != before and left[0] > 0:
        before = list(lines)
        lines = fewer_lines(lines, fails)
        lines = shorter_loops(lines, fails)
        lines = simpler_lines(lines, fails)
    return lines


def fewer_lines(lines, fails):
    """Return the lines without those that the failure does not need (delta debugging).

    Groups of successive lines are left out on trial; in each round the groups are half as long. fails: function that
    returns whether a list of lines still fails in the same way.
    """
    size = max(len(lines) // 2, 1)
    while size:
        at = len(lines)
        while at > 0:
            candidate = lines[: max(at - size, 0)] + lines[at:]
            if len(candidate) < len(lines) and candidate and fails(candidate):
                lines = candidate
                at = min(at, len(lines))
            at -= size
        size //= 2
    return lines


def shorter_loops(lines, fails):
    """Return the lines with fewer rounds of each loop; a loop of one round becomes its body."""
    for at, line in enumerate(lines):
        found = re.match(r"for _ in range\((\d+)\): (.*)", line)
        for rounds in (1, 2, 3, 5, 8, 12, 20, 30) if found else ():
            simpler = found[2] if rounds == 1 else f"for _ in range({rounds}): {found[2]}"
            candidate = [*lines[:at], simpler, *lines[at + 1 :]]
            if rounds < int(found[1]) and fails(candidate):
                lines = candidate
                break
    return lines


def simpler_lines(lines, fails):
    """Return the lines without arguments that the failure does not need, and with rounded numbers."""
    for at in range(len(lines)):
        for pattern, simpler in ((ARGUMENT, lambda text: [""]), (NUMBER, _rounder)):
            number = 0
            while True:
                found = [*pattern.finditer(lines[at])]
                if number >= len(found):
                    break
                match = found[number]
                for text in simpler(match[0]):
                    line = lines[at][: match.start()] + text + lines[at][match.end() :]
                    if line != lines[at] and fails([*lines[:at], line, *lines[at + 1 :]]):
                        lines = [*lines[:at], line, *lines[at + 1 :]]
                        number -= text == ""
                        break
                number += 1
    return lines


def _rounder(text):
    value = float(text)
    if "." not in text and "e" not in text:
        return []
    wanted = [0.0, float(round(value, -1)), float(round(value)), float(f"{value:.2g}")]
    return [repr(each) for each in wanted if len(repr(each)) < len(text)]
