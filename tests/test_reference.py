"""docs/reference.md contains every public name: arguments, columns, effects, counters, errors, examples.

The page is compared with newly generated text. Docstrings are compared with signatures, comments of tables with their
columns, and the errors that wrong arguments raise with the errors that a docstring names.
"""

import inspect
import math
import pydoc
import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import physics
from physics import Circle, Effects, SpatialHashGrid, World, debug
from physics.broadphase.proxies import Strategy
from physics.joints.kinds import KINDS
from physics.shapes.shape import Shape
from physics.tables.step_state import COUNTERS
from tests.reference import examples as shown
from tests.reference import tables
from tests.reference.__main__ import differences, main
from tests.reference.columns import ARRAYS, columns, fields
from tests.reference.docstrings import described, errors_in
from tests.reference.outline import CONSTANTS, CONVENTIONS
from tests.reference.page import PAGE, known_names, page, placed, plain_type, property_type
from tests.reference.surface import EXTENSIONS, RESULTS, Item, items, takes_arguments

ROOT = Path(__file__).resolve().parent.parent
CALLABLES = [each for each in items().values() if each.is_callable and takes_arguments(each)]
PROPERTIES = [each for each in items().values() if each.kind in ("property", "attribute")]
EXAMPLES = shown.examples()
PLAIN_TYPES = {
    "None", "any", "array", "bool", "bytes", "dict", "float", "float32", "float64", "function", "int", "int32", "int64",
    "list", "of", "path", "str", "structured", "tuple", "type", "Generator", "Iterable", "Mapping", "Sequence",
    "Callable", "Limits", "Self", "Query", "Box", "Arena", "PixelTiles",
}  # fmt: skip


def where(item: Item) -> str:
    """Return the file, line and name of an item, for messages."""
    member = inspect.unwrap(getattr(item.member, "__func__", item.member))
    try:
        line = inspect.getsourcelines(member)[1]
        return f"{Path(inspect.getsourcefile(member) or '').relative_to(ROOT)}:{line}: {item.name}"
    except (TypeError, OSError):
        return item.name


# ---- the page --------------------------------------------------------------------------------------------------------


def test_the_page_is_what_the_code_says():
    found = differences(PAGE.read_text(encoding="utf-8"), page())
    assert not found, "run python -m tests.reference; docs/reference.md:" + "\ndocs/reference.md:".join(found[:5])


def test_a_stale_page_is_named_by_its_line(tmp_path, monkeypatch, capsys):
    text = PAGE.read_text(encoding="utf-8")
    line = text[: text.index("| `seed` | `int` | `0` |")].count("\n") + 1
    (tmp_path / "reference.md").write_text(text.replace("| `seed` | `int` | `0` |", "| `seed` | `int` | `1` |", 1))
    monkeypatch.setattr("tests.reference.__main__.PAGE", tmp_path / "reference.md")
    assert main(["--check"]) == 1
    assert capsys.readouterr().out.startswith(f"docs/reference.md:{line}: ")
    assert main([]) == 0 and main(["--check"]) == 0 and main(["--wrong"]) == 2


def test_every_public_name_is_on_the_page_once():
    everything = [each.name for found in placed().values() for each in found]
    assert len(everything) == len(set(everything))
    repeated = {name for name, each in items().items() if each.repeats}
    constants = {name for name, each in items().items() if each.kind == "constant"}
    assert set(everything) == set(items()) - repeated - constants
    assert constants == CONSTANTS.keys() and set(physics.__all__) <= set(everything) | constants


def test_an_export_or_a_member_without_a_place_is_found(monkeypatch):
    before = set(items())
    monkeypatch.setattr(World, "fly", lambda self, height: None, raising=False)
    monkeypatch.setattr(physics, "__all__", [*physics.__all__, "checks"])
    items.cache_clear()
    try:
        assert set(items()) - before == {"World.fly", "checks"}
        assert not items()["World.fly"].documentation and list(items()["World.fly"].parameters) == ["height"]
        assert "World.fly" in {each.name for each in placed()["World"]}
        assert "checks" not in {each.name for found in placed().values() for each in found}
    finally:
        monkeypatch.undo()
        items.cache_clear()
    assert set(items()) == before


