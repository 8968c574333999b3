"""Conversion of a source for the wheel: imports are changed to hitbox, all else is unchanged,
and no old name remains.
"""

import ast
import json
import os
import re
import subprocess
import sys
from pkgutil import resolve_name

import pytest

from physics.jit import workers
from tests.installed_names import ROOT, layout_module, own_modules

layout = layout_module()

IMPORTS = [
    ("from physics import World", "from hitbox.physics import World"),
    ("from physics import jit", "from hitbox.physics import jit"),
    ("from physics import World as physics", "from hitbox.physics import World as physics"),
    ("from physics.jit.files import read, write as w", "from hitbox.physics.jit.files import read, write as w"),
    ("from physics import *", "from hitbox.physics import *"),
    ("from physics import (\n    A,  # physics\n    B)", "from hitbox.physics import (\n    A,  # physics\n    B)"),
    ("from  game.run   import replay", "from  hitbox.game.run   import replay"),
    ("from \\\n  scenes import SCENES", "from \\\n  hitbox.scenes import SCENES"),
    ("from main import main", "from hitbox.main import main"),
    ("import physics", "from hitbox import physics"),
    ("import physics as p", "import hitbox.physics as p"),
    ("import physics.jit as jit", "import hitbox.physics.jit as jit"),
    ("import physics.jit", 'from hitbox import physics; __import__("hitbox.physics.jit")'),
    ("import os, physics, sys as s", "import os; from hitbox import physics; import sys as s"),
    ("import os, physics.jit as j", "import os; import hitbox.physics.jit as j"),
    ("import os, \\\n    physics\nx = 1", "import os; from hitbox import physics \\\n\nx = 1"),
    ("if True: import physics; y = 2", "if True: from hitbox import physics; y = 2"),
    ("def f():\n    from assets import X\n    return X", "def f():\n    from hitbox.assets import X\n    return X"),
    ("try:\n    import game\nfinally:\n    x = 1", "try:\n    from hitbox import game\nfinally:\n    x = 1"),
    ("x = 'ä'; from physics import World", "x = 'ä'; from hitbox.physics import World"),
]  # fmt: skip
KEPT = [
    "from . import physics",
    "from .physics import World",
    "from ..game import run",
    "import physics_x, xphysics, gamepad",
    "from physics_x import World",
    "from other.physics import World",
    "import other.game",
    "import os.path",
    "# from physics import World",
    '"""from physics import World\n\nimport physics\n`python -m game.run.worker` in main.py"""',
    'def f():\n    """Return physics.World; python main.py."""',
    'class A:\n    """game.run."""\n    x = 1\n    """What physics.x is."""',
    "physics = 1\nphysics.real",
    "name = 'physics'\nkey = {'game': 1, 'scenes': 2}['game']",
    "text = 'It is played in the game. And in any scene, mid-game: all of it.'",
    "text = 'the physics, the game.'",
    "text = f'{1} hits in the game'",
    "text = 'coins from scenes, an import duty, from game to game'",
    "path = 'assets/levels/game.tmj', '../scenes.x/y', 'my-game.zip'",
    "name = 'hitbox.physics', 'other.physics.x', 'gamepad.x', 'physics_x.y', 'mygame.x'",
    "found = {'a': 1}.get('game')",
    "x = '%s games' % 3 + 'game'",
    "subprocess.run(['python', '-m', 'pip', 'install', 'hitbox'])",
    "note = 'python -m pip install numba', 'domain.py'",
]
REFUSED = [
    ("x = 'physics.world'", "physics.world"),
    ("x = 'game.report.charts.far:measure'", "game.report.charts.far"),
    ("x = 'scenes:SCENES'", "scenes:SCENES"),
    ("x = 'see physics.decompose for it'", "physics.decompose"),
    ("x = f'game.run.{1}'", "game.run"),
    ("x = f'game.{name}'", "game."),
    ("x = f'{1}assets.ui'", "assets.ui"),
    ("x = 'scenes.' + name", "scenes."),
    ("x = 'a' + 'scenes.' + name", "scenes."),
    ("x = 'scenes.%s' % name", "scenes."),
    ("x = 'scenes.{}'.format(name)", "scenes."),
    ("x = b'physics.world'", "physics.world"),
    ("x = {'game.run': 1}", "game.run"),
    ("def f(x: 'physics.World'): pass", "physics.World"),
    ("import_module('game')", "game"),
    ("importlib.import_module(name='game')", "game"),
    ("__import__('physics')", "physics"),
    ("importlib.util.find_spec('main')", "main"),
    ("pkgutil.resolve_name('scenes')", "scenes"),
    ("importlib.resources.files('assets')", "assets"),
    ("sys.modules['physics']", "physics"),
    ("sys.modules.get('physics')", "physics"),
    ("'physics' in sys.modules", "physics"),
    ("monkeypatch.setattr('game.app.clock', 1)", "game.app.clock"),
    ("subprocess.run([python, '-m', 'game'])", "game"),
    ("subprocess.run((python, '-m', 'main', '--list'))", "main"),
    ("run(python, '-m', 'scenes')", "scenes"),
    ("exec('import physics; physics.World()')", "physics.World"),
    ("exec('import physics')", "import physics"),
    ("subprocess.run([python, '-c', 'from game import run'])", "from game import"),
    ("x = 'run: python -m game'", "-m game"),
    ("x = 'python -m  assets.build'", "assets.build"),
    ("x = 'python main.py --list'", "main.py"),
    ("x = 'pip install -e .'", "pip install -e"),
    ("x = 'pip install --quiet -e .'", "pip install --quiet -e"),
    ("def f():\n    x = 'game.run'\n    return x", "game.run"),
]


