"""Changes of one operator in a kernel's syntax tree, which simulate slips in programming.

A change is identified by the kernel's name, a kind and a seed. The seed picks one of the positions at which this kind
is possible, in the order of the source. A change is therefore still found after its kernel moves or its variables are
renamed.
"""

import ast
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from random import Random

from physics.jit import DECORATORS

EDGES = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt}
TURNS = {ast.Lt: ast.Gt, ast.Gt: ast.Lt, ast.LtE: ast.GtE, ast.GtE: ast.LtE, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq}
SIGNS = {ast.Add: ast.Sub, ast.Sub: ast.Add}
FACTORS = {ast.Mult: ast.Div, ast.Div: ast.Mult}


def is_number(node):
    """Return whether a node is a numeric literal; True and False do not count."""
    return isinstance(node, ast.Constant) and isinstance(node.value, (int, float)) and not isinstance(node.value, bool)


KINDS = {  # name -> (whether a node can be changed so, the change in place)
    "edge": (  # < to <=
        lambda node: isinstance(node, ast.Compare) and type(node.ops[0]) in EDGES,
        lambda node: node.ops.__setitem__(0, EDGES[type(node.ops[0])]()),
    ),
    "turn": (  # < to >, == to !=
        lambda node: isinstance(node, ast.Compare) and type(node.ops[0]) in TURNS,
        lambda node: node.ops.__setitem__(0, TURNS[type(node.ops[0])]()),
    ),
    "sign": (  # + to -
        lambda node: isinstance(node, (ast.BinOp, ast.AugAssign)) and type(node.op) in SIGNS,
        lambda node: setattr(node, "op", SIGNS[type(node.op)]()),
    ),
    "factor": (  # * to /
        lambda node: isinstance(node, (ast.BinOp, ast.AugAssign)) and type(node.op) in FACTORS,
        lambda node: setattr(node, "op", FACTORS[type(node.op)]()),
    ),
    "number": (  # 0 to 1, 0.5 to 0.75
        is_number,
        lambda node: setattr(node, "value", node.value + 1 if isinstance(node.value, int) else 1.5 * node.value or 1.0),
    ),
    "side": (  # min to max
        lambda node: isinstance(node, ast.Name) and node.id in ("min", "max"),
        lambda node: setattr(node, "id", {"min": "max", "max": "min"}[node.id]),
    ),
    "both": (  # and to or
        lambda node: isinstance(node, ast.BoolOp),
        lambda node: setattr(node, "op", ast.Or() if isinstance(node.op, ast.And) else ast.And()),
    ),
    "minus": (  # -x to x
        lambda node: isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub) and not is_number(node.operand),
        lambda node: setattr(node, "op", ast.UAdd()),
    ),
}


@dataclass(frozen=True)
class Change:
    """Source of a kernel's file with one operator changed. before, after: the changed line."""

    path: Path  # within the folder that was searched
    line: int
    before: str
    after: str
    source: str


@cache
def sources_in(folder):
    """Return a list of (path, source) of all modules in a folder."""
    return [(path, path.read_text()) for path in sorted(folder.rglob("*.py"))]


def find_kernel(folder, name):
    """Return (path, source, node) of a kernel. Raises LookupError unless there is exactly one with this name.

    name: the kernel's name, or "module.name" if several modules have a kernel of this name.
    """
    found = []
    module, _, name = name.rpartition(".")
    for path, source in sources_in(folder):
        if module not in ("", path.stem):
            continue
        if f"def {name}(" in source:
            found += [(path, source, node) for node in ast.walk(ast.parse(source)) if is_kernel(node, name)]
    if len(found) != 1:
        raise LookupError(f"{len(found)} kernels called {name} in {folder}: {[str(path) for path, *_ in found]}")
    return found[0]


def is_kernel(node, name):
    """Return whether a node is the definition of a kernel, of any kind, with this name."""
    marks = [each.id for each in getattr(node, "decorator_list", ()) if isinstance(each, ast.Name)]
    return isinstance(node, ast.FunctionDef) and node.name == name and bool(set(DECORATORS) & set(marks))


def places(function, kind):
    """Return the nodes of a kernel at which a change of this kind is possible, in the order of the source.

    Argument defaults and the docstring are left out.
    """
    possible, _ = KINDS[kind]
    found = [node for statement in function.body for node in ast.walk(statement) if possible(node)]
    return sorted(found, key=lambda node: (node.lineno, node.col_offset, node.end_lineno, node.end_col_offset))


def change(folder, name, kind, seed):
    """Return the Change of a kind that the seed picks in a kernel. Raises LookupError if none is possible."""
    path, source, function = find_kernel(folder, name)
    nodes = places(function, kind)
    if not nodes:
        raise LookupError(f"{name} has no place for a change of kind {kind!r}")
    node = Random(seed).choice(nodes)
    statement = innermost_statement(function, node)
    before = ast.unparse(statement).splitlines()[0]
    KINDS[kind][1](node)
    lines = source.splitlines()
    first = min([function.lineno, *(each.lineno for each in function.decorator_list)])
    indent = " " * function.col_offset
    changed = [indent + line for line in ast.unparse(function).splitlines()]
    lines[first - 1 : function.end_lineno] = changed
    return Change(path, node.lineno, before, ast.unparse(statement).splitlines()[0], "\n".join(lines) + "\n")


def innermost_statement(function, node):
    """Return the innermost statement of a function that contains a node."""
    holding = [each for each in ast.walk(function) if isinstance(each, ast.stmt) and node in ast.walk(each)]
    return holding[-1]
