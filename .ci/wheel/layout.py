"""Layout of a wheel: the five top-level packages and modules of a checkout become one package, `hitbox`.

Installed under their own names, they would hide a user's own `physics.py` or `game/`. So `stage` copies the sources
into hitbox/ and rewrites their imports without changing line numbers. It raises an error if a name of a top-level
package of the checkout remains: each string that names one must be derived from `__name__` or `__package__`.

An import is rewritten at any position in a source:
    from physics import World           from hitbox.physics import World
    import physics                      from hitbox import physics
    import physics.jit as jit           import hitbox.physics.jit as jit
    import physics.jit                  from hitbox import physics; __import__("hitbox.physics.jit")
Comments, docstrings and relative imports stay as they are. These are refused (see `problems`):
    "game.run.worker", "scenes:SCENES"  a dotted name, or an entry point, within any other string
    f"game.{name}", "game." + name      the beginning of a dotted name to which something is appended
    "import physics", "from game import x"  code to be run
    "python -m game"                    a module to run; also as an item, ["-m", "game"]
    import_module("game")               a single name as an argument of IMPORTERS or in sys.modules[...]
    "python main.py", "pip install -e"  a command that only a checkout has
Text files (TEXT) are searched for the same, except for single names. A name that is not a literal (".".join, a name in
a variable) cannot be found here; the tests of an installed wheel (tests/test_packaging.py) run this code.
"""

import ast
import re
import shutil
import tomllib
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

NAME = "hitbox"
PACKAGES = ("assets", "game", "physics", "scenes")
TOPS = (*PACKAGES, "main")
TEXT = (".json", ".html", ".tmj", ".txt")
IMPORTERS = {"import_module", "__import__", "find_spec", "resolve_name", "run_module", "reload", "get_loader", "files"}

TOP = rf"(?<![\w.\-/])(?:{'|'.join(TOPS)})"
DOTTED = re.compile(rf"{TOP}(?!\.py\b)(?:\.[A-Za-z_]\w*)+")
ENTRY = re.compile(rf"{TOP}:[A-Za-z_]\w*")
BEGINNING = re.compile(rf"{TOP}\.(?=\Z|[%{{])")
STATEMENT = re.compile(rf"\bimport\s+(?:{'|'.join(TOPS)})\b(?!-)|\bfrom\s+(?:{'|'.join(TOPS)})(?:\.\w+)*\s+import\b")
TO_RUN = re.compile(rf"-m\s+(?:{'|'.join(TOPS)})\b")
ANY = re.compile("|".join((*TOPS, "pip install")))
FROM = re.compile(rb"from(?:\s|\\)+")
COMMAND = re.compile(r"\bmain\.py\b|\bpip install (?:\S+ )*-e\b")

# What may stay: (file, string) -> why.
ALLOWED = {
    ("game/startup.py", "main.py"): "told in a checkout only, by IN_CHECKOUT",
    ("game/startup.py", "python -m pip install -e "): "told in a checkout only, by IN_CHECKOUT",
}

INIT = f'''"""2D collision you can feel, trust and see. `from {NAME}.physics import World`; `{NAME}` is the arcade."""

from {NAME}.game import VERSION as __version__

__all__ = ["__version__"]
'''
MAIN = f'''"""`python -m {NAME}`: the arcade, as the command `{NAME}`."""

import sys

from {NAME}.main import main

if __name__ == "__main__":
    sys.exit(main())
'''


class Problem(NamedTuple):
    """A module name of the checkout that a wheel must not contain, with its file and line."""

    path: str
    line: int
    text: str

    def __str__(self) -> str:
        return f"{self.path}:{self.line}: {self.text}"


class LayoutError(Exception):
    """Error: names of top-level packages of the checkout remain in the sources; the message lists them."""