def converted(source):
    return layout.converted(source)


@pytest.mark.parametrize("source, wanted", IMPORTS, ids=[source for source, _ in IMPORTS])
def test_an_import_is_rewritten_in_its_line(source, wanted):
    found, left = converted(source + "\n")
    assert found == wanted + "\n" and left == []
    ast.parse(found)
    assert len(found.splitlines()) >= len(source.splitlines()), "what follows keeps its line"
    for node in ast.walk(ast.parse(found)):
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        names += [node.module] if isinstance(node, ast.ImportFrom) and not node.level else []
        assert not {name.split(".")[0] for name in names} & set(layout.TOPS)


@pytest.mark.parametrize("source", KEPT)
def test_all_else_stays_as_it_is(source):
    assert converted(source + "\n") == (source + "\n", [])


@pytest.mark.parametrize("source, name", REFUSED, ids=[source for source, _ in REFUSED])
def test_a_string_that_names_the_checkout_is_refused(source, name):
    (problem,) = converted(f"\n{source}\n")[1]
    line = 1 + next(k for k, each in enumerate(source.splitlines(), 1) if name in each)
    assert problem.line == line and problem.text.startswith(f"{name!r} in ")


@pytest.mark.parametrize("top", layout.TOPS)
def test_the_rules_are_the_same_for_every_package(top):
    for source, wanted in IMPORTS[:4]:
        assert converted(source.replace("physics", top))[0] == wanted.replace("physics", top)
    for source, _ in REFUSED:
        if "main.py" not in source and " -e " not in source:  # a command names none
            old = next(each for each in layout.TOPS if re.search(rf"\b{each}\b", source))
            assert converted(re.sub(rf"\b{old}\b", top, source))[1], source


def project(folder, files):
    """Write a small checkout with these files {name: text} and the required ones, and return its folder."""
    given = {"main.py": "from game import VERSION\n", "game/__init__.py": 'VERSION = "1.2"\n'}
    given |= {f"{name}/__init__.py": "" for name in ("assets", "physics", "scenes")}
    for name, text in {**given, **files}.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        (folder / name).write_bytes((ROOT / name).read_bytes())
    return folder


