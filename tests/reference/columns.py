"""Columns of the arrays that a step returns: name, type and meaning, from the comments at their definitions."""

import ast
import inspect
import io
import re
import tokenize
from functools import cache
from types import ModuleType
from typing import NamedTuple

import numpy as np

from physics import debug
from physics.queries import batches
from physics.tables import body, contact, joint, shape

SIBLING = re.compile(r"(?:[ab][xy]|[xyab]|angle)$")  # the end in which the names of one vector, pose or pair differ
TYPES = {"f": "float", "i": "int", "b": "bool", "U": "str"}


class Column(NamedTuple):
    """One column, or several with a common meaning."""

    names: tuple[str, ...]
    type: str
    meaning: str


class Array(NamedTuple):
    """An array of the API: how to read it, its table in the source, and the meaning of a row."""

    name: str
    dtype: np.dtype
    module: ModuleType
    tables: tuple[str, ...]  # names in the module whose definitions hold the fields, in order
    row: str


ARRAYS = (
    Array("world.bodies", body.BODY, body, ("BODY",), "a body, in the order of ids"),
    Array(
        "world.shapes", shape.SHAPE, shape, ("SHAPE",), "a shape, or a part of a mask's outline, in the order of ids"
    ),
    Array(
        "world.contacts, world.sleeping_contacts, body.contacts",
        contact.CONTACT_POINT,
        contact,
        ("CONTACT_FIELDS",),
        "a contact point, in the order of shape ids",
    ),
    Array(
        "world.events.begin, .persist, .end, .sensor_begin, .sensor_end",
        contact.EVENT,
        contact,
        ("EVENT_FIELDS",),
        "a pair of shapes, with its deepest point",
    ),
    Array(
        "world.events.hits", contact.HIT, contact, ("EVENT_FIELDS", "HIT_FIELDS"), "an impact, with its fastest point"
    ),
    Array("world.events.quarantined", contact.QUARANTINE, contact, ("QUARANTINE",), "a body that was disabled"),
    Array(
        "world.joints",
        joint.JOINT,
        joint,
        ("STATE", "SCRATCH", "COUPLED_STATE", "COUPLED_SCRATCH"),
        "a joint, in the order of ids",
    ),
    Array("world.events.broken", joint.BROKEN, joint, ("BROKEN",), "a joint that is gone"),
    Array(
        "world.ray_casts()", batches.RAY_HIT, batches, ("RAY_HIT",), "the first hit of a ray, in the order of the rays"
    ),
    Array("world.query_points()", batches.POINT_HIT, batches, ("POINT_HIT",), "a body that contains a point"),
    Array("debug.shape_rows()", debug.ROW, debug, ("ROW",), "a shape"),
    Array("debug.contact_points()", debug.POINT, debug, ("POINT",), "a contact point"),
    Array("debug.joints()", debug.DRAWN_JOINT, debug, ("DRAWN_JOINT",), "a joint"),
    Array("debug.part_edges()", debug.EDGE, debug, ("EDGE",), "an edge of a part"),
    Array("debug.impact_ghosts()", debug.GHOST, debug, ("GHOST",), "a body that was stopped"),
)


parsed = cache(ast.parse)


@cache
def comments(source: str) -> dict[int, str]:
    """Return {line number: comment} of a source."""
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    return {each.start[0]: each.string.lstrip("# ").strip() for each in tokens if each.type == tokenize.COMMENT}


def assignment(tree: ast.Module, name: str) -> ast.expr:
    """Return the expression that a module assigns to a name. Raises LookupError if there is none."""
    for node in tree.body:
        if isinstance(node, ast.Assign) and any(
            isinstance(each, ast.Name) and each.id == name for each in node.targets
        ):
            return node.value
    raise LookupError(f"no table {name}")


def fields(source: str, name: str) -> dict[str, str]:
    """Return {field: its comment} of a table in a source; "" for a field without a comment."""
    tree, known = parsed(source), comments(source)
    found: dict[str, str] = {}
    for node in ast.walk(assignment(tree, name)):
        if not (isinstance(node, ast.Tuple) and len(node.elts) == 2 and isinstance(node.elts[0], ast.Constant)):
            continue
        field = node.elts[0].value
        if isinstance(field, str) and isinstance(node.elts[1], ast.Attribute | ast.Constant):
            found[field] = known.get(node.end_lineno or 0, "")
    return found


@cache
def source_of(module: ModuleType) -> str:
    """Return the source of a module."""
    return inspect.getsource(module)


def sibling(name: str) -> str:
    """Return the name of a column with "*" in place of its last part, such as "v*" for "vx".

    The last part is the one in which the columns of a vector, a pose or a pair differ.
    """
    return SIBLING.sub("*", name)


def columns(array: Array) -> list[Column]:
    """Return the columns of an array in order; a column without a comment has the meaning ""."""
    source = source_of(array.module)
    known = {name: text for table in array.tables for name, text in fields(source, table).items()}
    found: list[Column] = []
    dtype = array.dtype
    for name in dtype.names or ():
        kind, text = TYPES[dtype[name].kind], known.get(name, "")
        last = found[-1] if found else None
        if not text and last and last.type == kind and last.meaning and sibling(name) == sibling(last.names[-1]):
            found[-1] = last._replace(names=(*last.names, name))
        else:
            found.append(Column((name,), kind, text))
    return found
