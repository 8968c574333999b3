"""Analysis of the arguments that a kernel writes: directly, through a row (`b = bodies[i]; b.vx = 0.0`), or by a call.

The analysis uses the syntax tree and ignores order: a name that is once bound to a row of an argument always counts.
"""

import ast

WRITTEN = ("_out", "_inout", "scratch", "workspace")  # how the name of what is written ends
PASS_ON = ("enumerate", "zip", "reversed")  # calls that give out rows of what they are given


def undeclared_writes(source, parameters=None):
    """Return [(line, kernel, argument)] of writes to arguments whose names do not end in WRITTEN.

    source: Python text in which every function counts as a kernel. parameters: {kernel name: its parameter names} of
    kernels that may be called. An argument passed as a written parameter counts as written.
    """
    found = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.FunctionDef):
            found += [(line, node.name, argument) for line, argument in writes_of(node, parameters or {})]
    return found


def writes_of(function, parameters):
    """Return [(line, argument)] of the writes in one function node, in the order of the lines.

    parameters: {kernel name: its parameter names} of the kernels that it may call.
    """
    rows = {each.arg: {each.arg} for each in (*function.args.posonlyargs, *function.args.args)}
    bindings = [binding for node in ast.walk(function) for binding in bound_by(node)]
    while True:  # until no name is known to stand for more
        before = sum(map(len, rows.values()))
        for target, value in bindings:
            bind(target, value, rows)
        if sum(map(len, rows.values())) == before:
            break
    found = set()
    for node in ast.walk(function):
        for target in stores_of(node):
            found |= {(target.lineno, argument) for argument in behind(target.value, rows)}
        if isinstance(node, ast.Call):
            for name, handed in zip(parameters.get(ast.unparse(node.func), ()), node.args, strict=False):
                if name.endswith(WRITTEN):
                    found |= {(node.lineno, argument) for argument in behind(handed, rows)}
    return sorted((line, argument) for line, argument in found if not argument.endswith(WRITTEN))


def bound_by(node):
    """Yield (target, value) for each name that a statement or expression binds."""
    if isinstance(node, ast.Assign):
        yield from ((target, node.value) for target in node.targets)
    elif isinstance(node, (ast.AnnAssign, ast.NamedExpr)) and node.value is not None:
        yield node.target, node.value
    elif isinstance(node, (ast.For, ast.comprehension)):
        yield node.target, node.iter


def bind(target, value, rows):
    """Add to `rows` the arguments to which the names in a target may refer. rows: {name: set of arguments}."""
    if isinstance(target, (ast.Tuple, ast.List)):
        alike = isinstance(value, (ast.Tuple, ast.List)) and len(value.elts) == len(target.elts)
        for number, each in enumerate(target.elts):
            bind(each, value.elts[number] if alike else value, rows)
    elif isinstance(target, ast.Starred):
        bind(target.value, value, rows)
    elif isinstance(target, ast.Name):
        rows.setdefault(target.id, set()).update(behind(value, rows))


def behind(node, rows):
    """Return the set of arguments that an expression may refer to, as a whole or in part.

    It is empty for an attribute whose name ends in WRITTEN, which declares the write. rows: {name: set of arguments}.
    """
    if isinstance(node, ast.Name):
        return rows.get(node.id, set())
    if isinstance(node, ast.Attribute):
        return set() if node.attr.endswith(WRITTEN) else behind(node.value, rows)
    if isinstance(node, (ast.Subscript, ast.Starred, ast.NamedExpr)):
        return behind(node.value, rows)
    if isinstance(node, ast.IfExp):
        return behind(node.body, rows) | behind(node.orelse, rows)
    if isinstance(node, (ast.Tuple, ast.List)):
        return set().union(*(behind(each, rows) for each in node.elts))
    if isinstance(node, ast.Call) and ast.unparse(node.func) in PASS_ON:
        return set().union(*(behind(each, rows) for each in node.args))
    return set()


def stores_of(node):
    """Yield the nodes of attributes and items that a statement writes, also those within a tuple."""
    if isinstance(node, ast.Assign):
        targets = node.targets
    elif isinstance(node, (ast.AugAssign, ast.AnnAssign, ast.For)):
        targets = [node.target]
    else:
        return
    for target in targets:
        for each in ast.walk(target):
            if isinstance(each, (ast.Attribute, ast.Subscript)) and isinstance(each.ctx, ast.Store):
                yield each