@pytest.mark.parametrize("name, text", [
    ("game/run.py", "x = 'game.run'\n"),
    ("main.py", "x = 'game.run'\n"),
    ("assets/levels/a.json", '{"module": "physics.world"}'),
    ("assets/levels/a.txt", "made by python -m assets.build\n"),
    ("game/report/page.html", "<p>python main.py --report"),
])  # fmt: skip
def test_a_build_stops_and_lists_every_name(tmp_path, name, text):
    more = {"scenes/other.py": "y = 1\n\nx = 'scenes.other:X'\n"}
    with pytest.raises(layout.LayoutError) as caught:
        layout.stage(project(tmp_path / "from", {name: text, **more}), tmp_path / "to")
    lines = str(caught.value).splitlines()
    assert lines[0].startswith("2 names of the checkout's layout")
    assert lines[1].startswith(f"{name}:1: ") and lines[2].startswith("scenes/other.py:3: 'scenes.other'")


def test_the_staged_project_has_one_package(tmp_path):
    files = {
        "assets/images/a.png": "x",
        "assets/notes.md": "x",
        "game/report/page.html": "<p>",
        "physics/__pycache__/a.py": "",
    }
    layout.stage(project(tmp_path / "from", files), tmp_path / "to")
    there = {path.relative_to(tmp_path / "to").as_posix() for path in (tmp_path / "to").rglob("*") if path.is_file()}
    assert there == {
        "LICENSE", "README.md", "pyproject.toml",
        "hitbox/__init__.py", "hitbox/__main__.py", "hitbox/main.py", "hitbox/py.typed",
        "hitbox/assets/__init__.py", "hitbox/assets/images/a.png", "hitbox/game/__init__.py",
        "hitbox/game/report/page.html", "hitbox/physics/__init__.py", "hitbox/scenes/__init__.py",
    }  # fmt: skip


def test_a_source_distribution_holds_what_is_kept():
    """A source distribution contains exactly the entries that git has at the top level."""
    source = ast.parse((ROOT / ".ci/wheel/backend.py").read_text())
    values = {node.targets[0].id: node.value for node in source.body if isinstance(node, ast.Assign)}
    kept = ast.literal_eval(values["KEPT"])
    assert all((ROOT / name).exists() for name in kept)
    if (ROOT / ".git").exists():
        listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
        assert set(kept) == {name.split("/")[0] for name in listed.splitlines()}


def test_what_is_allowed_is_there_and_reported_in_a_checkout_only():
    for name, text in layout.ALLOWED:
        values = [
            node.value for node in ast.walk(ast.parse((ROOT / name).read_text())) if isinstance(node, ast.Constant)
        ]
        assert text in values, f"{name} no longer says {text!r}: take it out of ALLOWED"


def derived():
    """Yield (position, name) of each string f"{__package__}.x:y" or f"{__name__}:y" in the sources."""
    for top in layout.PACKAGES:
        for path in sorted((ROOT / top).rglob("*.py")):
            if not re.search(r"f['\"]{__(?:package|name)__}", path.read_text(encoding="utf-8")):
                continue
            name = ".".join(path.relative_to(ROOT).with_suffix("").parts)
            package = name.removesuffix(".__init__") if path.stem == "__init__" else name.rpartition(".")[0]
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.JoinedStr) and len(node.values) == 2:
                    first, rest = node.values
                    known = {"__package__": package, "__name__": name}.get(
                        getattr(getattr(first, "value", None), "id", "")
                    )
                    if known and isinstance(rest, ast.Constant):
                        yield f"{path.relative_to(ROOT)}:{node.lineno}", known + str(rest.value)


def test_names_that_are_derived_lead_somewhere():
    found = dict(derived())
    assert len(found) > 15
    for place, name in found.items():
        assert resolve_name(name), place


@pytest.fixture(scope="module")
def staged(tmp_path_factory):
    """Return a folder with the project as in a wheel, and beside it a user's project.

    The user's project has modules with the same names as those of the checkout.
    """
    folder = tmp_path_factory.mktemp("staged")
    layout.stage(ROOT, folder / "site")
    own_modules(folder / "project")
    return folder


