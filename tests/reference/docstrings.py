"""Parser of the docstrings of public names: a text, the meaning of each argument, and the errors.

The form: a paragraph that begins with the name of an argument and a colon lists arguments, one on a line; longer ones
continue on indented lines. Short ones may share a line, separated by semicolons. Several arguments may have one
meaning:

    origin: start of the ray [px].
    lower, upper: corners of the box [px]; filter: which shapes can be hit.

A sentence that begins with "Raises" names errors.
"""

import ast
import builtins
import inspect
import re
import textwrap
from functools import cache
from typing import Any, NamedTuple

NAMES = r"\*{0,2}[a-z_]\w*(?:, \*{0,2}[a-z_]\w*)*"
ENTRY = re.compile(rf"({NAMES}): ", re.ASCII)
ERRORS = [each for each in vars(builtins) if isinstance(getattr(builtins, each), type) and each.endswith("Error")]
RAISED = re.compile(rf"\b({'|'.join(ERRORS)})\b")


class Described(NamedTuple):
    """The parts of a docstring."""

    text: str  # all paragraphs but those of arguments
    arguments: dict[str, str]  # meaning by name; stars are part of a name
    faults: list[str]  # lines of a paragraph of arguments that are not in the form


def named(names: str) -> list[str]:
    """Return the single names in a comma-separated list."""
    return [each.strip() for each in names.split(",")]


def entries(paragraph: list[str], known: set[str]) -> tuple[dict[str, str], list[str]]:
    """Return ({argument: meaning}, faults) of a paragraph.

    faults: a message for each line that does not have the form. known: names of the arguments.
    """
    found, faults, joined = {}, [], []
    for line in paragraph:
        if line.startswith(" ") and joined:
            joined[-1] += " " + line.strip()
        else:
            joined.append(line)
    for line in joined:
        if not ENTRY.match(line):
            faults.append(f"no argument begins the line {line!r}")
            continue
        starts = [0]
        for each in re.finditer(rf"; ({NAMES}): ", line, re.ASCII):
            if set(named(each.group(1))) <= known:
                starts.append(each.start() + 2)
        for start, end in zip(starts, [*(each - 2 for each in starts[1:]), len(line)], strict=True):
            match = ENTRY.match(line, start)
            assert match is not None
            for name in named(match.group(1)):
                if name in found:
                    faults.append(f"{name} is explained twice")
                found[name] = line[match.end() : end].strip()
    return found, faults


def described(documentation: str | None, known: set[str]) -> Described:
    """Return the parts of a docstring. known: names of the arguments, with stars."""
    kept, arguments, faults = [], {}, []
    for paragraph in re.split(r"\n\s*\n", documentation or ""):
        lines = paragraph.rstrip().split("\n")
        match = ENTRY.match(lines[0])
        if match and set(named(match.group(1))) & known:
            found, wrong = entries(lines, known)
            faults += wrong + [f"{name} is explained twice" for name in found if name in arguments]
            arguments |= found
            if kept and kept[-1].endswith(":"):  # it announces the arguments
                kept.pop()
        elif paragraph.strip():
            kept.append(paragraph.rstrip())
    return Described("\n\n".join(kept), arguments, faults)


def split_example(text: str | None) -> tuple[str | None, str]:
    """Return (docstring without its doctest, doctest). The doctest is "" if there is none."""
    paragraphs = (text or "").split("\n\n")
    shown = [each for each in paragraphs if each.startswith(">>> ")]
    if not shown:
        return text, ""
    return "\n\n".join(each for each in paragraphs if each not in shown), "\n".join(shown).rstrip() + "\n"


def errors_in(text: str | None) -> set[str]:
    """Return the names of the errors that a text names."""
    return set(RAISED.findall(text or ""))


# ---- signatures ------------------------------------------------------------------------------------------------------


def unwrapped(member: Any) -> Any:
    """Return the plain function of a method, class method or decorated function."""
    return inspect.unwrap(getattr(member, "__func__", member))


@cache
def module_tree(path: str) -> ast.Module:
    """Return the parsed source of a file."""
    with open(path, encoding="utf-8") as source:
        return ast.parse(source.read())


def definition(member: Any) -> ast.FunctionDef | ast.ClassDef | None:
    """Return the node that defines a function or class, None if it is generated."""
    member = unwrapped(member)
    try:
        path = inspect.getsourcefile(member)
    except TypeError:
        return None
    if path is None or path.startswith("<"):
        return None
    wanted = member.__qualname__.split(".")
    node: Any = module_tree(path)
    for name in wanted:
        inner = [
            each
            for each in node.body
            if isinstance(each, ast.FunctionDef | ast.ClassDef) and each.name == name and not is_overload(each)
        ]
        if not inner:
            return None
        node = inner[0] if name == wanted[-1] and len(inner) > 1 and not isinstance(member, type) else inner[-1]
        if name == wanted[-1] and inspect.isfunction(member):
            line = member.__code__.co_firstlineno
            node = min(inner, key=lambda each: abs(first_line(each) - line))
    return node


def first_line(node: ast.FunctionDef | ast.ClassDef) -> int:
    """Return the first line number of a definition, including its decorators."""
    return min([node.lineno, *(each.lineno for each in node.decorator_list)])


def is_overload(node: ast.FunctionDef | ast.ClassDef) -> bool:
    """Return whether a definition is only a typed overload."""
    return any(isinstance(each, ast.Name) and each.id == "overload" for each in node.decorator_list)


def annotations(member: Any) -> dict[str, str]:
    """Return the annotations of a callable as written in the source, {argument: annotation};
    "return" for the result.
    """
    if isinstance(member, type):
        own = vars(member).get("__init__")
        node = definition(own) if own is not None else None
        if node is None:
            found = {}
            for each in reversed(member.__mro__):
                if each.__module__.startswith("physics"):
                    found |= fields_of(each)
            return found
    else:
        node = definition(member)
    if not isinstance(node, ast.FunctionDef):
        return {}
    given = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
    found = {each.arg: ast.unparse(each.annotation) for each in given if each.annotation}
    for each, stars in ((node.args.vararg, "*"), (node.args.kwarg, "**")):
        if each is not None and each.annotation:
            found[stars + each.arg] = ast.unparse(each.annotation)
    if node.returns is not None:
        found["return"] = ast.unparse(node.returns)
    return found


def fields_of(kind: type) -> dict[str, str]:
    """Return {field: annotation} of the annotated fields in a class body."""
    node = definition(kind)
    if not isinstance(node, ast.ClassDef):
        return {}
    return {
        each.target.id: ast.unparse(each.annotation)
        for each in node.body
        if isinstance(each, ast.AnnAssign) and isinstance(each.target, ast.Name)
    }


def parameters(member: Any) -> dict[str, inspect.Parameter]:
    """Return {name: parameter} of a callable, with stars in the names, without self and cls."""
    stars = {inspect.Parameter.VAR_POSITIONAL: "*", inspect.Parameter.VAR_KEYWORD: "**"}
    if isinstance(member, type):
        signature = inspect.signature(member)
    else:
        signature = inspect.signature(getattr(member, "__func__", member))
    found = [each for each in signature.parameters.values() if each.name not in ("self", "cls", "_cls")]
    return {stars.get(each.kind, "") + each.name: each for each in found}


def documentation(member: Any) -> str | None:
    """Return the docstring of a callable or property, without indentation."""
    text = inspect.getdoc(getattr(member, "__func__", member))
    return textwrap.dedent(text) if text else None
