"""Contents of an installation: every kind of file that the game reads, one version, a licence, and hooks for tools.

The long tests build a wheel and a source distribution. They install the wheel beside a user's own modules of the same
names, and run it inside that project. Its results must equal those of the checkout.
"""

import json
import os
import re
import subprocess
import sys
import sysconfig
import tomllib
import zipfile
from pathlib import Path
from tarfile import open as open_tar
from types import SimpleNamespace

import pytest

from game import VERSION
from tests.installed_names import as_in_a_checkout, own_modules

ROOT = Path(__file__).resolve().parent.parent
SETTINGS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PACKAGES = ("assets", "game", "physics", "scenes")


def files_of(package):
    """Return the paths, relative to the package, of all files that belong to it."""
    return [
        path.relative_to(ROOT / package)
        for path in (ROOT / package).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts and not path.name.startswith(".")
    ]


@pytest.mark.parametrize("package", PACKAGES)
def test_every_file_is_installed(package):
    """Every file of a package is covered by package-data in pyproject.toml; otherwise a wheel
    would silently lack it.
    """
    patterns = SETTINGS["tool"]["setuptools"]["package-data"].get(package, [])
    for path in files_of(package):
        if path.suffix == ".py":
            assert (ROOT / package / path).with_name("__init__.py").exists(), f"{path.parent} is no package"
        else:
            assert any(path.match(pattern) for pattern in patterns), (
                f"{package}/{path} would not be installed: add *{path.suffix} to package-data in pyproject.toml"
            )


def test_no_pattern_is_left_over():
    for package, patterns in SETTINGS["tool"]["setuptools"]["package-data"].items():
        for pattern in patterns:
            assert any(path.match(pattern) for path in files_of(package)), f"{package} has no {pattern}"


def test_the_version_stands_in_one_place():
    assert "version" not in SETTINGS["project"] and SETTINGS["project"]["dynamic"] == ["version"]
    assert SETTINGS["tool"]["setuptools"]["dynamic"]["version"] == {"attr": "game.VERSION"}
    newest = re.search(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.M)
    assert newest and newest[1] in (VERSION, "Unreleased"), "say in CHANGELOG.md what this version brings"
    for path in [ROOT / "main.py", *(ROOT / "game").rglob("*.py")]:
        if path != ROOT / "game" / "__init__.py":
            assert f'"{VERSION}"' not in path.read_text(encoding="utf-8"), f"{path.name} writes the version again"


def test_the_licence_is_there():
    text = (ROOT / "LICENSE").read_text(encoding="utf-8")
    assert SETTINGS["project"]["license"] == "MIT" and text.startswith("MIT License")
    assert "Copyright (c) 2026 the Hitbox authors" in text


def test_an_index_can_show_and_find_the_project():
    project = SETTINGS["project"]
    assert project["readme"] == "README.md" and 20 < len(project["description"]) < 120 and project["authors"]
    assert len(project["keywords"]) == len(set(project["keywords"])) > 4
    classifiers = project["classifiers"]
    oldest = project["requires-python"].removeprefix(">=")
    assert f"Programming Language :: Python :: {oldest}" in classifiers and classifiers == sorted(set(classifiers))
    assert "Typing :: Typed" in classifiers and not any(each.startswith("License") for each in classifiers)
    assert "urls" not in project, "there is no public page yet; name it here when there is one"


def test_each_hook_runs_a_tool_of_an_extra():
    hooks = (ROOT / ".pre-commit-config.yaml").read_text(encoding="utf-8")
    extras = SETTINGS["project"]["optional-dependencies"]
    offered = {re.split(r"[<>=]", each)[0] for extra in ("dev", "test") for each in extras[extra]}
    tools = re.findall(r"entry: \.venv/bin/python -m (\w+)", hooks)
    assert len(tools) == hooks.count("entry:") == 4 and set(tools) <= offered


BUILD = """
import backend, sys
_, folder, *hooks = sys.argv  # setuptools has others in their place
print(*[getattr(backend, hook)(folder) for hook in hooks])
"""
QUIET = {"SDL_VIDEODRIVER": "dummy", "SDL_AUDIODRIVER": "dummy", "PYGAME_HIDE_SUPPORT_PROMPT": "1"}
PLAIN = {"NUMBA_DISABLE_JIT": "1"}  # the same bits as compiled, and nothing to wait for