def test_links_of_the_page_lead_to_its_headings():
    text = re.sub(r"^```.*?^```$", "", page(), flags=re.S | re.M)
    used: dict[str, int] = {}
    for title in re.findall(r"^#+ (.+)$", text, re.M):
        plain = re.sub(r"[^\w -]", "", title).lower().replace(" ", "-")
        used[plain] = used.get(plain, -1) + 1
    known = {name if not number else f"{name}-{number}" for name, most in used.items() for number in range(most + 1)}
    targets = set(re.findall(r"\]\(#([^)]+)\)", text))
    assert len(targets) > 150 and targets <= known


def test_there_are_ten_conventions():
    assert [line[:2] for line in CONVENTIONS.split("\n")].count("- ") == 10


# ---- docstrings ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("item", CALLABLES, ids=lambda each: each.name)
def test_a_docstring_explains_every_argument_and_no_other(item):
    assert item.documentation, f"{where(item)} has no docstring"
    found = described(item.documentation, known_names(item))
    assert not found.faults, f"{where(item)}: {found.faults}"
    missing = [each for each in item.parameters if len(found.arguments.get(each, "")) < 3]
    unknown = sorted(found.arguments.keys() - known_names(item))
    assert not missing, f"{where(item)} does not explain {', '.join(missing)}"
    assert not unknown, f"{where(item)} explains {', '.join(unknown)}, which it does not take"


@pytest.mark.parametrize(
    "item", [x for x in items().values() if not x.is_callable and x.kind != "constant"], ids=lambda x: x.name
)
def test_a_property_is_explained(item):
    assert item.documentation and len(item.documentation) > 5, f"{item.name} has no docstring"


def test_arguments_that_are_missing_unknown_or_unreadable_are_found():
    text = "Return it.\n\norigin: start [px].\nspeed, angle: of it [px/s]; mass: of it\n    in all."
    found = described(text, {"origin", "speed", "angle", "mass", "missing"})
    assert found == (
        "Return it.",
        {"origin": "start [px].", "speed": "of it [px/s]", "angle": "of it [px/s]", "mass": "of it in all."},
        [],
    )
    assert described("Do.\n\norigin: start.\nThen it ends.", {"origin"}).faults
    assert described("Do.\n\norigin: start.\norigin: again.", {"origin"}).faults
    assert described("Do.\n\nNote: this is text.", {"origin"}).text == "Do.\n\nNote: this is text."
    wrong = Item("f", "function", lambda origin, speed: None, None)
    assert list(wrong.parameters) == ["origin", "speed"]


def test_types_of_arguments_are_explained():
    known = PLAIN_TYPES | tables.types_of_arguments().keys() | {name.rsplit(".")[-1] for name in items()}
    for item in items().values():
        shown_types = [plain_type(item.annotations.get(name, "any")) for name in item.parameters]
        shown_types += [property_type(item)] if item.kind in ("property", "attribute") else []
        for text in shown_types:
            words = set(re.findall(r"\b[A-Za-z]\w*\b", text))
            assert words <= known, f"{where(item)}: the page does not explain {words - known}"
    assert not [
        name
        for name, text in tables.types_of_arguments().items()
        if not text and name not in ("Number", "Substeps", *tables.INNER_TYPES)
    ]


# ---- examples --------------------------------------------------------------------------------------------------------


def test_every_callable_has_an_example():
    wanted = {each.name for each in CALLABLES if not each.repeats} - EXTENSIONS
    classes = {each.name for each in items().values() if each.kind == "class"} & EXAMPLES.keys()
    assert wanted <= EXAMPLES.keys() <= wanted | classes


FIRST_MET = [
    "World", "World.step", "World.add_body", "World.add_bodies", "World.add_joint", "World.touching", "World.ray_cast",
    "Body", "PixelMask", "Polygon.box", "Circle", "Effects", *(each.__name__ for each in KINDS),
]  # fmt: skip


@pytest.mark.parametrize("name", FIRST_MET)
def test_help_shows_an_example_of_the_names_that_are_met_first(name):
    text = pydoc.render_doc(items()[name].member, renderer=pydoc.plaintext)
    for line in EXAMPLES[name].rstrip().split("\n"):
        assert line in text, f"help({name}) does not show {line!r}"


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_runs_and_prints_what_the_page_shows(name):
    assert name.rsplit(".", 1)[-1] in EXAMPLES[name] or name in RESULTS | {"Events", "Profile", "Turned"}
    reported = shown.run(name, EXAMPLES[name], shown.prepared())
    assert not reported, reported


