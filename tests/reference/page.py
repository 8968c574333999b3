"""Text of docs/reference.md: the sections of the outline, and each name with signature,
arguments, errors and example.
"""

import ast
import inspect
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from physics.joints.kinds import Kind
from physics.settings import PIXELS_PER_METER
from physics.shapes.shape import Filter, Material
from tests.reference.docstrings import annotations, definition, described
from tests.reference.examples import BEFORE, examples
from tests.reference.outline import CONVENTIONS, SECTIONS, Section
from tests.reference.surface import EXTENSIONS, RESULTS, Item, attributes, items, takes_arguments
from tests.reference.tables import AFTER_NAMES, TABLES, code, table

PAGE = Path(__file__).resolve().parents[2] / "docs" / "reference.md"
TITLE = """# Reference of `hitbox.physics`

Every public name, with its arguments, units, defaults, errors, and an example. The page is generated from the
docstrings, signatures and tables of [physics](../physics), and a test compares them: `python -m tests.reference`
writes it. In a checkout the package is `physics`. Tasks with their code: [cookbook.md](cookbook.md). Names of other
libraries: [coming_from.md](coming_from.md).
"""
RAISES = re.compile(r"(?:^|(?<=[.)] ))(?=Raises |Setting [^.]* raises )")
TABULATED = {"Effects", "Tolerances"}  # a table of the section shows their arguments


def anchor(title: str) -> str:
    """Return the anchor of the first heading with this title, as GitHub makes it."""
    return re.sub(r"[^\w -]", "", title).lower().replace(" ", "-")


def link(title: str, shown: str | None = None, level: str = "name") -> str:
    """Return a link to a heading; `with_anchors` later inserts the anchor. level: "name" or "section"."""
    return f"[{shown or title}](#{level}:{title})"


def with_anchors(text: str) -> str:
    """Return the page with the anchors inserted in its links; equal headings are numbered as on GitHub."""
    used: dict[str, int] = {}
    known = {}
    for marks, title in re.findall(r"^(##+) (.+)$", re.sub(r"^```.*?^```$", "", text, flags=re.S | re.M), re.M):
        plain = anchor(title)
        number = used[plain] = used.get(plain, -1) + 1
        known["section" if marks == "##" else "name", title] = f"{plain}-{number}" if number else plain
    return re.sub(r"\(#(section|name):([^)]+)\)", lambda match: f"(#{known[match.groups()]})", text)


def cell(text: str) -> str:
    """Return a text for a table cell; a single sentence loses its full stop."""
    return text.removesuffix(".") if ". " not in text else text


def value_of(default: Any) -> str:
    """Return a default value as text for the page."""
    if default is inspect.Parameter.empty:
        return ""
    if isinstance(default, Filter) and default == Filter.ALL:
        return "Filter.ALL"
    if isinstance(default, Material) and default == Material():
        return "Material()"
    if default == 1 / 60:
        return "1 / 60"
    if isinstance(default, tuple) and type(default) is not tuple:  # a Vec2
        default = tuple(default)
    return repr(default).replace(", target=None)", ")").replace("hertz=", "").replace("damping=", "")


def signature(item: Item) -> str:
    """Return the call of an item: its name, arguments with defaults, and the type of its result."""
    given = item.parameters
    parts, keyword_only = [], False
    for name, each in given.items():
        if each.kind is inspect.Parameter.VAR_POSITIONAL:
            keyword_only = True
        elif each.kind is inspect.Parameter.KEYWORD_ONLY and not keyword_only:
            keyword_only = True
            parts.append("*")
        default = value_of(each.default)
        parts.append(f"{name}={default}" if default else name)
    result = annotations(item.member).get("return", "").strip("'\"") if item.kind != "class" else ""
    short = item.name.removeprefix("distance.")
    return f"{short}({', '.join(parts)})" + (f" -> {plain_type(result)}" if result not in ("", "None") else "")


def plain_type(text: str) -> str:
    """Return an annotation in a simplified form for readers."""
    text = text.strip("'\"").replace("'", "")
    text = re.sub(r"NDArray\[np\.(\w+?)_?\]", r"array of \1", text)
    text = re.sub(r"\bnp\.ndarray\b|\bArrayLike\b", "array", text)
    text = re.sub(r"Unpack\[\w+\]|\bAny\b", "any", text)
    text = re.sub(r"RayHit\[Body\]", "RayHit", text)
    text = (
        text.replace("np.integer[any]", "int").replace("int | int", "int").replace("np.random.Generator", "Generator")
    )
    text = re.sub(r"Callable\[\[(.*)\], (\w+)\]", r"function", text)
    text = re.sub(r"\b(?:World(?:State|Handle)|IndexedWorld)\b", "World", text).replace("HitBody", "Body")
    text = re.sub(
        r"\b(?:Body|Joint|Contact|Event|Hit|Quarantine|Broken)Rows|RayHits|PointHits\b", "structured array", text
    )
    return re.sub(r"\b(?:os\.)?PathLike\[str\]", "path", text)