def stage(source: Path, target: Path) -> None:
    """Write a project into `target` whose package hitbox contains the sources of the checkout `source`.

    setuptools can build the project unchanged. Raises LayoutError with all module names of the checkout that remain.
    """
    settings = tomllib.loads((source / "pyproject.toml").read_text(encoding="utf-8"))
    patterns = settings["tool"]["setuptools"]["package-data"]
    found: list[Problem] = []
    for path in shipped(source, patterns):
        name = path.relative_to(source).as_posix()
        place = target / NAME / name
        place.parent.mkdir(parents=True, exist_ok=True)
        if path.suffix == ".py":
            text, left = converted(path.read_text(encoding="utf-8"), name)
            place.write_text(text, encoding="utf-8", newline="\n")
            found += left
        else:
            shutil.copyfile(path, place)
            found += text_problems(path, name)
    if found:
        listed = "\n".join(map(str, found))
        raise LayoutError(f"{len(found)} names of the checkout's layout would be wrong in a wheel:\n{listed}")
    stage_metadata(source, target)


def stage_metadata(source: Path, target: Path) -> None:
    """Write the files of the staged project besides the sources, which are enough for its metadata."""
    settings = tomllib.loads((source / "pyproject.toml").read_text(encoding="utf-8"))
    (target / NAME / "game").mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source / "game/__init__.py", target / NAME / "game/__init__.py")  # has the version
    for name, text in (("__init__.py", INIT), ("__main__.py", MAIN), ("py.typed", "")):
        (target / NAME / name).write_text(text, encoding="utf-8")
    (target / "pyproject.toml").write_text(project(source), encoding="utf-8")
    for name in (settings["project"]["readme"], *settings["project"]["license-files"]):
        shutil.copyfile(source / name, target / name)


def shipped(source: Path, patterns: dict[str, list[str]]) -> Iterator[Path]:
    """Yield the paths of a wheel's files: main.py, and the modules and pattern matches of each package.

    patterns: {package: glob patterns} of package-data.
    """
    yield source / "main.py"
    for package in PACKAGES:
        folder = source / package
        yield from sorted(path for path in folder.rglob("*.py") if "__pycache__" not in path.parts)
        yield from sorted({path for pattern in patterns.get(package, ()) for path in folder.glob(pattern)})


def project(source: Path) -> str:
    """Return the text of the staged project's pyproject.toml: the checkout's metadata, with one package instead of
    five.
    """
    text = (source / "pyproject.toml").read_text(encoding="utf-8")
    metadata = text[text.index("[project]") : text.index("[tool.setuptools")]
    if metadata.count('"main:main"') != 1:
        raise LayoutError("pyproject.toml: [project.scripts] must start main:main, once")
    return (
        metadata.replace('"main:main"', f'"{NAME}.main:main"')
        + f'[tool.setuptools.dynamic]\nversion = {{ attr = "{NAME}.game.VERSION" }}\n\n'
        + "[tool.setuptools]\ninclude-package-data = false\n\n"
        + f'[tool.setuptools.packages.find]\ninclude = ["{NAME}*"]\nnamespaces = false\n\n'
        + f'[tool.setuptools.package-data]\n{NAME} = ["**/*"]\n'
    )


def converted(text: str, path: str = "") -> tuple[str, list[Problem]]:
    """Return (source of a module as in a wheel, problems: the checkout's names that remain). Line numbers do not
    change.
    """
    nodes = list(ast.walk(ast.parse(text)))  # once: parsing is what a build spends its time on
    return _rewritten(text, nodes, path), _problems(nodes, path)