def test_a_wrong_example_is_found():
    assert "Expected" in shown.run("wrong", ">>> len(world)\n4\n", shown.prepared())


# ---- tables ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("array", ARRAYS, ids=lambda each: each.name)
def test_every_column_has_a_meaning(array):
    found = columns(array)
    unexplained = [name for each in found if not each.meaning for name in each.names]
    assert not unexplained, f"physics/tables/{array.module.__name__.rsplit('.')[-1]}.py: no comment at {unexplained}"
    assert [name for each in found for name in each.names] == list(array.dtype.names)


def test_a_column_without_a_comment_is_found():
    source = 'T = [\n    ("x", np.float64),  # [px] place\n    ("y", np.float64),\n    ("mass", np.float64),\n]\n'
    assert fields(source, "T") == {"x": "[px] place", "y": "", "mass": ""}


def test_the_arrays_are_those_of_a_world():
    world = World(Effects.rigid_bodies().with_(joints=True))
    events = {f"world.events.{name}": rows.dtype for name, rows in vars(world.events).items()}
    read = {
        f"world.{name}": getattr(world, name).dtype
        for name in ("bodies", "shapes", "contacts", "sleeping_contacts", "joints")
    }
    listed = {}
    for array in ARRAYS:
        first, *others = [each.strip() for each in array.name.split(",")]
        listed |= {
            (first.rpartition(".")[0] + each if each.startswith(".") else each): array.dtype
            for each in (first, *others)
        }
    assert {name: listed.get(name) for name in events | read} == events | read


def test_every_effect_counter_word_and_stage_is_explained():
    meanings = tables.counter_meanings()
    assert list(meanings) == list(COUNTERS) and all(meanings.values())
    for name, make in tables.TABLES.items():
        rows = [re.split(r"(?<!\\)\|", line)[1:-1] for line in make().split("\n") if line.startswith("| ")]
        assert rows and all(row[0].strip() and row[-1].strip() for row in rows), f"an empty cell in the table {name}"
    assert tables.words('"off": none. "ray": a line.') == {"off": "none", "ray": "a line"}
    with pytest.raises(LookupError, match="swept"):
        tables.explained_words("continuous", ("off", "swept"), '"off": none.')


def test_a_stage_is_listed_under_the_effects_that_it_needs():
    for name in tables.effect_names():
        for stage in tables.stages_of(name):
            everything = Effects(**dict.fromkeys(tables.effect_names(), True))
            assert stage in {
                *World(everything).stages,
                *World(everything, solver="projection").stages,
                "carry",
                "weigh",
            }
    assert (
        "rest" in tables.stages_of("sleeping")
        and "rest" not in World(Effects.rigid_bodies().with_(sleeping=False)).stages
    )


# ---- errors ----------------------------------------------------------------------------------------------------------
# The first call of each callable in its example is repeated, with one argument replaced by a hostile value. What it
# raises has to be named by its docstring, or by that of its class.

HOSTILE = {
    "an object": object(), "a word": "no such word", "NaN": math.nan, "below 0": -1, "a list of words": ["a", "b"],
    "an unknown id": 10**9, "none": None, "a pair with NaN": (math.nan, 0.0), "far away": (1e300, 1e300),
    "an array": np.full((2, 3), np.inf), "a number": 3.5, "nothing": (),
}  # fmt: skip
STARTING = {"compile_in_background", "Background.stop", "Background.expect", "warmup"}  # they start processes


class Called(Exception):
    """Exception that stops an example when its call is reached."""


IMPLEMENTED = {Shape: Circle, Strategy: SpatialHashGrid}  # an interface, and the class with which its examples call it


def code_of(item: Item) -> Any:
    """Return the code object that runs when a callable is called, or None."""
    member = item.member
    if item.owner in IMPLEMENTED:
        member = getattr(IMPLEMENTED[item.owner], item.name.rsplit(".", 1)[1])
    if isinstance(member, type):
        member = member.__init__ if inspect.isfunction(member.__init__) else member.__new__
    return getattr(inspect.unwrap(getattr(member, "__func__", member)), "__code__", None)


