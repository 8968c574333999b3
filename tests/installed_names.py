"""Module names of the installed package (`hitbox.physics`) and of a checkout (`physics`), and their conversion."""

import importlib.util
import re
import sys
from pathlib import Path
from types import ModuleType

ROOT = Path(__file__).resolve().parent.parent


def layout_module() -> ModuleType:
    """Return .ci/wheel/layout.py as a module; it belongs to no package."""
    if "layout" not in sys.modules:
        specification = importlib.util.spec_from_file_location("layout", ROOT / ".ci/wheel/layout.py")
        assert specification is not None and specification.loader is not None
        sys.modules["layout"] = module = importlib.util.module_from_spec(specification)
        specification.loader.exec_module(module)
    return sys.modules["layout"]


def as_in_a_checkout(source: str) -> str:
    """Convert code that imports from the installed hitbox into code for a checkout."""
    return re.sub(r"\bhitbox\.(?=(?:assets|game|main|physics|scenes)\b)", "", source)


def own_modules(folder):
    """Write a user's project whose modules have the names of the checkout's modules; each
    prints a line when imported.
    """
    for top in layout_module().TOPS:
        path = folder / (f"{top}.py" if top in ("physics", "main") else f"{top}/__init__.py")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("print('the user\\'s own ' + __name__)\nOWN = True\n", encoding="utf-8")
