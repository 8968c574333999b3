"""Docstrings are plain technical English: they begin with a verb or a noun, and do not speak of things as persons.

PLAIN lists the folders that hold to all rules. Comments are read from the tokens, so that a word in a string does not
count.
"""

import ast
import io
import re
import tokenize

import pytest

from tests.architecture import ROOT, TOPS, sources

PLAIN = ("physics", "game", "scenes", "assets", "tests")  # folders that hold to all rules
FIRST = re.compile(r"(What|Who|Whoever|Whom|Whose|Nobody|Somebody|Nothing|Everything|That which)\b")
PERSONS = re.compile(r"\b(whoever|whomever|nobody|somebody|anybody|everybody)\b", re.IGNORECASE)
ABSENT = re.compile(r"\bhard_cases\b|\bdesign\.md\b|\bapi\.md\b")  # pages that a reader of the repository cannot open
PATHS = [path for top in (*TOPS, "tests") for path in sources(top)]


def docstrings(source):
    """Return (line, text) of every docstring of a module, its classes and functions."""
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    found = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, kinds) and (text := ast.get_docstring(node)):
            found.append((node.body[0].lineno, text))
    return found


def comments(source):
    """Return (line, text) of every comment."""
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    return [(token.start[0], token.string) for token in tokens if token.type == tokenize.COMMENT]


def absent_pages(source):
    """Return a line for every citation of a page that is not in the repository."""
    texts = docstrings(source) + comments(source)
    return [
        f"{line}: cites {page}, which is not in the repository" for line, text in texts for page in ABSENT.findall(text)
    ]


def complaints(source):
    """Return a line for every docstring and comment that breaks a rule."""
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
