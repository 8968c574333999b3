"""Statements of the documents: the example runs, its lines are in the text, and the commands of the README exist."""

import ast
import math
import re
from pathlib import Path

import pygame
import pytest

from physics import Effects, PixelMask, World
from tests.installed_names import as_in_a_checkout

ROOT = Path(__file__).resolve().parent.parent


def run(source, name):
    """Run code written for an installed hitbox and return the names that it defines."""
    found = {"__name__": name}
    exec(compile(as_in_a_checkout(source), name, "exec"), found)
    return found


def test_the_example_finds_the_hits_that_groupcollide_finds():
    assert run((ROOT / "docs/physics_alone.py").read_text(), "physics_alone")["main"]() > 0


def test_the_ten_lines_of_the_readme_run(capsys):
    text = (ROOT / "README.md").read_text()
    (lines,) = re.findall(r"^## A world in ten lines\n.*?```python\n(.*?)```", text, re.S | re.M)
    assert "from hitbox.physics import" in lines and len(lines.splitlines()) <= 10
    run(lines, "ten_lines")
    assert "hit at" in capsys.readouterr().out


def test_the_lines_of_the_text_are_lines_of_the_example():
    example = (ROOT / "docs/physics_alone.py").read_text()
    squeezed = re.sub(r"\s+", "", example)
    for line in (
        "world = World(Effects.detection())",
        "world.move([sprite.body for sprite in sprites], [sprite.rect.topleft for sprite in sprites])",
        "world.step()",
        "world.touching(users=True)",
        "PixelMask.from_surface(sprite.image, origin=(0, 0)), position=sprite.rect.topleft",
    ):
        assert re.sub(r"\s+", "", line) in squeezed
        assert re.sub(r"\s+", "", line) in re.sub(r"\s+", "", (ROOT / "docs/physics_alone.md").read_text())


def test_a_turned_sprite_collides_as_pygame_draws_it():
    """A rotated mask collides as pygame draws the rotated sprite, as docs/physics_alone.md states.

    Its origin is the centre, its image is unrotated, and its angle is minus pygame's degrees.
    """
    assert "-math.radians(degrees)" in (ROOT / "docs/physics_alone.md").read_text()
    image = pygame.Surface((60, 40), pygame.SRCALPHA)
    pygame.draw.polygon(image, "white", [(0, 0), (59, 12), (10, 39)])
    mask = PixelMask.from_surface(image)
    for degrees in range(-170, 180, 35):
        world, rotated = World(Effects.detection()), pygame.transform.rotate(image, degrees)
        body = world.add_body(mask)
        body.move_to((100, 100), -math.radians(degrees))
        drawn, rect = pygame.mask.from_surface(rotated), rotated.get_rect(center=(100, 100))
        inside = [(x, y) for x in range(40, 160, 3) for y in range(40, 160, 3)]
        wanted = [rect.collidepoint(p) and bool(drawn.get_at((p[0] - rect.x, p[1] - rect.y))) for p in inside]
        found = [bool(world.query_point((x + 0.5, y + 0.5))) for x, y in inside]
        alike = sum(a == b for a, b in zip(wanted, found, strict=True)) / len(inside)
        assert sum(wanted) > 50 and alike > 0.97, f"{degrees} degrees: {alike:.3f} of the points agree"


def test_links_of_the_documents_lead_somewhere():
    for page in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]:
        for target in re.findall(r"\]\(([^)#:]+)\)", page.read_text()):
            assert (page.parent / target).exists(), f"{page.name} links to {target}, which is not there"


@pytest.mark.parametrize("marker", ["play command", "test command"])
def test_each_command_of_the_readme_is_one_line(marker):
    text = (ROOT / "README.md").read_text()
    block = re.search(rf"<!-- {marker} -->\n```sh\n(.*?)```", text, re.S)
    assert block and block.group(1).count("\n") == 1 and ".venv" in block.group(1) and "-e" in block.group(1)


def names_in(path):
    """Return the names of all functions and classes in a file, methods as Class.method."""
    found = set()
    for node in ast.parse(path.read_text()).body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            found.add(node.name)
        if isinstance(node, ast.ClassDef):
            found |= {f"{node.name}.{each.name}" for each in node.body if isinstance(each, ast.FunctionDef)}
            for base in node.bases:  # what a world is split over is the world's
                if isinstance(base, ast.Name):
                    found.add(f"{node.name}({base.id})")
    return found


def test_the_names_of_the_architecture_are_in_the_source():
    text = (ROOT / "ARCHITECTURE.md").read_text()
    links = re.findall(r"\[`([\w.]+)`\]\(([\w/.]+)\)", text)
    assert len(links) > 55
    wrong = [f"{name} in {path}" for name, path in links if name not in names_in(ROOT / path)]
    assert not wrong, f"ARCHITECTURE.md names what is not there: {', '.join(wrong)}"


@pytest.mark.parametrize("path", ["dt", "A position", "A contact", "A key press"])
def test_each_path_is_a_list_of_functions(path):
    text = (ROOT / "ARCHITECTURE.md").read_text()
    section = re.search(rf"^### {path}\n(.*?)(?=^###|\Z)", text, re.S | re.M)
    assert section, f"ARCHITECTURE.md has no path of {path}"
    steps = re.findall(r"^\d+\. \[`", section.group(1), re.M)
    assert len(steps) >= 8


def test_a_name_that_is_not_there_is_found():
    assert "World.step" in names_in(ROOT / "physics/world.py")
    assert "World.stop" not in names_in(ROOT / "physics/world.py")


def test_the_tests_that_hold_the_rules_of_measuring_exist():
    rules = re.findall(r"^\| (\d+)\. .*\| (.*) \|$", (ROOT / "docs/measuring.md").read_text(encoding="utf-8"), re.M)
    assert [int(number) for number, _ in rules] == list(range(1, 11))
    sources = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "tests").rglob("test_*.py"))
    for _, named in rules:
        names = re.findall(r"`(test_\w+)`", named)
        assert names and all(f"def {name}(" in sources for name in names), named