def split_errors(text: str) -> tuple[str, str]:
    """Return (text without the sentences about errors, these sentences)."""
    kept, errors = [], []
    for paragraph in text.split("\n\n"):
        if paragraph.startswith("    ") or ":\n    " in paragraph:
            kept.append(paragraph)
            continue
        joined = " ".join(paragraph.split())
        match = RAISES.search(joined)
        if match:
            errors.append(joined[match.start() :])
            joined = joined[: match.start()].strip()
        if joined:
            kept.append(joined)
    return "\n\n".join(kept), " ".join(errors)


def argument_rows(item: Item, left_out: Iterable[str] = ()) -> list[tuple[str, ...]]:
    """Return the table rows (name, type, default, meaning) of the arguments; arguments with a common meaning share a
    row.

    left_out: names of arguments to leave out.
    """
    given, types = item.parameters, item.annotations
    meanings = described(item.documentation, known_names(item)).arguments
    rows: list[tuple[str, ...]] = []
    for name, each in given.items():
        if name in left_out:
            continue
        if name not in meanings:
            raise LookupError(f"{item.name}: no meaning of {name} in its docstring")
        default = value_of(each.default)
        row = (
            code(name),
            code(plain_type(types.get(name, "any"))),
            code(default) if default else "",
            cell(meanings[name]),
        )
        same = [k for k, other in enumerate(rows) if other[1:] == row[1:]]
        if same:
            rows[same[0]] = (f"{rows[same[0]][0]}, {row[0]}", *row[1:])
        else:
            rows.append(row)
    return rows


def known_names(item: Item) -> set[str]:
    """Return the names that the docstring of an item may explain: arguments, and attributes of a class."""
    return {*item.parameters, *(attributes(item.member) if item.kind == "class" else ())}


def shared_with_kind(item: Item) -> list[str]:
    """Return the arguments of a joint class whose meaning is the same for all kinds of joints."""
    if not (item.kind == "class" and issubclass(item.member, Kind) and item.member is not Kind):
        return []
    common = described(items()["Kind"].documentation, known_names(items()["Kind"])).arguments
    own = described(item.documentation, known_names(item)).arguments
    return [name for name in common if own[name] == common[name]]


def block(item: Item, level: int) -> str:
    """Return the part of the page about a callable or class, without its members."""
    text = described(item.documentation, known_names(item)).text
    text, errors = split_errors(text)
    called = item.is_callable and takes_arguments(item)
    parts = [
        f"{'#' * level} {item.name}",
        *([code(signature(item))] if called and item.name not in RESULTS else []),
        text,
    ]
    if item.name == "fit":
        parts[-1] = (
            text.split("The tiers, from coarse to exact:")[0].strip()
            + "\n\nThe shapes keep the mask's material, filter and sensor."
        )
    shared = shared_with_kind(item)
    rows = argument_rows(item, shared) if called and item.name not in TABULATED else []
    if rows and item.name in RESULTS:
        parts.append(table(("field", "type", "meaning [unit]"), [(name, kind, text) for name, kind, _, text in rows]))
    elif rows:
        parts.append(table(("argument", "type", "default", "meaning [unit]"), rows))
    if shared:
        parts.append(f"And {', '.join(map(code, shared))} of {link('Kind')}.")
    if errors:
        parts.append(errors)
    if item.name in (known := examples()):
        parts.append(f"```pycon\n{known[item.name].rstrip()}\n```")
    return "\n\n".join(each for each in parts if each)


def setter_type(item: Item) -> str:
    """Return the type that a property can be set to, "–" if it cannot be set."""
    if not isinstance(item.member, property) or item.member.fset is None:
        return "–"
    node = definition(item.member.fset)
    assert isinstance(node, ast.FunctionDef)
    annotation = node.args.args[1].annotation
    return code(plain_type(ast.unparse(annotation))) if annotation is not None else "yes"


