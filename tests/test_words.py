"""Rules for docstrings and comments: plain technical English that begins with a verb or a noun and personifies nothing.

PLAIN lists the folders that follow all rules. Comments are read from the tokens, so words in strings do not count.
REPLACED lists identifiers that were replaced by the standard word, with the folders in which each must not occur.
"""

import ast
import io
import re
import tokenize
from functools import cache

import pytest

from tests.architecture import ROOT, TOPS, sources

PLAIN = ("physics", "game", "scenes", "assets", "tests")  # folders that hold to all rules
FIRST = re.compile(r"(What|Who|Whoever|Whom|Whose|Nobody|Somebody|Nothing|Everything|That which)\b")
PERSONS = re.compile(r"\b(whoever|whomever|nobody|somebody|anybody|everybody)\b", re.IGNORECASE)
ABSENT = re.compile(r"\bhard_cases\b|\bdesign\.md\b|\bapi\.md\b")  # pages that a reader of the repository cannot open
PATHS = [path for top in (*TOPS, "tests") for path in sources(top)]
# Folders -> identifiers (functions, classes, attributes, arguments, variables, modules) that must not occur in them.
REPLACED = {
    ("game", "scenes", "tests"): (
        "wishes", "wish", "wish_restart", "Lane", "Lanes", "LaneFigures", "lane_of", "measure_lanes",
        "measure_stored_lanes", "Light", "Lights", "last_told", "put_lights", "Apart", "TakenApart", "taken_apart",
        "take_apart", "Why", "Jury", "jury", "Scrub", "scrub", "left_over", "tells_contacts", "TOLD_SECONDS",
    ),
    ("game", "scenes", "tests/game", "tests/scenes"): (
        "tell", "tells", "told", "telling", "Tell", "Told", "TOLD", "_told",
    ),
    ("game", "scenes"): ("Pace", "pace", "Plan", "_Plan", "_lane", "questions"),
    ("game", "tests/game"): ("lights", "front", "pareto", "knowing"),
    ("physics",): (
        "ANCHOR", "MANIFOLD", "CONSTRAINT", "carry_over", "take_places", "renew", "serves_again", "follow_anchor",
        "follow_bodies", "KeptForces", "let_out_both", "wanted_apart", "Pace", "push_piles", "move_driven",
        "ask_by_load", "demand", "eased", "overloaded", "play_hits", "split_of", "couple", "told_manifolds",
        "tell_contacts", "Told",
    ),
}  # fmt: skip


def docstrings(source):
    """Return (line, text) of every docstring in a source."""
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    found = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, kinds) and (text := ast.get_docstring(node)):
            found.append((node.body[0].lineno, text))
    return found


def comments(source):
    """Return (line, text) of every comment in a source."""
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    return [(token.start[0], token.string) for token in tokens if token.type == tokenize.COMMENT]


def absent_pages(source):
    """Return a message for every citation of a page that is not in the repository."""
    texts = docstrings(source) + comments(source)
    return [
        f"{line}: cites {page}, which is not in the repository" for line, text in texts for page in ABSENT.findall(text)
    ]


def complaints(source):
    """Return a message for every docstring and comment that breaks a rule."""
    found = [
        f"{line}: begins with a noun that is none: {text[:60]}"
        for line, text in docstrings(source)
        if FIRST.match(text)
    ]
    for line, text in docstrings(source) + comments(source):
        found += [f"{line}: speaks of {word} as of a person" for word in PERSONS.findall(text)]
    return found + absent_pages(source)


@pytest.mark.parametrize("path", PATHS, ids=[str(path.relative_to(ROOT)) for path in PATHS])
def test_docstrings_and_comments_are_plain(path):
    check = complaints if path.relative_to(ROOT).parts[0] in PLAIN else absent_pages
    assert check(path.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize(
    ("source", "count"),
    [
        ('"""What a body is made of."""', 1),
        ('"""Whoever sleeps keeps its contacts."""', 2),
        ("def f():\n    '''Nothing moves.'''\n", 1),
        ("x = 1  # nobody asks, see hard_cases B3\n", 2),
        ('"""Return what the caller asked for."""\nx = "whoever"  # a number\n', 0),
    ],
)
def test_what_breaks_a_rule_is_found(source, count):
    assert len(complaints(source)) == count


def identifiers(source):
    """Return (line, name) of every identifier in a source; words in strings and comments do not count."""
    found = []
    for node in ast.walk(ast.parse(source)):
        names = []
        for field in ("id", "attr", "arg", "name", "asname", "rest"):  # names, attributes, arguments, definitions
            value = getattr(node, field, None)
            names += value.split(".") if isinstance(value, str) else []
        if isinstance(node, ast.ImportFrom):
            names += (node.module or "").split(".")
        elif isinstance(node, ast.Global | ast.Nonlocal):
            names += node.names
        elif isinstance(node, ast.MatchClass):
            names += node.kwd_attrs
        found += [(getattr(node, "lineno", 0), name) for name in names]
    return found


@cache
def places_of_identifiers():
    """Return {identifier: ["path:line"]} of all sources, including the names of modules and folders."""
    places = {}
    for path in PATHS:
        where = path.relative_to(ROOT)
        found = identifiers(path.read_text(encoding="utf-8"))
        found += [(0, part) for part in where.with_suffix("").parts]
        for line, name in found:
            places.setdefault(name, []).append(f"{where.as_posix()}:{line}")
    return places


def returned(word, folders, places):
    """Return the positions in these folders where a replaced identifier occurs. places: result of
    `places_of_identifiers`.
    """
    return [each for each in places.get(word, []) if each.startswith(tuple(f"{folder}/" for folder in folders))]


@pytest.mark.parametrize(
    ("word", "folders"), [(word, folders) for folders, words in REPLACED.items() for word in words]
)
def test_a_replaced_identifier_does_not_come_back(word, folders):
    assert returned(word, folders, places_of_identifiers()) == []


@pytest.mark.parametrize(
    "source",
    [
        "wishes = 1",
        "x.wishes = 1",
        "def wishes(): pass",
        "class wishes: pass",
        "def f(wishes): pass",
        "f(wishes=1)",
        "import game.wishes as other",
        "from game.wishes import STEPS",
        "from game import wishes",
        "import game as wishes",
        "f'{wishes}'",
        "try: pass\nexcept ValueError as wishes: pass",
        "def f():\n    global wishes",
        "match x:\n    case {**wishes}: pass",
        "match x:\n    case Y(wishes=1): pass",
    ],
)
def test_a_planted_identifier_is_found(source):
    planted = {name: [f"game/planted.py:{line}"] for line, name in identifiers(source)}
    assert returned("wishes", ("game", "scenes"), planted) and not returned("wishes", ("physics",), planted)


@pytest.mark.parametrize("source", ['x = "wishes"  # wishes', '"""A wish, of wishes."""', "best_wishes = 1"])
def test_words_in_prose_are_free(source):
    assert not [name for _, name in identifiers(source) if name == "wishes"]