def call(*command, cwd, **environment):
    """Run a program and return its standard output. Fails with its error output if it fails."""
    environment = {**{k: v for k, v in os.environ.items() if k != "PYTHONPATH"}, **QUIET, **environment}
    done = subprocess.run(list(map(str, command)), cwd=cwd, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, f"{command}: {done.stderr[-3000:]}"
    return done.stdout


def build(tools, source, folder, *hooks):
    """Call hooks of the build backend in a source tree; return the paths of the files that they build.

    tools: folder with the build requirements.
    """
    folder.mkdir()
    out = call(
        sys.executable, "-c", BUILD, folder, *hooks,
        cwd=source, PYTHONPATH=os.pathsep.join([str(tools), str(source / ".ci/wheel")]),
    )  # fmt: skip
    return [folder / name for name in out.split()[-len(hooks) :]]


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Return the built files: `wheel`, `sdist`, and `again`, a wheel built from the sdist."""
    folder = tmp_path_factory.mktemp("built")
    requires = SETTINGS["build-system"]["requires"]
    call(sys.executable, "-m", "pip", "install", "--quiet", "--target", folder / "tools", *requires, cwd=folder)
    wheel, sdist = build(folder / "tools", ROOT, folder / "dist", "build_wheel", "build_sdist")
    with open_tar(sdist) as archive:
        archive.extractall(folder / "source", filter="data")
    (source,) = (folder / "source").iterdir()
    (again,) = build(folder / "tools", source, folder / "again", "build_wheel")
    return SimpleNamespace(wheel=wheel, sdist=sdist, again=again, source=source, tools=folder / "tools")


def environment_beside(folder):
    """Make an environment with the packages of this one, except editable installations.

    Returns (its Python, path of its command `hitbox`, its site-packages).
    """
    call(sys.executable, "-m", "venv", "--without-pip", folder, cwd=folder.parent)
    bin_folder = folder / ("Scripts" if os.name == "nt" else "bin")
    python = bin_folder / Path(sys.executable).name
    site = call(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))", cwd=folder).strip()
    (Path(site) / "beside.pth").write_text(sysconfig.get_path("purelib") + "\n")
    return python, bin_folder / "hitbox", Path(site)


@pytest.fixture(scope="module")
def user(made, tmp_path_factory):
    """Return the environment of a user who has installed the wheel.

    The user's project has modules with the same names as those of the checkout.
    """
    folder = tmp_path_factory.mktemp("user")
    python, command, site = environment_beside(folder / "environment")
    pip = (sys.executable, "-m", "pip", "--python", python)
    call(*pip, "install", "--quiet", "--no-deps", "--no-index", made.wheel, cwd=folder)
    own_modules(folder / "project")
    data = {"HITBOX_DATA": str(folder / "data")}

    def run(*arguments, **environment):
        return call(*arguments, cwd=folder / "project", **data, **environment)

    return SimpleNamespace(run=run, python=python, command=command, site=site, project=folder / "project", data=data)


def test_the_wheel_takes_one_name(made, user):
    with zipfile.ZipFile(made.wheel) as archive:
        names = archive.namelist()
        points = archive.read(f"hitbox-{VERSION}.dist-info/entry_points.txt").decode()
        metadata = archive.read(f"hitbox-{VERSION}.dist-info/METADATA").decode()
    assert {name.split("/")[0] for name in names} == {"hitbox", f"hitbox-{VERSION}.dist-info"}
    for name in ("Summary", "Author", "Keywords", "License-Expression", "License-File", "Requires-Python"):
        assert re.search(rf"^{name}: .", metadata, re.M), f"the wheel has no {name}"
    assert "Classifier: Typing :: Typed" in metadata and "# Hitbox" in metadata
    assert points.split() == ["[console_scripts]", "hitbox", "=", "hitbox.main:main"]
    for package in PACKAGES:
        for path in files_of(package):
            assert f"hitbox/{package}/{path.as_posix()}" in names
    assert {"hitbox/__init__.py", "hitbox/__main__.py", "hitbox/main.py", "hitbox/py.typed"} <= set(names)
    assert not {each.name for each in user.site.iterdir()} & {*PACKAGES, "main", "main.py"}


def test_the_same_wheel_is_built_of_the_sdist(made):
    """A wheel built from the source distribution is the same: RECORD has the hash of every file.

    The source distribution is a whole checkout, with tests and documents.
    """
    records = []
    for path in (made.wheel, made.again):
        with zipfile.ZipFile(path) as archive:
            records.append(sorted(archive.read(f"hitbox-{VERSION}.dist-info/RECORD").splitlines()))
    assert records[0] == records[1] and len(records[0]) > 500
    for name in (
        "PKG-INFO",
        "README.md",
        "docs/cookbook.md",
        "tests/test_packaging.py",
        ".ci/wheel/layout.py",
        ".ci/run",
    ):
        assert (made.source / name).is_file(), name


def test_every_door_says_the_same_version(user):
    checkout = call(sys.executable, "main.py", "--version", cwd=ROOT)
    assert user.run(user.command, "--version") == user.run(user.python, "-m", "hitbox", "--version") == checkout
    assert user.run(user.python, "-c", "import hitbox; print(hitbox.__version__)").strip() == VERSION


WORLDS = """
import numpy as np
from hitbox.physics import Character, Circle, Effects, PixelMask, Polygon, World

disc = np.hypot(*np.ogrid[-8:9, -8:9]) <= 8
piles = Effects.rigid_bodies()
for effects, solver in ((Effects.detection(), None), (piles, None), (piles, "blocking")):
    world = World(effects, solver=solver, seed=3)
    world.add_body(Polygon.box(400, 20), position=(200, 300), kind="static")
    for k in range(6):
        shape = (Circle(8), Polygon.box(14, 10), PixelMask.from_array(disc))[k % 3]
        world.add_body(shape, position=(180 + 7 * k, 280 - 19 * k), velocity=(10, 20))
    for _ in range(40):
        world.step()
    print(world.digest(), len(world.contacts))
"""


def test_worlds_step_as_in_the_checkout(user, tmp_path):
    script = tmp_path / "worlds.py"
    script.write_text(WORLDS)
    found = user.run(user.python, script, **PLAIN)
    script.write_text(as_in_a_checkout(WORLDS))
    assert found == call(sys.executable, script, cwd=tmp_path, PYTHONPATH=str(ROOT), **PLAIN)
    assert len(set(found.split())) >= 4


@pytest.mark.parametrize("scene, frames", [("shooter", 60), ("platformer", 20), ("lander", 20), ("lab/cradle", 60)])
def test_a_recording_of_the_checkout_is_replayed(user, tmp_path, scene, frames):
    record = ["--scene", scene, "--headless", "--bot", "--frames", frames, "--json", "--record", tmp_path / "run.json"]
    first = json.loads(call(sys.executable, "main.py", *record, cwd=ROOT, **PLAIN, **user.data))
    replayed = user.run(user.command, "--headless", "--replay", tmp_path / "run.json", "--json", **PLAIN)
    assert json.loads(replayed)["digest"] == first["digest"]


def test_a_report_is_measured_by_workers(user):
    report = ["--report", "my report", "--quick", "--workers", "2", "--only", "broadphases/*-10"]
    assert "0 failed" in user.run(user.command, *report, **PLAIN)
    found = [json.loads(path.read_text()) for path in (user.project / "my report/results").glob("*.json")]
    assert len(found) > 3 and all(each["rows"] for each in found)
    page = (user.project / "my report/index.html").read_text(encoding="utf-8")
    assert "hitbox --report &#x27;my report&#x27; --quick --only broadphases/" in page and "main.py" not in page


MEASURED = """
import time
from hitbox.game.measure.surveyor import Surveyor
from hitbox.physics import Circle, Effects, World

world, surveyor = World(Effects.detection()), Surveyor()
for x in (0, 9):
    world.add_body(Circle(5), position=(x, 0))
surveyor.measure(world.snapshot(), "brute")
until = time.monotonic() + 300
while not surveyor.survey.dots and not surveyor.trouble and time.monotonic() < until:
    surveyor.turn()
    time.sleep(0.1)
print(len(surveyor.survey.dots) > 0, surveyor.trouble)
surveyor.stop()
"""
COMPILED = """
import time
from hitbox import physics

background = physics.compile_in_background(1)
world = physics.World(physics.Effects())
world.add_body(physics.Circle(4))
world.step()
until = time.monotonic() + 300
while background.share == 0.0 and time.monotonic() < until:
    time.sleep(0.1)
    world.step()
print(background.share > 0.0, background.failed)
"""


@pytest.mark.parametrize("code, wanted, environment", [(MEASURED, "True", PLAIN), (COMPILED, "True []", {})])
def test_background_workers_work(user, tmp_path, code, wanted, environment):
    script = tmp_path / "program.py"
    script.write_text(code)
    found = user.run(user.python, script, HITBOX_CACHE_DIR=str(tmp_path / "kernels"), **environment)
    assert found.strip() == wanted


def test_an_editable_install_keeps_the_names_of_the_checkout(made, tmp_path):
    """An editable installation keeps the module names of the checkout.

    It installs the unpacked source distribution, so that nothing is written into this checkout.
    """
    python, command, _ = environment_beside(tmp_path / "environment")
    pip = (sys.executable, "-m", "pip", "--python", python)
    install = (*pip, "install", "--quiet", "--no-deps", "--no-index", "--no-build-isolation", "-e", made.source)
    call(*install, cwd=tmp_path, PYTHONPATH=str(made.tools))
    own_modules(tmp_path / "project")
    project = tmp_path / "project"
    assert call(command, "--version", cwd=project) == call(sys.executable, "main.py", "--version", cwd=ROOT)
    where = call(python, "-P", "-c", "import game, physics; print(physics.__file__)", cwd=project).strip()
    assert Path(where) == made.source / "physics/__init__.py"