def arguments_of_call(item: Item) -> tuple[dict[str, Any], dict[str, Any]]:
    """Run the example of a callable up to its call. Return (local names at the call, names of the example)."""
    wanted, found, names = code_of(item), {}, shown.prepared()

    def watch(frame, event, _):
        if event == "call" and frame.f_code is wanted and not found:
            found.update(frame.f_locals)

    source = re.sub(r"^(?!>>> |\.\.\. ).*\n?", "", EXAMPLES[item.name], flags=re.M)
    source = re.sub(r"^(>>> |\.\.\. )", "", source, flags=re.M)
    previous = sys.getprofile()
    sys.setprofile(watch)
    try:
        exec(compile(source, item.name, "exec"), names)
    finally:
        sys.setprofile(previous)
    return found, names


def repeated(item: Item, found: dict[str, Any], changed: dict[str, Any]) -> BaseException | None:
    """Repeat a call with some arguments changed. Return the error that it raises, or None.

    found: {name: value} of the original arguments. changed: {name: value} of the changed ones.
    """
    positional, keyword = [], {}
    for name, each in item.parameters.items():
        plain = name.lstrip("*")
        value = changed.get(name, found.get(plain, each.default))
        if each.kind is inspect.Parameter.VAR_POSITIONAL:
            positional += [*value] if name not in changed else [value]
        elif each.kind is inspect.Parameter.VAR_KEYWORD:
            keyword |= value if isinstance(value, dict) else {"no_such_argument": value}
        elif each.kind is inspect.Parameter.KEYWORD_ONLY:
            keyword[plain] = value
        else:
            positional.append(value)
    target = item.member
    if item.kind == "method":
        target = getattr(found["self"], item.name.rsplit(".", 1)[1])
    elif item.kind == "class method":
        target = getattr(item.owner, item.name.rsplit(".", 1)[1])
    try:
        target(*positional, **keyword)
    except Exception as error:
        return error
    return None


def is_named(error: BaseException, item: Item) -> bool:
    """Return whether the docstring of an item, its class or physics.debug names the error or says "not checked"."""
    texts = [item.documentation, inspect.getdoc(item.owner) if item.owner else ""]
    texts += [debug.__doc__] if item.name.startswith("debug.") else []
    if any("not checked" in (each or "") for each in texts):
        return True
    texts += [items()[item.repeats].documentation] if item.repeats else []
    named = set().union(*map(errors_in, texts))
    return any(each.__name__ in named for each in type(error).__mro__)


CHECKED = [
    each for each in CALLABLES if each.name in EXAMPLES and each.parameters and each.name not in RESULTS | STARTING
]


@pytest.mark.parametrize("item", CHECKED, ids=lambda each: each.name)
def test_errors_of_wrong_arguments_are_named(item, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # a word is a path for Snapshot.save
    found, _ = arguments_of_call(item)
    assert found, f"the example of {item.name} does not call it"
    for name in item.parameters:
        for what, value in HOSTILE.items():
            error = repeated(item, found, {name: value})
            assert error is None or is_named(error, item), f"{where(item)}({name}={what}) raises {error!r}"


@pytest.mark.parametrize("item", [each for each in CHECKED if each.kind == "method"], ids=lambda each: each.name)
def test_the_error_during_a_step_is_named(item):
    found, names = arguments_of_call(item)
    world = names["world"]
    object.__setattr__(world, "_stepping", True)
    error = repeated(item, found, {})
    assert not isinstance(error, RuntimeError) or is_named(error, item), f"{where(item)} raises {error!r} during a step"


SETTABLE = [each for each in PROPERTIES if isinstance(each.member, property) and each.member.fset is not None]


@pytest.mark.parametrize("item", SETTABLE, ids=lambda each: each.name)
def test_errors_of_wrong_values_of_a_property_are_named(item):
    names = shown.prepared()
    target = names[{"World": "world", "Body": "ball", "Joint": "hinge"}[item.name.split(".")[0]]]
    for what, value in HOSTILE.items():
        try:
            setattr(target, item.name.rsplit(".", 1)[1], value)
        except Exception as error:
            assert is_named(error, item), f"{item.name} = {what} raises {error!r}"
    names["world"].dt = 1 / 60  # the last value that was accepted may be long
    names["world"].step()


def test_an_error_that_is_not_named_is_found():
    item = items()["Circle"]
    assert is_named(ValueError(), item) and not is_named(OSError(), item)
    assert not is_named(KeyError(), items()["World.step"])
