"""Commands in the report are quoted for the shell, so that folder names with spaces work."""

import json
import os
import shlex
import subprocess
import sys

import pytest

from game.report.page import command

ROW = {"job": "fall/1"}
FOLDERS = [
    "report",
    "my report",
    'it\'s a "report"',
    "$HOME; echo no",
    "`echo no`",
    "a*b?[c]",
    "back\\slash",
    "tab\there",
    "line\nbreak",
    "-report",
    "--quick",
    "!history",
    "~",
    "\N{GRINNING FACE}",
]
ECHO = "import json, sys; print(json.dumps(sys.argv[1:]))"


@pytest.mark.skipif(os.name == "nt", reason="another shell")
@pytest.mark.parametrize("quick", [False, True])
@pytest.mark.parametrize("folder", FOLDERS)
def test_the_shell_hands_on_what_was_given(tmp_path, folder, quick):
    line = command(ROW, folder, quick)
    program, arguments = line.split(" --report", 1)
    line = f"{shlex.quote(sys.executable)} -c {shlex.quote(ECHO)} --report{arguments}"
    done = subprocess.run(["sh", "-c", line], capture_output=True, text=True, cwd=tmp_path, check=True)
    from game.command_line import make_parser

    found = make_parser().parse_args(json.loads(done.stdout))
    assert (found.report, found.only, found.quick) == (folder, "fall/1", quick)


@pytest.mark.parametrize("job", ["fall/1", "chaos/it's", "scenes/lab/one way", "a/*"])
def test_a_job_is_quoted_too(job):
    assert shlex.split(command({"job": job}, "report", False))[-1] == job


def test_a_plain_name_stays_as_it_is():
    assert command(ROW, "out/report", True).endswith(" --report out/report --quick --only fall/1")