def _rewritten(text, nodes, path):
    source = text.encode()
    starts = [0, *(match.end() for match in re.finditer(rb"\n", source))]  # of lines
    edits = []  # (begin, end, bytes to be there)
    for node in nodes:
        if isinstance(node, ast.ImportFrom) and not node.level and _is_top(node.module or ""):
            begin = starts[node.lineno - 1] + node.col_offset
            module = FROM.match(source, begin)
            assert module is not None
            edits.append((module.end(), module.end(), f"{NAME}.".encode()))
        elif isinstance(node, ast.Import) and any(_is_top(alias.name) for alias in node.names):
            begin = starts[node.lineno - 1] + node.col_offset
            end = starts[(node.end_lineno or 0) - 1] + (node.end_col_offset or 0)
            more = b" \\\n" * source.count(b"\n", begin, end)
            edits.append((begin, end, "; ".join(map(_import, node.names)).encode() + more))
    for begin, end, new in sorted(edits, reverse=True):
        source = source[:begin] + new + source[end:]
    return source.decode()


def _problems(nodes, path):
    told = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}  # docstrings
    strings = [
        node
        for node in nodes
        if isinstance(node, ast.Constant) and isinstance(node.value, (str, bytes)) and id(node) not in told
    ]
    asked = {id(item) for node in nodes for item in _asked_for(node)}
    begun = {id(item) for node in nodes for item in _begun(node)}
    found = []
    for node in strings:
        words = node.value if isinstance(node.value, str) else node.value.decode("latin-1")
        wrong = _name_in(words)
        if not wrong and id(node) in asked and words in TOPS:
            wrong = words
        if not wrong and id(node) in begun and (beginning := BEGINNING.search(words)):
            wrong = beginning[0]
        if wrong and (path, words) not in ALLOWED:
            found.append(Problem(path, node.lineno, f"{wrong!r} in {words!r:.80}"))
    return found


def text_problems(path: Path, name: str) -> list[Problem]:
    """Return the problems in a text file: module names of the checkout. name: path of the file in the problems."""
    if path.suffix not in TEXT:
        return []
    lines = path.read_text(encoding="utf-8").splitlines()
    return [Problem(name, k, repr(wrong)) for k, line in enumerate(lines, 1) if (wrong := _name_in(line))]


def _is_top(name):
    return name.split(".")[0] in TOPS


def _import(alias):
    """Return the statement for a wheel that binds the same name as `import name [as other]`."""
    name, other = alias.name, alias.asname
    top = name.split(".")[0]
    if top not in TOPS or other:
        return f"import {f'{NAME}.{name}' if top in TOPS else name}{f' as {other}' if other else ''}"
    return f"from {NAME} import {top}" + (f'; __import__("{NAME}.{name}")' if "." in name else "")


def _name_in(words):
    """Return the first module name of the checkout in a string, "" if there is none."""
    if not ANY.search(words):
        return ""
    found = next(filter(None, (rule.search(words) for rule in (DOTTED, ENTRY, STATEMENT, TO_RUN, COMMAND))), None)
    return found[0] if found else ""


def _asked_for(node):
    """Yield the expressions in a node that denote a module: arguments of IMPORTERS, keys of sys.modules, items after
    "-m".
    """
    if isinstance(node, ast.Call):
        function = node.func
        name = function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")
        if name in IMPORTERS or (isinstance(function, ast.Attribute) and _is_modules(function.value)):
            yield from (*node.args, *(keyword.value for keyword in node.keywords))
    elif isinstance(node, ast.Subscript) and _is_modules(node.value):
        yield node.slice
    elif isinstance(node, ast.Compare) and any(map(_is_modules, node.comparators)):
        yield node.left
    items = getattr(node, "elts", None) or getattr(node, "args", None)
    if isinstance(items, list):
        for before, item in pairwise(items):
            if isinstance(before, ast.Constant) and before.value == "-m":
                yield item


def _is_modules(node):
    return isinstance(node, ast.Attribute) and node.attr == "modules"


def _begun(node):
    """Yield the strings in a node to which something is appended: in an f-string, left of + and %, before .format."""
    if isinstance(node, ast.JoinedStr):
        yield from (part for part, _ in pairwise(node.values))
    elif isinstance(node, ast.BinOp):
        yield node.left
        if isinstance(node.left, ast.BinOp):
            yield node.left.right
    elif isinstance(node, ast.Attribute):
        yield node.value
