"""The store of compiled kernels: files in a private folder, which is checked before a file is loaded as code.

There is one file for each kernel and list of argument types. The name of a file contains a hash of all data on which
its contents depend, and the file starts with a checksum. Files are replaced atomically. A file that was not used for
KEPT [s] is deleted. If the folder is larger than LIMIT [bytes], the least recently used files are also deleted.
"""

import atexit
import contextlib
import hashlib
import os
import shutil
import stat
import sys
import tempfile
import threading
import time
import warnings
from collections.abc import Iterator
from functools import cache
from pathlib import Path

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

LIMIT = 240 << 20  # bytes: two checkouts and a bounds-checked run, at most 80 MB each
KEPT = 14 * 86_400.0  # [s] age at which an unused file is removed
DAY = 86_400.0  # [s] between two records of the use of a file
ABANDONED = 3_600.0  # [s] age at which an unfinished file counts as abandoned
PATIENCE = 120.0  # [s] longest wait for another process that compiles the same kernel
POLL = 0.02  # [s] between two attempts to get a lock
CHECKSUM = 16  # [bytes]
SUFFIX, UNFINISHED, CLAIMED = ".kernel", ".part", ".claim"

TEMPORARY = "hitbox-kernels-"  # beginning of the names of folders for one run
_opening = threading.Lock()


def cache_home() -> Path:
    """Return the path of the folder for compiled kernels, without creating the folder.

    It is the environment variable HITBOX_CACHE_DIR, or else a subfolder of the platform's cache folder.
    """
    override = os.environ.get("HITBOX_CACHE_DIR")
    if override:
        return Path(os.path.expanduser(override))
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local")) / "hitbox" / "compiled"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "hitbox" / "compiled"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "hitbox" / "compiled"


def make_private(folder: Path) -> str:
    """Create a folder that only this user can read and write. Return "", or the reason if this failed.

    An existing folder is not changed, with one exception: if it contains only kernels, other users' permission to read
    it is removed.
    """
    try:
        for each in (*reversed(folder.parents), folder):
            if not os.path.lexists(each):  # the mode does not depend on the umask: other users cannot write
                with contextlib.suppress(FileExistsError):
                    each.mkdir(mode=0o700)
        if folder.is_symlink():
            return f"{folder} is a link"
        if not folder.is_dir():
            return f"{folder} is not a folder"
        problem = _exposed(folder.resolve()) if hasattr(os, "getuid") else ""
        if not problem:
            with tempfile.TemporaryFile(dir=folder):
                pass
        return problem
    except OSError as error:
        return f"{folder}: {error.strerror or error}"


def _exposed(folder):
    """Return the reason if another user can write or read files in a folder, else "".

    If the folder contains only kernels and other users can only read it, it is made private instead.
    """
    info = folder.stat()
    if info.st_uid != os.getuid():
        return f"{folder} belongs to another user"
    if info.st_mode & 0o022:
        return f"{folder} can be written by others (mode {stat.S_IMODE(info.st_mode):04o}, 0700 is needed)"
    for above in folder.parents:
        mode = above.stat().st_mode
        if mode & stat.S_IWOTH and not mode & stat.S_ISVTX:
            return f"{above}, in which {folder} lies, can be written by others"
    if info.st_mode & 0o077:
        if any(not each.name.endswith((SUFFIX, UNFINISHED, CLAIMED)) for each in folder.iterdir()):
            return f"{folder} holds other files and can be read by others"
        folder.chmod(0o700)
    return ""


def store() -> "Store":
    """Return the Store of this process, which is made at the first call.

    Its folder is the first private and writable one of: cache_home(), a folder beside it, a temporary folder. If it is
    not cache_home(), this is reported on standard error. The temporary folder is deleted at exit.
    """
    with _opening:
        return _open_store()


@cache
def _open_store():
    home = cache_home().absolute()
    problem = make_private(home)
    if not problem:
        return Store(home)
    beside = home.with_name(f"{home.name}-private")
    if not make_private(beside):
        _warn(f"in {beside}: {problem}")
        return Store(beside)
    made = Store(Path(tempfile.mkdtemp(prefix=TEMPORARY)))
    _remove_at_exit(made.folder)
    _warn(f"for this run only: {problem}")
    return made


def _warn(where):
    if sys.stderr is not None:
        sys.stderr.write(f"hitbox: compiled kernels are kept {where}\n")


def _remove_at_exit(folder):
    """Have a temporary folder deleted at exit. Until then, a lock on the file `in-use` in it marks it as in use."""
    lock = _locked(folder / "in-use", wait=False)

    def remove():
        shutil.rmtree(folder, ignore_errors=True)
        if lock is not None:
            lock.close()

    atexit.register(remove)