ALL = """
import importlib, json, pkgutil, sys
import hitbox
names = [each.name for each in pkgutil.walk_packages(hitbox.__path__, "hitbox.") if not each.name.endswith("__main__")]
for name in names:
    try:
        importlib.import_module(name)
    except ModuleNotFoundError as error:  # of an extra
        assert "hitbox" not in error.name and error.name.split(".")[0] not in %r, error
import game, physics
print(json.dumps([len(names), [each for each in sys.modules if each.split(".")[0] in %r], hitbox.__version__]))
""" % (layout.TOPS, layout.TOPS)  # noqa: UP031


def run(staged, *arguments, **environment):
    """Run Python in the user's project with the staged package on its path; return its standard output."""
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=staged / "project",
        env={**os.environ, "PYTHONPATH": str(staged / "site"), "PYGAME_HIDE_SUPPORT_PROMPT": "1", **environment},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_every_module_is_imported_from_hitbox_beside_the_user_s_own(staged):
    out = run(staged, "-c", ALL).splitlines()
    count, imported, version = json.loads(out[-1])
    sources = [path for top in layout.PACKAGES for path in (ROOT / top).rglob("*.py")]
    assert count >= len(sources), "with main, and __init__ counted as its package"
    assert out[:-1] == ["the user's own game", "the user's own physics"] and imported == ["game", "physics"]
    from game import VERSION

    assert version == VERSION


def test_it_starts_as_a_module(staged):
    checkout = subprocess.run([sys.executable, "main.py", "--version"], cwd=ROOT, capture_output=True, text=True)
    assert run(staged, "-m", "hitbox", "--version") == checkout.stdout != ""


CHILD = """
import sys
from hitbox.physics.jit.workers import IMPORTED_FROM, end_all, search_path, start_module
child = start_module("hitbox.game.report.worker")
child.stdin.write('{"name": "a", "work": "%s", "params": {}}\\n')
child.stdin.flush()
print(child.stdout.readline())
end_all([child])
"""


def test_a_child_does_not_pick_up_what_lies_in_the_current_folder(staged):
    """A child process imports modules of the package, not modules of the same names in the current folder.

    The latter belong to the user, and have an attribute OWN.
    """
    assert json.loads(run(staged, "-c", CHILD % "hitbox.physics:World.step.__name__.upper"))["rows"] == "STEP"
    for own in ("physics", "game"):
        found = json.loads(run(staged, "-c", CHILD % f"{own}:OWN.__class__"))
        assert "No module named" in found["failed"] or "no attribute 'OWN'" in found["failed"]


@pytest.mark.parametrize("given", [None, "/a/b", f"/a{os.pathsep}/b"])
@pytest.mark.parametrize("installed", [False, True])
def test_the_path_of_a_child(monkeypatch, tmp_path, given, installed):
    """The search path of a child process has the checkout first, then the paths in the user's PYTHONPATH.

    For an installed package the path is not changed, because it contains site-packages by itself.
    """
    monkeypatch.setattr(workers.site, "getsitepackages", lambda: [str(tmp_path)])
    monkeypatch.setattr(workers, "IMPORTED_FROM", tmp_path.resolve() if installed else ROOT)
    monkeypatch.delenv("PYTHONPATH", raising=False)
    if given is not None:
        monkeypatch.setenv("PYTHONPATH", given)
    wanted = {} if installed else {"PYTHONPATH": os.pathsep.join([str(ROOT), *filter(None, [given])])}
    assert workers.search_path() == wanted


def test_a_child_of_a_checkout_does_not_pick_up_what_lies_in_the_current_folder(tmp_path):
    own_modules(tmp_path)
    code = CHILD.replace("hitbox.", "") % "physics:World.step.__name__.upper"
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYGAME_HIDE_SUPPORT_PROMPT": "1"}
    done = subprocess.run(
        [sys.executable, "-P", "-c", code], cwd=tmp_path, env=environment, capture_output=True, text=True, check=True
    )
    assert json.loads(done.stdout)["rows"] == "STEP"
