"""Folders, modules and imports of the project, read from the source; `python -m tests.architecture` prints them."""

import ast
from collections import defaultdict
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TOPS = ("physics", "game", "scenes", "assets")
# Import order: each folder may import those to its left, and itself.
PHYSICS = (
    "jit",
    "annotations",
    "math2d",
    "settings",
    "hints",
    "checks",
    "tables",
    "raster",
    "outline",
    "shapes",
    "islands",
    "dynamics",
    "broadphase",
    "distance",
    "collision",
    "contacts",
    "ccd",
    "solver",
    "queries",
    "character",
)


def sources(folder: str) -> list[Path]:
    """Return the paths of all Python files in a top folder, sorted."""
    return sorted((ROOT / folder).rglob("*.py"))


def name_of(path: Path) -> str:
    """Return the dotted name of a module; an `__init__.py` gets the name of its package."""
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


def is_module(name: str) -> bool:
    """Return whether a dotted name is a file or a package of the project."""
    path = ROOT.joinpath(*name.split("."))
    return path.with_suffix(".py").is_file() or (path / "__init__.py").is_file()


@cache
def imports_of(path: Path) -> frozenset[str]:
    """Return the full names of the modules that a file imports, at any depth of its code.

    `from p import m` gives p.m if that is a module, otherwise p.
    """
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            package = path.relative_to(ROOT).parts[: -node.level] if node.level else ()
            module = ".".join((*package, *filter(None, [node.module])))
            for alias in node.names:
                inner = f"{module}.{alias.name}"
                found.add(inner if is_module(inner) else module)
    return frozenset(found)


def graph(folder: str) -> dict[str, set[str]]:
    """Return {module: the modules of the same top folder that it imports}."""
    return {
        name_of(path): {each for each in imports_of(path) if each.split(".")[0] == folder and each != name_of(path)}
        for path in sources(folder)
    }


def circles(edges: dict[str, set[str]]) -> list[list[str]]:
    """Return the sorted sets of two or more nodes that reach each other (strongly connected components, Tarjan
    1972).
    """
    order, low, stack, found = {}, {}, [], []

    def visit(node):
        order[node] = low[node] = len(order)
        stack.append(node)
        for other in sorted(edges.get(node, ())):
            if other not in order:
                visit(other)
                low[node] = min(low[node], low[other])
            elif other in stack:
                low[node] = min(low[node], order[other])
        if low[node] == order[node]:
            at = stack.index(node)
            if len(stack) - at > 1:
                found.append(sorted(stack[at:]))
            del stack[at:]

    for node in sorted(edges):
        if node not in order:
            visit(node)
    return sorted(found)


def part_of(name: str) -> str:
    """Return the part of physics to which a module belongs: its subfolder or module in PHYSICS, or "root"."""
    parts = name.split(".")
    return parts[1] if len(parts) > 1 and parts[1] in PHYSICS else "root"


def parts_graph() -> dict[str, set[str]]:
    """Return {part of physics: set of the parts that it imports}."""
    found = defaultdict(set)
    for name, others in graph("physics").items():
        found[part_of(name)] |= {part_of(each) for each in others} - {part_of(name)}
    return dict(found)


def folder_of(name: str) -> str:
    """Return the folder of a module, such as "physics/solver"."""
    path = ROOT.joinpath(*name.split("."))
    return str((path if path.is_dir() else path.parent).relative_to(ROOT))


def report() -> str:
    """Return a report of the tree: each folder with the folders that it imports, then the import circles."""
    lines = []
    for top in TOPS:
        folders = defaultdict(lambda: [0, 0, set()])
        for path in sources(top):
            row = folders[folder_of(name_of(path))]
            row[0] += 1
            row[1] += len(path.read_text().splitlines())
            row[2] |= {folder_of(each) for each in imports_of(path) if each.split(".")[0] in TOPS}
        for folder, (files, length, others) in sorted(folders.items()):
            listed = ", ".join(sorted(others - {folder})) or "nothing of ours"
            lines.append(f"{folder:28} {files:3} files {length:6} lines   imports {listed}")
        found = circles(graph(top))
        lines.append(f"{top}: {'no circle' if not found else 'circles: ' + '; '.join(' <-> '.join(c) for c in found)}")
        lines.append("")
    return "\n".join(lines)


if __name__ == "__main__":
    print(report())
