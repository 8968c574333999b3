"""The folder of a report. The result of each job is written to its own file at once, so that no result is lost.

manifest.json describes the report. A report of another version, or of another extent (--quick), is not continued.
"""

import json
import tempfile
from pathlib import Path
from typing import Any

from game import VERSION
from game.errors import FileError, UsageError, brief
from game.files.data_folder import write_atomically
from game.files.json_file import read_json
from game.files.leftovers import remove_leftovers
from game.measure.machine import machine

MANIFEST, RESULTS, DATA = "manifest.json", "results", "data"
FORMAT = 3  # version of the rows: incremented whenever a chart changes its rows


class Store:
    """The stored results of a report's jobs. Raises UsageError, with the reason, if the folder cannot be used."""

    def __init__(self, folder: Path, quick: bool) -> None:
        self.folder, self.quick = folder, quick
        wanted = {"format": FORMAT, "version": VERSION, "quick": quick}
        shown = brief(folder, 120)
        try:
            if folder.exists() and not folder.is_dir():
                raise UsageError(f"--report: {shown} is a file; it takes the name of a folder")
            names = sorted(each.name for each in folder.iterdir()) if folder.exists() else []
            if names and MANIFEST not in names:
                other = brief(names[0], 80)
                raise UsageError(f"--report: {shown} holds something else ({other}); name a new or an empty folder")
            if not names:
                (folder / RESULTS).mkdir(parents=True, exist_ok=True)
                write_atomically(folder / MANIFEST, json.dumps({**wanted, "machine": machine()}, indent=1))
            self.manifest = self._manifest()
            self._check_writable()
        except OSError as error:
            raise UsageError(f"--report: {shown} cannot be written: {error.strerror or error}") from error
        except ValueError as error:  # a name that no system allows
            raise UsageError(f"--report: {shown} cannot be written: {error}") from error
        remove_leftovers(folder, ("", RESULTS, DATA))
        for name, word in (("format", "format"), ("version", "version")):
            found = self.manifest.get(name)
            if found != wanted[name]:
                raise UsageError(
                    f"--report: {shown} holds a report of {word} {found!s:.40}, this is {wanted[name]}; "
                    "name another folder"
                )
        if self.manifest.get("quick") is not quick:
            kind, flag = ("quick", "with") if self.manifest.get("quick") else ("full", "without")
            raise UsageError(f"--report: {shown} holds a {kind} report; go on {flag} --quick, or name another folder")

    def _manifest(self) -> dict[str, Any]:
        path = self.folder / MANIFEST
        try:
            found = read_json(path)
        except FileError as error:
            raise UsageError(f"--report: {brief(path, 120)} is damaged: {error.place}: {error.reason}") from error
        if not isinstance(found, dict):
            raise UsageError(f"--report: {brief(path, 120)} is damaged: no object")
        return found

    def _check_writable(self):
        with tempfile.NamedTemporaryFile(dir=self.folder):
            pass

    def _path(self, name):
        return self.folder / RESULTS / f"{name.replace('/', '--')}.json"

    def result(self, name: str) -> dict[str, Any] | None:
        """Return the stored result of a job; None if the job has not run, or if its file is damaged."""
        try:
            found = read_json(self._path(name))
        except FileError:
            return None
        return found if isinstance(found, dict) and found.get("name") == name else None

    def keep(self, found: dict[str, Any]) -> None:
        """Store the result of a job, in the form that run_job() returns. Raises OSError."""
        write_atomically(self._path(found["name"]), json.dumps(found))