def _locked(path, wait):
    """Open a file with an exclusive lock, and return it; return None if another process has locked it.

    The lock is released when the file is closed. wait: whether to wait for the lock. On a system without such locks
    every process gets the file, so two processes may do the same work.
    """
    file = open(path, "ab")  # noqa: SIM115, closed by the owner of the lock
    if fcntl is None:
        return file
    try:
        fcntl.flock(file, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except BlockingIOError:
        file.close()
        return None
    except OSError:
        return file  # on a file system without locks
    return file


class Store:
    """A store of compiled kernels, which are files in one private folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._said: set[str] = set()
        self._swept = False

    def read(self, name: str) -> bytes | None:
        """Return the contents of the file `name`, without the checksum; None if it is absent or damaged.

        The use of the file is recorded at most once a day.
        """
        path = self.folder / (name + SUFFIX)
        try:
            with open(path, "rb", opener=_no_link) as file:
                info = os.fstat(file.fileno())
                content = file.read()
        except FileNotFoundError:
            return None
        except OSError as error:
            self._say(f"compiled kernel {path.name} cannot be read ({error.strerror or error}): compiled again")
            return None
        foreign = hasattr(os, "getuid") and info.st_uid != os.getuid()
        if foreign or content[:CHECKSUM] != checksum(name, content[CHECKSUM:]):
            self._say(f"compiled kernel {path.name} is damaged: compiled again")
            with contextlib.suppress(OSError):
                path.unlink()
            return None
        if time.time() - info.st_mtime > DAY:
            with contextlib.suppress(OSError):
                os.utime(path)
        return content[CHECKSUM:]

    def has(self, name: str) -> bool:
        """Return whether the file `name` exists in the store."""
        return (self.folder / (name + SUFFIX)).exists()

    @property
    def empty(self) -> bool:
        """Whether the folder contains no compiled kernel."""
        return next(self.folder.glob("*" + SUFFIX), None) is None

    def write(self, name: str, content: bytes) -> None:
        """Write contents to the file `name`. A failure is reported once as a warning, and otherwise ignored."""
        path = self.folder / (name + SUFFIX)
        beside = self.folder / f"{name}.{os.getpid()}{UNFINISHED}"
        try:
            if not self._swept:
                self.sweep()
            beside.write_bytes(checksum(name, content) + content)
            beside.replace(path)
        except OSError as error:
            with contextlib.suppress(OSError):
                beside.unlink(missing_ok=True)
            self._say(f"compiled kernels cannot be kept in {self.folder} ({error.strerror or error})")

    def _say(self, line):
        if line not in self._said:
            self._said.add(line)
            warnings.warn(line, stacklevel=3)

    def sweep(self) -> None:
        """Delete files that were not used for KEPT [s], and the least recently used files above LIMIT [bytes] in total.

        Also delete unfinished files, claims and temporary folders of processes that were killed.
        """
        self._swept = True
        now = time.time()
        found = []
        for path in self.folder.iterdir():
            with contextlib.suppress(OSError):
                info = path.lstat()
                age = now - info.st_mtime
                if path.suffix == SUFFIX and age <= KEPT:
                    found.append((info.st_mtime, info.st_size, path))
                elif path.suffix == SUFFIX or (path.suffix in (UNFINISHED, CLAIMED) and age > ABANDONED):
                    path.unlink()
        size = sum(each for _, each, _ in found)
        for _, each, path in sorted(found):
            if size <= LIMIT:
                break
            size -= each
            with contextlib.suppress(OSError):
                path.unlink()
        _sweep_temporary()

    @contextlib.contextmanager
    def claim(self, name: str) -> Iterator[None]:
        """Return a context manager that locks a name, so that only one process compiles the kernel of this name.

        If another process has the lock, the context waits for it, but at most PATIENCE [s].
        """
        path, lock, until = self.folder / (name + CLAIMED), None, time.monotonic() + PATIENCE
        with contextlib.suppress(OSError):
            while (lock := _locked(path, wait=False)) is None and time.monotonic() < until:
                time.sleep(POLL)
        try:
            yield
        finally:
            if lock is not None:
                with contextlib.suppress(OSError):
                    path.unlink()
                lock.close()


def checksum(name: str, content: bytes) -> bytes:
    """Return the checksum (CHECKSUM bytes) at the beginning of a stored file: a hash of its name and contents."""
    return hashlib.blake2b(content, digest_size=CHECKSUM, key=hashlib.blake2b(name.encode()).digest()).digest()


def _no_link(path, flags):
    return os.open(path, flags | getattr(os, "O_NOFOLLOW", 0))


def _sweep_temporary():
    """Delete temporary folders that killed processes of this user have left: those whose lock is free."""
    if fcntl is None:
        return
    for folder in Path(tempfile.gettempdir()).glob(f"{TEMPORARY}*"):
        with contextlib.suppress(OSError):
            if folder.is_symlink() or folder.stat().st_uid != os.getuid():
                continue
            if time.time() - folder.stat().st_mtime < 60.0 and not (folder / "in-use").exists():
                continue  # just created
            lock = _locked(folder / "in-use", wait=False)
            if lock is not None:
                shutil.rmtree(folder, ignore_errors=True)
                lock.close()
