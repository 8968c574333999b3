"""A type checker reports every wrong line of a user's program, and no correct one.

basedpyright belongs to the extra `dev`. Without it this test is skipped; `.ci/run` runs it after installing the extra.
"""

import json
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
MARK = "# wrong"

pytestmark = pytest.mark.skipif(find_spec("basedpyright") is None, reason="basedpyright is not installed: extra dev")


def reports():
    """Return {file name: {line: [messages]}} of the errors that basedpyright reports in right.py and wrong.py."""
    command = [sys.executable, "-m", "basedpyright", "--pythonpath", sys.executable, "--outputjson"]
    files = [str(HERE / "right.py"), str(HERE / "wrong.py")]
    ran = subprocess.run([*command, *files], cwd=ROOT, capture_output=True, text=True, timeout=600)
    assert ran.returncode in (0, 1), ran.stderr
    found = {"right.py": {}, "wrong.py": {}}
    for each in json.loads(ran.stdout)["generalDiagnostics"]:
        if each["severity"] == "error":
            lines = found[Path(each["file"]).name]
            lines.setdefault(each["range"]["start"]["line"] + 1, []).append(each["message"])
    return found


def marked_lines():
    """Return {line: text} of the lines of wrong.py that are wrong."""
    lines = (HERE / "wrong.py").read_text(encoding="utf-8").splitlines()
    return {number: text.strip() for number, text in enumerate(lines, 1) if text.endswith(MARK)}


def test_every_wrong_line_is_reported_and_no_right_one():
    found, wanted = reports(), marked_lines()
    assert found["right.py"] == {}
    wrong = found["wrong.py"]
    assert len(wanted) > 90
    assert [text for line, text in wanted.items() if line not in wrong] == [], "not reported"
    assert {line: messages for line, messages in wrong.items() if line not in wanted} == {}, "reported without a mark"
    kind = next(line for line, text in wanted.items() if 'kind="dynmic"' in text)
    assert any("KindName" in message for message in wrong[kind])
