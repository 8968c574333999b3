"""Rules of the kernel dialect, checked on the syntax tree: code that keeps them gives equal bits compiled and plain."""

import ast
from functools import cache
from pathlib import Path

import pytest

from physics.jit import DECORATORS
from tests.kernel_writes import undeclared_writes, writes_of

ROOT = Path(__file__).resolve().parent.parent
BANNED_CALLS = {"math.hypot", "math.fmod", "np.bitwise_count", "math.pow", "math.dist", "math.fsum"}
KERNEL_LINES, LONG_LINES = 60, 120
LONG = {
    "collide_grid_pair",
    "find_impacts",
    "find_in_cells",
    "place_changed",
    "compare_pairs",
    "project",
    "clip_edges",
    "collide_mask_polygon",
    "collide_chain_pair",
    "update_rectangles",
    "classify",
    "collide_mask_circle",
    "sweep_grid",
    "sweep_pair",
    "tile_at",
    "rebuild",
    "solve_soft",
    "solve_sequential",
    "prepare_constraints",
    "find_rotational_impacts",
}  # colliders, solver passes, broad phases


def decorated(node):
    return any((each.id if isinstance(each, ast.Name) else "") in DECORATORS for each in node.decorator_list)


@cache
def kernels():
    """Return (path, function node) of every kernel in physics/."""
    found = []
    for path in sorted((ROOT / "physics").rglob("*.py")):
        if path.parent.name == "jit":
            continue
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.FunctionDef) and decorated(node):
                found.append((path, node))
    return found


def at(path, node):
    return f"{path.relative_to(ROOT)}:{node.lineno}"


def test_there_are_kernels():
    assert len(kernels()) > 60


def test_no_power_operator_and_no_banned_call():
    for path, function in kernels():
        for node in ast.walk(function):
            assert not (isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow)), (
                f"{at(path, node)}: ** differs compiled"
            )
            if isinstance(node, ast.Call):
                name = ast.unparse(node.func)
                assert name not in BANNED_CALLS and not name.endswith(".bit_count"), f"{at(path, node)} calls {name}"


def test_no_objects_allocation_or_exceptions():
    for path, function in kernels():
        for node in ast.walk(function):
            assert not isinstance(
                node,
                (
                    ast.Dict,
                    ast.List,
                    ast.Set,
                    ast.ListComp,
                    ast.DictComp,
                    ast.Try,
                    ast.Raise,
                    ast.Lambda,
                    ast.JoinedStr,
                    ast.With,
                ),
            ), f"{at(path, node)}: {type(node).__name__} in a kernel"
            if isinstance(node, ast.Call):
                name = ast.unparse(node.func)
                assert not name.startswith("np."), f"{at(path, node)} calls {name}: plain loops over scalars only"


def test_shifts_of_words_stay_in_bits():
    """Only raster/bits.py shifts words or shifts by word counts; elsewhere shifts are of integers below 2^63."""
    for path, function in kernels():
        if path.name == "bits.py":
            continue
        for node in ast.walk(function):
            if isinstance(node, ast.BinOp) and isinstance(node.op, (ast.LShift, ast.RShift)):
                assert "words" not in ast.unparse(node), f"{at(path, node)} shifts a word: use raster/bits.py"


# Above zero by validation or by what it counts: tile and cell sizes, numbers of corners and buckets, a full mask's
# area, the length of what has been scaled to one.
ABOVE_ZERO = {
    "admitted.piece",
    "g.tile_size",
    "size",
    "tile_size",
    "buckets",
    "count",
    "TAU",
    "base * (1 << level)",
    "area",
    "1.0 + c[at.RESTITUTION + lane]",
    "1.0 + drag_rate * dt",
    "1.0 + drag_rate * h",
    "1.0 + stiffness * spring.grip",
    "1.0 + grip",
    "1.0 + context.joint.grip",
    "accuracy",
    "FADING",
    "SLACK",
    "SLOW",
    "PART",
    "path.count",  # an outline's path has runs and cracks
    "path.cracks",
    "steps + 1.0",
    "U_2",
    "SPREAD",
    "effective",
    "length",
    "largest",
}


def names_in(node):
    return {ast.unparse(each) for each in ast.walk(node) if isinstance(each, (ast.Name, ast.Attribute))}


def test_divisors_are_guarded():
    """Each divisor in a kernel is a constant, is validated to be above zero, or is compared in the same function."""
    for path, function in kernels():
        compared = set().union(*(names_in(node) for node in ast.walk(function) if isinstance(node, ast.Compare)), set())
        for node in ast.walk(function):
            if isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Div, ast.FloorDiv, ast.Mod)):
                divisor = ast.unparse(node.right)
                constant = not names_in(node.right) - {"math.tau", "math"}
                assert constant or divisor in ABOVE_ZERO or names_in(node.right) & compared, (
                    f"{at(path, node)} divides by {divisor}, which nothing in {function.name} compares: guard it"
                )


