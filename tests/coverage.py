"""Which lines of physics/ the tests run, kernels as Python; what none of them runs is explained, or is a hole.

In an environment without numba, where kernels are the Python that they are written in:

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

BLOCKS = "without numba a block is one lane wide: none is left over"
# What no test without numba runs: where, what the line says (a pattern), and why. The first that fits.
EXPLAINED = (
    ("physics/background.py", "", "compiling beside the program: there is nothing to compile without numba"),
    ("physics/compile_worker.py", "", "a process that compiles: never started without numba"),
    ("physics/jit/compiling.py", "", "numba itself: never imported without it"),
    ("physics/jit/content.py", "", "names of what is compiled: nothing is"),
    ("physics/jit/plain.py", "", "words of 64 bits as numba has them: here they are Python's numbers"),
    ("physics/jit/", "", "where numba is, or is switched off"),
    ("physics/solver/lanes.py", "", BLOCKS),
    ("physics/solver/contact_lanes.py", "^continue$", BLOCKS),
    ("physics/solver/substeps.py", "^continue$", BLOCKS),
    ("physics/", r"^\.\.\.$", "the body of a Protocol's method, which nobody calls"),
    ("physics/", "CAP_HITS|CAPPED", "a bound on rounds that no case has reached: it would be counted"),
    ("physics/", "raise RuntimeError", "a defect of ours, which would be told as one"),
    ("physics/", 'raise |^f"', "a refusal that stands behind another one"),
    ("physics/ccd/mask_sweep.py", "", "ground that moves past a mask: compiled tests alone sweep it"),
    ("physics/islands/sleep", "", "an island that names a body of another one, which sleeps by itself: not met"),
    ("physics/islands/awake.py", "", "what a step left that failed in the middle: not met"),
    ("physics/outline/rings.py", "", "rings with more corners than a sprite has, handed in closed, or in a line"),
    ("physics/outline/", "", "degenerate outlines: the way out, which no sprite takes"),
    (
        "physics/broadphase/",
        "",
        "boxes of a cell's size on its borders, trees of one leaf, all the world asked at once",
    ),
    ("physics/queries/pairs.py", "", "a box that grazes while it turns: looked on from a share of the way"),
    (
        "physics/queries/casts.py",
        "",
        "a cast of no length that begins in an overlap with a mask, or meets nothing at its end",
    ),
    ("physics/collision/mask_parts.py", "", "a disc among the parts of one sprite, led out with the others"),
    ("physics/collision/chains.py", "", "a Bounds that stood across a one-way mask a step ago"),
    ("physics/collision/masks.py", "", "a hull within pixels all round, none of whose edges may push"),
    ("physics/step.py", "", "a target for what is put aside: it is told to wake and does not"),
    (
        "physics/ccd/time_of_impact.py",
        "",
        "a fast shape by its ray against a fast one that is swept: not met without numba",
    ),
    ("physics/queries/casts.py", "", "the disc among the parts of a sprite's outline, met by a ray before the others"),
    ("physics/", "^(return|continue|break)", "the way out of what is degenerate (no length, no area, nothing near)"),
    ("physics/collision/", "", "a contact at the border of two cases, which rounding decides: not met without numba"),
    ("physics/character/", "", "a walk squeezed or carried from two sides in one step: not met without numba"),
    ("physics/distance/", "", "a simplex that rounding has made flat: not met without numba"),
)


def merged(reports: list[dict]) -> dict[str, dict]:
    """{path: {"lines": how many, "missing": [[number, text], ...]}} of SlipCover's reports, by path."""
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
    """Return the last measurement, in the form of `merged`."""
    return json.loads(KEPT.read_text(encoding="utf-8"))


def why(path: str, text: str) -> str | None:
    """Return the reason why no test runs a line; None without one."""
    return next((reason for where, what, reason in EXPLAINED if path.startswith(where) and re.search(what, text)), None)


def share(files: dict[str, dict]) -> float:
    """Percent of all lines that are run."""
    lines = sum(file["lines"] for file in files.values())
    return 100.0 * (1.0 - sum(len(file["missing"]) for file in files.values()) / lines)


def unexplained(files: dict[str, dict]) -> list[str]:
    """Return path:number: text of the lines that no test runs and no reason covers."""
    return [
        f"{path}:{number}: {text}"
        for path, file in files.items()
        for number, text in file["missing"]
        if why(path, text) is None
    ]


def page(files: dict[str, dict]) -> str:
    """docs/coverage.md."""
    lines = sum(file["lines"] for file in files.values())
    missing = sum(len(file["missing"]) for file in files.values())
    rows = [
        f"| {path} | {file['lines']} | {len(file['missing'])} | {'; '.join(_reasons(path, file))} |"
        for path, file in files.items()
        if file["missing"]
    ]
    return "\n".join(
        [
            "# Which lines the tests run",
            "",
            f"Of {lines:,} lines of `physics/` the tests run {lines - missing:,}, that is {share(files):.1f} %, with",
            "the kernels as the Python that they are written in (no numba). Why the others are not run stands beside",
            "them. This page is written, not edited: see [tests/coverage.py](../tests/coverage.py).",
            "",
            "| file | lines | not run | why |",
            "|---|---|---|---|",
            *rows,
            "",
        ]
    )


def _reasons(path, file):
    return dict.fromkeys(why(path, text) or "**nobody has said**" for _, text in file["missing"])


def main(arguments: list[str]) -> int:
    """Merge reports into docs/coverage.json and the page; without any write the page anew. 1 where a line is a hole."""
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
