"""Generated tables of docs/reference.md: effects, keywords, arrays, solvers, stages, counters, tolerances, types."""

import ast
import inspect
import re
from collections.abc import Callable, Iterable, Sequence
from importlib import import_module
from types import SimpleNamespace
from typing import Any, get_args

import physics
from physics import annotations
from physics.broadphase import BROADPHASES
from physics.effects import NEEDS
from physics.joint import JOINT_SOLVERS
from physics.settings import PIXELS_PER_METER, tolerances
from physics.step import IGNORED, STACKING, plan
from physics.tables import step_state
from physics.tables.body import CONTINUOUS, KINDS
from physics.tables.joint import COUPLED_SCRATCH, SCRATCH, STATE
from tests.reference.columns import ARRAYS, Array, columns, comments
from tests.reference.docstrings import described
from tests.reference.outline import CONSTANTS
from tests.reference.surface import items

WORD = re.compile(r"\"(\w+)\": (.*?)(?=[.;,]?\s+\"\w+\": |[.]\s+Setting|[.]?\s*$)", re.S)
INNER_TYPES = ("Coordinates", "Corners", "Word", "Rectangle", "Vector")  # of functions inside the package


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table in Markdown. Vertical bars in cells are escaped."""
    lines = [list(header), ["---"] * len(header), *(list(row) for row in rows)]
    return "\n".join(
        "| " + " | ".join(cell.replace("|", "\\|").replace("\n", " ") for cell in row) + " |" for row in lines
    )


def code(text: str) -> str:
    """Return a text in backquotes, as Markdown code."""
    return f"`{text}`"


def words(documentation: str | None) -> dict[str, str]:
    """Return {keyword: meaning} of the keywords that a text explains as "keyword": meaning."""
    return {word: " ".join(meaning.split()).rstrip(".;") for word, meaning in WORD.findall(documentation or "")}


def explained_words(name: str, allowed: Sequence[str], documentation: str | None) -> list[tuple[str, str]]:
    """Return (keyword, meaning) for each allowed keyword. Raises LookupError for one without a meaning."""
    known = words(documentation)
    if missing := [each for each in allowed if each not in known]:
        raise LookupError(f"{name}: no meaning of {', '.join(missing)} in its docstring")
    return [(code(f'"{each}"'), known[each]) for each in allowed]


# ---- effects, stages, solvers ----------------------------------------------------------------------------------------


def called(effects: Iterable[str], solver: str) -> dict[str, Any]:
    """Return {name: stage} of a step with exactly these effects."""
    on = SimpleNamespace(**{name: name in set(effects) for name in effect_names()})
    found: Any = plan(on, solver)  # pyright: ignore[reportArgumentType]
    return dict(zip(found.names, found.stages, strict=True))


def effect_names() -> list[str]:
    """Return the names of all effects in order."""
    return list(physics.Effects.__dataclass_fields__)


def stages_of(name: str) -> list[str]:
    """Return the stages that need an effect.

    A stage needs an effect if it runs only with it, or if the effect is one of several that cause the stage.
    """
    found = []
    for solver in ("soft_step", "projection"):
        alone, none = called([name], solver), called([], solver)
        rest = called([each for each in effect_names() if each != name], solver)
        everything = called(effect_names(), solver)
        found += [each for each in everything if each not in rest or (each in alone and each not in none)]
    return list(dict.fromkeys(found))


def effects() -> str:
    """Return the table of effects: what each adds, the effects that it needs, and its stages."""
    given = items()["Effects"].parameters
    meaning = described_arguments("Effects")
    rows = [
        (
            code(name),
            meaning[name].removesuffix("."),
            ", ".join(map(code, NEEDS.get(name, ()))) or "–",
            ", ".join(map(code, stages_of(name))) or "–",
            "on" if given[name].default else "off",
        )
        for name in effect_names()
    ]
    return table(("effect", "what it adds", "needs", "stages", "default"), rows)


def described_arguments(name: str) -> dict[str, str]:
    """Return {argument: meaning} of a public name. Raises LookupError if an argument has no meaning."""
    item = items()[name]
    found = described(item.documentation, set(item.parameters)).arguments
    if missing := [each for each in item.parameters if each not in found]:
        raise LookupError(f"{name}: no meaning of {', '.join(missing)} in its docstring")
    return found


def needs_of_stage(stage: str, solver: str) -> str:
    """Return the effects that a stage needs as text, "–" if none."""
    names = effect_names()
    if stage in called([], solver):
        return "–"
    if needed := [each for each in names if stage not in called([x for x in names if x != each], solver)]:
        return ", ".join(map(code, needed))
    return "one of " + ", ".join(code(each) for each in names if stage in called([each], solver))


def stages() -> str:
    """Return the tables of the stages of a step, with a stacking solver and with another one."""
    parts = []
    for title, solver in (("a stacking solver", "soft_step"), ("another solver", "projection")):
        rows = [
            (code(name), " ".join((stage.__doc__ or "").split("\n\n")[0].split()), needs_of_stage(name, solver))
            for name, stage in called(effect_names(), solver).items()
        ]
        parts.append(f"Stages with {title}, in order:\n\n" + table(("stage", "what it does", "needs the effect"), rows))
    return "\n\n".join(parts)


def solvers() -> str:
    """Return the table of solvers."""
    rows = []
    for name in physics.SOLVERS:
        first = (import_module(f"physics.solver.{name}").__doc__ or "").split("\n\n")[0]
        needs = code("stacking") if name in STACKING else code("response")
        ignored = ", ".join(map(code, IGNORED.get(name, ()))) or "–"
        rows.append((code(f'"{name}"'), " ".join(first.split()), needs, ignored))
    return table(("solver", "what it is", "needs the effect", "ignores the effects"), rows)


def strategies() -> str:
    """Return the table of broad phases."""
    rows = []
    for name, kind in BROADPHASES.items():
        first = (kind.__doc__ or "").split("\n\n")[0]
        rows.append((code(f'"{name}"'), code(kind.__name__), " ".join(first.split())))
    return table(("name", "class", "what it is"), rows)


# ---- words -----------------------------------------------------------------------------------------------------------


def kinds() -> str:
    """Return the table of the values of `kind`."""
    return table(("kind", "the body is"), explained_words("kind", KINDS, described_arguments("World.add_body")["kind"]))


def continuous() -> str:
    """Return the table of the values of `continuous`."""
    text = items()["Body.continuous"].documentation
    return table(("continuous", "path that is tested"), explained_words("continuous", CONTINUOUS, text))


def joint_solvers() -> str:
    """Return the table of the values of `joint_solver`."""
    text = items()["World.joint_solver"].documentation
    return table(("world.joint_solver", "how joints are solved"), explained_words("joint_solver", JOINT_SOLVERS, text))


def tiers() -> str:
    """Return the table of the collision tiers."""
    text = items()["fit"].documentation or ""
    listed = "\n".join(line for line in text.split("\n") if line.startswith('    "'))
    return table(("tier", "shapes"), explained_words("tier", physics.TIERS, listed))


# ---- arrays, counters, tolerances ------------------------------------------------------------------------------------

GROUPS = {  # of the JOINT columns
    "settings and state": {name for name, _ in STATE},
    "scratch of the solver, without meaning between steps": {name for name, _ in (*SCRATCH, *COUPLED_SCRATCH)},
}


def squared(text: str) -> str:
    """Return a text with the units px2, px4 and s2 written as px², px⁴ and s²."""
    return re.sub(r"\b(px|s)([24])\b", lambda match: match[1] + {"2": "²", "4": "⁴"}[match[2]], text)


def array_table(array: Array) -> str:
    """Return the table of the columns of an array."""
    rows = []
    for each in columns(array):
        inner = (
            array.name == "world.joints"
            and set(each.names) <= GROUPS["scratch of the solver, without meaning between steps"]
        )
        text = f"*solver scratch:* {each.meaning}" if inner else each.meaning
        rows.append((", ".join(map(code, each.names)), each.type, squared(text)))
    name = ", ".join(map(code, array.name.split(", ")))
    return f"{name}: each row is {array.row}.\n\n" + table(("column", "type", "meaning [unit]"), rows)


def arrays() -> str:
    """Return the tables of all arrays of a world."""
    pairs = (
        "`world.candidates`: (n, 2) int32, the ids of two shapes that passed broad phase and filters in the last step, "
        "a < b, sorted."
    )
    return "\n\n".join([*(array_table(each) for each in ARRAYS if "()" not in each.name), pairs])


def hits() -> str:
    """Return the tables of the arrays that queries return."""
    found = [each for each in ARRAYS if "()" in each.name and not each.name.startswith("debug")]
    return "\n\n".join(map(array_table, found))


def drawing() -> str:
    """Return the tables of the arrays of physics.debug."""
    return "\n\n".join(array_table(each) for each in ARRAYS if each.name.startswith("debug"))


def counter_meanings() -> dict[str, str]:
    """Return {counter: the comment beside its name}, "" for one without a comment."""
    source = inspect.getsource(step_state)
    known = comments(source)
    for node in ast.parse(source).body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name) and node.targets[0].id == "COUNTERS":
            assert isinstance(node.value, ast.Tuple)
            return {ast.literal_eval(each): known.get(each.lineno, "") for each in node.value.elts}
    raise LookupError("no COUNTERS in physics/tables/step_state.py")


def counters() -> str:
    """Return the table of the work counters."""
    rows = [(code(name), text) for name, text in counter_meanings().items()]
    return "`world.profile.counters`, of the last step:\n\n" + table(("counter", "counts"), rows)


def tolerance_values() -> str:
    """Return the table of the tolerances at the default scale."""
    known, meaning = tolerances(PIXELS_PER_METER), described_arguments("Tolerances")
    rows = [
        (code(name), f"{getattr(known, name):g}", text.removesuffix("."))
        for name, text in meaning.items()
        if name != "limits"
    ]
    return f"`world.tolerances` at {PIXELS_PER_METER:g} px per metre:\n\n" + table(
        ("tolerance", "value", "meaning"), rows
    )


# ---- constants and types ---------------------------------------------------------------------------------------------


def constants() -> str:
    """Return the table of the exported constants."""
    rows = []
    for name, text in CONSTANTS.items():
        value = getattr(physics, name)
        shown = ", ".join(value) if isinstance(value, dict | tuple) else repr(value)
        rows.append((code(name), "" if name in ("JIT", "PHYSICS_VERSION") else shown, text))
    return table(("constant", "value", "meaning"), rows)


def types_of_arguments() -> dict[str, str]:
    """Return {type: meaning} of each type in the annotations of the API: the comment at its
    definition, or its values.
    """
    source = inspect.getsource(annotations)
    known, found = comments(source), {}
    for node in ast.parse(source).body:
        if not isinstance(node, ast.Assign) or not isinstance(node.targets[0], ast.Name):
            continue
        name = node.targets[0].id
        value = getattr(annotations, name)
        choices = [each for each in get_args(value) if isinstance(each, str)]
        comment = known.get(node.end_lineno or 0, "").replace("fmt: skip", "") or known.get(node.lineno - 1, "")
        if choices:
            comment = ", ".join(code(f'"{each}"') for each in choices)
        found[name] = comment
    return found


def types() -> str:
    """Return the table of the types of arguments."""
    known = {name: text for name, text in types_of_arguments().items() if name not in INNER_TYPES}
    known["Substeps"] = 'a whole number, or `"auto"`'
    known["Number"] = "a number of Python or NumPy"
    return table(("type", "what is allowed"), [(code(name), text) for name, text in known.items()])


AFTER_NAMES = ("drawing", "hits")  # tables that follow the names of a section
TABLES: dict[str, Callable[[], str]] = {
    "arrays": arrays,
    "constants": constants,
    "continuous": continuous,
    "counters": counters,
    "drawing": drawing,
    "effects": effects,
    "hits": hits,
    "joint_solvers": joint_solvers,
    "kinds": kinds,
    "solvers": solvers,
    "stages": stages,
    "strategies": strategies,
    "tiers": tiers,
    "tolerances": tolerance_values,
    "types": types,
}
