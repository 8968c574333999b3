"""`python -m tests.reference`: write docs/reference.md; `--check`: report whether it is up to date, and the
differences.
"""

import sys

from tests.reference.page import PAGE, page


def differences(old: str, new: str) -> list[str]:
    """Return a text for each line in which two texts differ: line number and both lines."""
    before, after = old.split("\n"), new.split("\n")
    found = [f"{k}: {a!r} -> {b!r}" for k, (a, b) in enumerate(zip(before, after, strict=False), 1) if a != b]
    if len(before) != len(after):
        found.append(f"{min(len(before), len(after)) + 1}: {len(before)} lines -> {len(after)}")
    return found


def main(arguments: list[str]) -> int:
    """Write the page, or compare it. Return 0 if it is up to date, 1 if not, 2 for a wrong argument."""
    if arguments not in ([], ["--check"]):
        print("python -m tests.reference [--check]")
        return 2
    wanted = page()
    if not arguments:
        PAGE.write_text(wanted, encoding="utf-8")
        return 0
    found = differences(PAGE.read_text(encoding="utf-8"), wanted)
    print("\n".join(f"docs/reference.md:{each}" for each in found[:20]) or "docs/reference.md is up to date")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