def test_arguments_without_defaults_and_outputs_last():
    for path, function in kernels():
        arguments = [each.arg for each in function.args.args]
        assert not function.args.defaults and not function.args.kwonlyargs, f"{at(path, function)} has defaults"
        written = [name.endswith(("_out", "_inout")) for name in arguments]
        mixed = {
            "found",
            "n",
            "scratch",
            "workspace",
            "rows",
            "pushed_rows",
            "without",
            "room",
            "cuts",
        }  # a running count and scratch room
        first = written.index(True) if True in written else len(written)
        for name, is_written in zip(arguments[first:], written[first:], strict=True):
            assert is_written or name in mixed, f"{at(path, function)}: {name} stands behind an output"


# Kernels that write an argument which does not say so by its name. The list must shrink, and it fails when it could.
UNDECLARED = {}


def test_only_named_arguments_are_written():
    """A kernel writes only arguments whose names end in _out or _inout, and workspaces.

    Writes into tables, through their rows and by passing arguments on are included.
    """
    parameters = {function.name: [each.arg for each in function.args.args] for _, function in kernels()}
    found = {}
    for path, function in kernels():
        for line, argument in writes_of(function, parameters):
            found.setdefault(function.name, set()).add(argument)
            assert argument in UNDECLARED.get(function.name, ()), (
                f"{path.relative_to(ROOT)}:{line}: {function.name} writes {argument}, whose name does not say so"
            )
    assert found == UNDECLARED, "what has been mended is to be taken off the list"


PARAMETERS = {"swap": ["count", "rows_inout"], "look": ["rows", "i"]}


@pytest.mark.parametrize(
    "body, written",
    [
        ("bodies[i].vx = 0.0", {"bodies"}),
        ("bodies[i] = 0.0", {"bodies"}),
        ("bodies[i, 0] += h", {"bodies"}),
        ("b = bodies[i]; b.vx += h", {"bodies"}),
        ("b = bodies[i]; other = b; other.vx = h", {"bodies"}),
        ("a, b = bodies[i], bodies_inout[i]; a.vx = h", {"bodies"}),
        ("a, b = bodies[i], bodies_inout[i]; b.vx = h", set()),
        ("(a, (b, c)) = h, (1, bodies[i]); c.vx = h", {"bodies"}),
        ("a, b = c = bodies[i], bodies[0]; c[1].vx = h", {"bodies"}),
        ("a, *rest = bodies; rest[0].vx = h", {"bodies"}),
        ("b = bodies[i] if h > 0.0 else found_out[i]; b.vx = h", {"bodies"}),
        ("(b := bodies[i]).vx = h", {"bodies"}),
        ("for b in bodies: b.vx = h", {"bodies"}),
        ("for k, b in enumerate(bodies): b.vx = h", {"bodies"}),
        ("for a, b in zip(bodies, found_out): a.vx = h", {"bodies"}),
        ("for k, bodies[i].vx in enumerate(found_out): pass", {"bodies"}),
        ("while h > 0.0:\n        b.vx, h = h, 0.0\n        b = bodies[i]", {"bodies"}),
        ("b: object = bodies[i]; b.vx = h", {"bodies"}),
        ("swap(i, bodies)", {"bodies"}),
        ("b = bodies[i]; swap(i, b)", {"bodies"}),
        ("swap(i, found_out); look(bodies, i); x = bodies[i].vx; x += h", set()),
        ("b = found_out[i]; b.vx = bodies[i].vx; b.x, b.y = h, h", set()),
        ("scratch[0] = h; row = scratch[1]; row.x = h", set()),
        ("x = len(bodies); x = x + 1", set()),
        ("context.hits_out[i] = h", set()),
        ("context.hits[i] = h", {"context"}),
    ],
)
def test_writes_are_seen_through_rows_tuples_loops_and_calls(body, written):
    source = f"def kernel_of_a_test(bodies, context, i, h, scratch, found_out, bodies_inout):\n    {body}\n"
    found = undeclared_writes(source, PARAMETERS)
    assert {argument for _, _, argument in found} == written
    assert all(name == "kernel_of_a_test" and line >= 2 for line, name, _ in found)


def statement_lines(function):
    """Return the number of lines of a kernel's body after ast.unparse, which joins a statement
    of several lines to one.
    """
    return sum(len(ast.unparse(node).splitlines()) for node in function.body[1:])


def test_docstrings_and_sizes():
    for path, function in kernels():
        assert ast.get_docstring(function), f"{at(path, function)} {function.name} has no docstring"
        lines = statement_lines(function)
        limit = LONG_LINES if function.name in LONG else KERNEL_LINES
        assert lines <= limit, f"{at(path, function)} {function.name} has {lines} lines, limit {limit}"