def property_type(item: Item) -> str:
    """Return the type of a property or attribute."""
    if item.kind == "attribute":
        assert item.owner is not None
        return plain_type(attributes(item.owner).get(item.name.rsplit(".", 1)[1], "") or guessed(item))
    function = getattr(item.member, "fget", None) or getattr(item.member, "func", None)
    return plain_type(annotations(function).get("return", "any"))


def guessed(item: Item) -> str:
    """Return the type of an attribute without an annotation in the source."""
    known = {"size": "tuple[int, int]", "body": "Body"}
    return known[item.name.rsplit(".", 1)[1]]


def property_table(members: list[Item]) -> str:
    """Return the table of properties and attributes: name, type, whether it can be set, meaning."""
    rows = []
    for each in members:
        text = " ".join((each.documentation or "").split())
        if each.name == "Body.continuous":
            text = (
                f"{text.split(chr(34))[0]}See the table at {link('Bodies', level='section')}. Setting"
                + text.split("Setting", 1)[1]
            )
        rows.append((code(each.name.rsplit(".", 1)[1]), code(property_type(each)), setter_type(each), cell(text)))
    return table(("property", "type", "can be set to", "meaning [unit]"), rows)


def placed() -> dict[str, list[Item]]:
    """Return {section title: its items in order}: the named ones, and the other members of named classes."""
    everything = items()
    named = {name for section in SECTIONS for name in section.names}
    found = {}
    for section in SECTIONS:
        shown: list[Item] = []
        for name in section.names:
            shown.append(everything[name])
            if everything[name].kind == "class":
                shown += [
                    each
                    for each in everything.values()
                    if each.name.startswith(name + ".") and each.name not in named and not each.repeats
                ]
        found[section.title] = list(dict.fromkeys(shown))
    return found


def section_text(section: Section, shown: list[Item]) -> str:
    """Return the text of a section: heading, introduction, tables and names."""
    parts = [f"## {section.title}", section.text]
    parts += [TABLES[name]() for name in section.tables if name not in AFTER_NAMES]
    for item in shown:
        if item.kind in ("property", "attribute"):
            continue
        member = item.owner is not None
        extension = item.name in EXTENSIONS and member
        if extension:
            continue
        parts.append(block(item, 4 if member else 3))
        mine = [each for each in shown if each.name.startswith(item.name + ".") and item.kind == "class"]
        if properties := [each for each in mine if each.kind in ("property", "attribute")]:
            parts.append(property_table(properties))
        if inner := [each for each in mine if each.name in EXTENSIONS]:
            parts.append(extension_table(inner))
    parts += [TABLES[name]() for name in section.tables if name in AFTER_NAMES]
    return "\n\n".join(each for each in parts if each)


def extension_table(members: list[Item]) -> str:
    """Return the table of the methods that a new shape, joint or broad phase implements."""
    rows = []
    for each in members:
        found = described(each.documentation, set(each.parameters))
        arguments = "; ".join(f"{code(name)}: {text.rstrip('.')}" for name, text in found.arguments.items())
        rows.append((code(signature(each)), " ".join(found.text.split()), arguments or "–"))
    return "For extensions, see [CONTRIBUTING.md](../CONTRIBUTING.md):\n\n" + table(
        ("method", "what it does", "arguments"), rows
    )


def contents(shown: dict[str, list[Item]]) -> str:
    """Return the table of contents by subject. shown: result of `placed`."""
    rows = []
    for title, found in shown.items():
        names: list[str] = []
        for each in found:
            if each.kind in ("property", "attribute") or (each.name in EXTENSIONS and each.owner is not None):
                continue
            short = each.name.removeprefix("World.").removeprefix("debug.")
            owner = each.name.rpartition(".")[0]
            if owner and any(other.name == owner for other in found) and owner != "World":
                short = "." + each.name.rpartition(".")[2]
            names.append(link(each.name, short))
        rows.append((link(title, level="section"), " ".join(names)))
    return table(("subject", "names"), rows)


def page() -> str:
    """Return the whole page."""
    shown = placed()
    parts = [
        TITLE,
        "## Conventions\n\n" + CONVENTIONS.format(ppm=PIXELS_PER_METER),
        "## Contents\n\n" + contents(shown),
        "## Before the examples\n\nEvery example runs, after these lines and in a world of its own:\n\n"
        f"```pycon\n{BEFORE.rstrip()}\n```",
        *(section_text(section, shown[section.title]) for section in SECTIONS),
    ]
    return with_anchors("\n\n".join(each.strip() for each in parts) + "\n")
