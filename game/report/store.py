"""The folder of a report: what is measured is kept there at once, a file per job, so that nothing is lost.

manifest.json tells what the report is of: another version, or another choice of jobs, does not go on in it.
"""

import json
import tempfile
from pathlib import Path
from typing import Any

from game import VERSION
from game.errors import UsageError
from game.files.data_folder import write_atomically
from game.measure.machine import machine

MANIFEST, RESULTS = "manifest.json", "results"
FORMAT = 2  # of the rows: one higher whenever a chart asks something else of them


class Store:
    """Results by the name of their job. Raises UsageError for a folder that cannot be used, with the reason."""

    def __init__(self, folder: Path, quick: bool) -> None:
        self.folder, self.quick = folder, quick
        wanted = {"format": FORMAT, "version": VERSION, "quick": quick}
        if folder.exists() and not folder.is_dir():
            raise UsageError(f"--report: {folder} is a file; it takes the name of a folder")
        try:
            names = sorted(each.name for each in folder.iterdir()) if folder.exists() else []
            if names and MANIFEST not in names:
                raise UsageError(f"--report: {folder} holds something else ({names[0]}); name a new or an empty folder")
            if not names:
                (folder / RESULTS).mkdir(parents=True, exist_ok=True)
                write_atomically(folder / MANIFEST, json.dumps({**wanted, "machine": machine()}, indent=1))
            self.manifest = self._manifest()
            self._check_writable()
        except OSError as error:
            raise UsageError(f"--report: {folder} cannot be written: {error.strerror or error}") from error
        for name, word in (("format", "format"), ("version", "version")):
            if self.manifest.get(name) != wanted[name]:
                raise UsageError(
                    f"--report: {folder} holds a report of {word} {self.manifest.get(name)}, this is {wanted[name]}; "
                    "name another folder"
                )
        if self.manifest.get("quick") is not quick:
            kind, flag = ("quick", "with") if self.manifest.get("quick") else ("full", "without")
            raise UsageError(f"--report: {folder} holds a {kind} report; go on {flag} --quick, or name another folder")

    def _manifest(self) -> dict[str, Any]:
        path = self.folder / MANIFEST
        try:
            found = json.loads(path.read_text(encoding="utf-8"))
        except ValueError as error:
            raise UsageError(f"--report: {path} is damaged: {error}") from error
        if not isinstance(found, dict):
            raise UsageError(f"--report: {path} is damaged: no object")
        return found

    def _check_writable(self):
        with tempfile.NamedTemporaryFile(dir=self.folder):
            pass

    def _path(self, name):
        return self.folder / RESULTS / f"{name.replace('/', '--')}.json"

    def result(self, name: str) -> dict[str, Any] | None:
        """What is kept of a job; None where it is not done, or where its file is damaged: it is then done again."""
        try:
            found = json.loads(self._path(name).read_text(encoding="utf-8"))
        except (FileNotFoundError, ValueError):
            return None
        return found if isinstance(found, dict) and found.get("name") == name else None

    def keep(self, found: dict[str, Any]) -> None:
        """Keep what a job has found. Raises OSError."""
        write_atomically(self._path(found["name"]), json.dumps(found))
