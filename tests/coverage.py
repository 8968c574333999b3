"""Lines of physics/ that the tests run, with kernels as Python. Every other line has a reason or is reported as a hole.

In an environment without numba, where kernels run as plain Python:

    python -m slipcover --source physics --json --out A.json -m pytest -m "not nightly" tests/physics
    python -m tests.coverage A.json B.json        # B.json of other tests; writes docs/coverage.*

Source of the counting: Altmayer Pizzorno and Berger, SlipCover: Near Zero-Overhead Code Coverage for Python, 2023.
"""

import json
import re
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
KEPT, PAGE = ROOT / "docs/coverage.json", ROOT / "docs/coverage.md"
ASKED = 95.0  # percent of all lines

BLOCKS = "without numba a block is one lane wide: no remainder"
# What no test without numba runs: where, what the line says (a pattern), and why. The first that fits.
EXPLAINED = (
    ("physics/background.py", "", "compiling beside the program: there is nothing to compile without numba"),
    ("physics/compile_worker.py", "", "a compiling process: never started without numba"),
    ("physics/jit/compiling.py", "", "numba itself: never imported without it"),
    ("physics/jit/content.py", "", "names of compiled code: there is none"),
    ("physics/jit/plain.py", "", "numba's words of 64 bits: here they are Python's numbers"),
    ("physics/jit/", "", "with numba, or with numba switched off"),
    ("physics/solver/lanes.py", "", BLOCKS),
    ("physics/solver/contact_lanes.py", "^continue$", BLOCKS),
    ("physics/", r"^\.\.\.$", "the body of a Protocol's method, which is never called"),
    ("physics/", "CAP_HITS|CAPPED", "a bound on iterations that no case reaches: it would be counted"),
    ("physics/", "raise RuntimeError", "an internal error"),
    ("physics/", 'raise |^f"', "an argument check after another one"),
    ("physics/ccd/mask_sweep.py", "", "ground that moves past a mask: swept by compiled tests only"),
    ("physics/islands/sleep", "", "an island that names a body of another, sleeping one: not reached"),
    ("physics/islands/awake.py", "", "the remains of a step that failed in the middle: not reached"),
    ("physics/outline/rings.py", "", "rings with more corners than a sprite has, closed, or in a line"),
    ("physics/outline/", "", "degenerate outlines, which no sprite has"),
    ("physics/broadphase/", "", "boxes of a cell's size on its borders, trees of one leaf, queries of the whole world"),
    ("physics/queries/pairs.py", "", "a box that grazes while it rotates: continued from a fraction of the path"),
    (
        "physics/queries/casts.py",
        "",
        "a cast of zero length that begins in an overlap with a mask, or has no hit at its end",
    ),
    ("physics/collision/mask_parts.py", "", "a disc among the parts of one sprite, separated with the others"),
    ("physics/collision/chains.py", "", "a Bounds that overlapped a one-way mask a step ago"),
    ("physics/collision/masks.py", "", "a hull surrounded by pixels, without an edge that may push"),
    ("physics/step.py", "", "a target of a disabled body: it does not wake"),
    (
        "physics/ccd/time_of_impact.py",
        "",
        "a fast shape by its ray against a fast, swept one: not reached without numba",
    ),
    ("physics/queries/casts.py", "", "the disc among the parts of a sprite's outline, hit by a ray before the others"),
    ("physics/", "^(return|continue|break)", "degenerate input (no length, no area, no neighbour)"),
    ("physics/collision/", "", "a contact at the border of two cases, decided by rounding: not reached without numba"),
    ("physics/character/", "", "a walk squeezed or carried from two sides in one step: not reached without numba"),
    ("physics/distance/", "", "a simplex made flat by rounding: not reached without numba"),
)


def merged(reports: list[dict]) -> dict[str, dict]:
    """Return SlipCover's reports as {path: {"lines": number of lines, "missing": [[number, text], ...]}}."""
    run: dict[str, set[int]] = {}
    known: dict[str, set[int]] = {}
    for report in reports:
        for path, file in report["files"].items():
            run.setdefault(path, set()).update(file["executed_lines"])
            known.setdefault(path, set()).update(file["executed_lines"], file["missing_lines"])
    found = {}
    for path in sorted(known):
        text = (ROOT / path).read_text(encoding="utf-8").splitlines()
        missing = [[number, text[number - 1].strip()] for number in sorted(known[path] - run[path])]
        found[path] = {"lines": len(known[path]), "missing": missing}
    return found


def kept() -> dict[str, dict]:
    """Return the last stored measurement, in the form of `merged`."""
    return json.loads(KEPT.read_text(encoding="utf-8"))


def why(path: str, text: str) -> str | None:
    """Return the reason why no test runs a line of a file, or None if there is no reason."""
    return next((reason for where, what, reason in EXPLAINED if path.startswith(where) and re.search(what, text)), None)


def share(files: dict[str, dict]) -> float:
    """Return the percentage of all lines that the tests run."""
    lines = sum(file["lines"] for file in files.values())
    return 100.0 * (1.0 - sum(len(file["missing"]) for file in files.values()) / lines)


def unexplained(files: dict[str, dict]) -> list[str]:
    """Return "path:number: text" for each line that no test runs and that has no reason."""
    return [
        f"{path}:{number}: {text}"
        for path, file in files.items()
        for number, text in file["missing"]
        if why(path, text) is None
    ]


def page(files: dict[str, dict]) -> str:
    """Return the text of docs/coverage.md."""
    lines = sum(file["lines"] for file in files.values())
    missing = sum(len(file["missing"]) for file in files.values())
    rows = [
        f"| {path} | {file['lines']} | {len(file['missing'])} | {'; '.join(_reasons(path, file))} |"
        for path, file in files.items()
        if file["missing"]
    ]
    return "\n".join(
        [
            "# Lines that the tests run",
            "",
            f"Of {lines:,} lines of `physics/` the tests run {lines - missing:,}, that is {share(files):.1f} %, with",
            "the kernels as plain Python (no numba). The table gives the reasons for the other lines. This page is",
            "generated: see [tests/coverage.py](../tests/coverage.py).",
            "",
            "| file | lines | not run | why |",
            "|---|---|---|---|",
            *rows,
            "",
        ]
    )


def _reasons(path, file):
    return dict.fromkeys(why(path, text) or "**no reason given**" for _, text in file["missing"])


def main(arguments: list[str]) -> int:
    """Merge SlipCover reports into docs/coverage.json and write the page; without arguments only write the page.

    Returns 1 if a line is a hole or the share is too small, else 0.
    """
    if arguments:
        files = merged([json.loads(Path(each).read_text(encoding="utf-8")) for each in arguments])
        KEPT.write_text(json.dumps(files, indent=0) + "\n", encoding="utf-8")
    files = kept()
    PAGE.write_text(page(files), encoding="utf-8")
    holes = unexplained(files)
    sys.stdout.write("".join(f"{each}\n" for each in holes))
    sys.stdout.write(f"{share(files):.2f} % of the lines are run; {len(holes)} are neither run nor explained\n")
    return 1 if holes or share(files) < ASKED else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
