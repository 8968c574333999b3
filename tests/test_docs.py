"""What the documents promise: the example runs, its lines stand in the text, the README's commands are there."""

import importlib.util
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent


def load_example():
    specification = importlib.util.spec_from_file_location("physics_alone", ROOT / "docs/physics_alone.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def test_the_example_finds_the_hits_that_groupcollide_finds():
    assert load_example().main() > 0


def test_the_lines_of_the_text_are_lines_of_the_example():
    example = (ROOT / "docs/physics_alone.py").read_text()
    squeezed = re.sub(r"\s+", "", example)
    for line in (
        "world = World(Effects.detection())",
        "sprite.body.move_to(sprite.rect.topleft)",
        "world.step()",
        "PixelMask.from_surface(sprite.image, origin=(0, 0)), position=sprite.rect.topleft",
        'world.body(hit["body_a"]).user, world.body(hit["body_b"]).user) for hit in world.contacts',
    ):
        assert re.sub(r"\s+", "", line) in squeezed
        assert re.sub(r"\s+", "", line) in re.sub(r"\s+", "", (ROOT / "docs/physics_alone.md").read_text())


def test_links_of_the_documents_lead_somewhere():
    for page in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]:
        for target in re.findall(r"\]\(([^)#:]+)\)", page.read_text()):
            assert (page.parent / target).exists(), f"{page.name} links to {target}, which is not there"


@pytest.mark.parametrize("marker", ["play command", "test command"])
def test_each_command_of_the_readme_is_one_line(marker):
    text = (ROOT / "README.md").read_text()
    block = re.search(rf"<!-- {marker} -->\n```sh\n(.*?)```", text, re.S)
    assert block and block.group(1).count("\n") == 1 and ".venv" in block.group(1) and "-e" in block.group(1)
