"""The folder of compiled kernels: only its user can write to it, its size is limited, and its errors are handled."""

import errno
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

import physics
from physics.jit import store as module
from physics.jit.store import LIMIT, SUFFIX, Store, make_private

ROOT = Path(physics.__file__).resolve().parents[1]
posix = pytest.mark.skipif(not hasattr(os, "getuid"), reason="permissions and owners are of POSIX")
root = pytest.mark.skipif(not hasattr(os, "getuid") or os.getuid() != 0, reason="gives a folder away")
jitted = pytest.mark.skipif(not physics.JIT, reason="nothing is compiled")


def mode_of(path):
    return path.stat().st_mode & 0o777


@posix
@pytest.mark.parametrize("umask", [0o000, 0o002, 0o022, 0o077])
@pytest.mark.parametrize("name", ["kernels", "with a space", "ein Ordner/und noch einer/größer"])
def test_a_new_folder_is_private(tmp_path, umask, name):
    before = os.umask(umask)
    try:
        (tmp_path / "home").mkdir(mode=0o700)
        folder = tmp_path / "home" / name
        assert make_private(folder) == "" and mode_of(folder) == 0o700
    finally:
        os.umask(before)


def link_to(path, target):
    path.symlink_to(target, target_is_directory=True)


EXPOSED = {
    "a link": (lambda path: link_to(path, path.parent / "elsewhere"), "is a link"),
    "a link to nothing": (lambda path: path.symlink_to(path.parent / "nothing"), "is a link"),
    "a file": (lambda path: path.write_text("no folder"), "is not a folder"),
    "writable by all": (lambda path: (path.mkdir(), path.chmod(0o777)), "can be written by others"),
    "writable by all, sticky": (lambda path: (path.mkdir(), path.chmod(0o1777)), "can be written by others"),
    "writable by the group": (lambda path: (path.mkdir(), path.chmod(0o770)), "can be written by others"),
    "readable, with other files": (
        lambda path: (path.mkdir(), path.chmod(0o755), (path / "letter.txt").write_text("mine")),
        "holds other files",
    ),
}


@posix
@pytest.mark.parametrize("kind", EXPOSED)
def test_an_exposed_folder_is_not_used_and_not_changed(tmp_path, monkeypatch, capsys, kind):
    """An exposed folder's files are neither read nor changed; another folder is used in this and in later starts.

    The reason is reported.
    """
    make, reason = EXPOSED[kind]
    (tmp_path / "elsewhere").mkdir(mode=0o700)
    folder = tmp_path / "kernels"
    make(folder)
    before = folder.lstat(), sorted(os.listdir(folder)) if folder.is_dir() else None
    assert reason in make_private(folder)
    monkeypatch.setenv("HITBOX_CACHE_DIR", str(folder))
    for _ in range(2):
        module._open_store.cache_clear()
        assert module.store().folder == tmp_path / "kernels-private"
        assert mode_of(tmp_path / "kernels-private") == 0o700
        told = capsys.readouterr().err
        assert told.count("\n") == 1 and f"are kept in {folder}-private: " in told and reason in told
    module._open_store.cache_clear()
    after = folder.lstat(), sorted(os.listdir(folder)) if folder.is_dir() else None
    assert (after[0].st_mode, after[0].st_uid, after[1]) == (before[0].st_mode, before[0].st_uid, before[1])


@pytest.mark.parametrize("given, found", [("~/kernels", "{home}/kernels"), ("~nobody of that name/x", "{given}")])
def test_a_folder_may_be_named_from_home(monkeypatch, given, found):
    monkeypatch.setenv("HITBOX_CACHE_DIR", given)
    assert module.cache_home() == Path(found.format(home=Path.home(), given=given))


@root
def test_a_folder_of_somebody_else_is_not_used(tmp_path):
    folder = tmp_path / "kernels"
    folder.mkdir(mode=0o700)
    os.chown(folder, 65534, 65534)
    assert "belongs to another user" in make_private(folder)


@posix
def test_a_folder_within_one_that_all_can_write_is_not_used(tmp_path):
    (tmp_path / "open").mkdir()
    (tmp_path / "open").chmod(0o777)
    assert "in which" in make_private(tmp_path / "open" / "kernels")


@posix
def test_a_readable_folder_of_kernels_is_closed(tmp_path):
    folder = tmp_path / "kernels"
    folder.mkdir()
    folder.chmod(0o755)
    (folder / f"one{SUFFIX}").write_bytes(b"")
    assert make_private(folder) == "" and mode_of(folder) == 0o700


RUN = """
import sys
from physics.jit.store import store
print(store().folder)
if len(sys.argv) > 1:
    import os, signal
    os.kill(os.getpid(), signal.SIGKILL)
"""


def run(home, temporary, *arguments):
    environment = {**os.environ, "HITBOX_CACHE_DIR": str(home), "TMPDIR": str(temporary), "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-c", RUN, *arguments], capture_output=True, text=True, cwd=ROOT, env=environment
    )
    return done


@pytest.mark.skipif(sys.platform != "linux", reason="nobody can write to /proc")
def test_where_nothing_can_be_written_a_temporary_folder_serves_one_run(tmp_path):
    done = run("/proc/kernels", tmp_path)
    folder = Path(done.stdout.strip())
    assert folder.parent == tmp_path and not folder.exists()
    assert done.stderr.count("\n") == 1 and "for this run only: /proc/kernels" in done.stderr


@pytest.mark.skipif(sys.platform != "linux", reason="nobody can write to /proc")
def test_the_temporary_folder_of_a_killed_run_is_removed_by_a_later_one(tmp_path):
    run("/proc/kernels", tmp_path, "kill")
    (found,) = tmp_path.glob("hitbox-kernels-*")
    left = Store(tmp_path / "kernels")
    left.folder.mkdir()
    environment = {**os.environ, "HITBOX_CACHE_DIR": str(left.folder), "TMPDIR": str(tmp_path), "PYTHONPATH": str(ROOT)}
    code = "from physics.jit.store import store; store().sweep()"
    subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT, env=environment)
    assert not found.exists() and left.folder.exists()


@pytest.fixture
def kept(tmp_path):
    folder = tmp_path / "kernels"
    assert make_private(folder) == ""
    return Store(folder)


@pytest.mark.parametrize("cut", [0, 1, 15, 16, 17, 100, -1])
def test_a_file_cut_short_is_reported_and_removed(kept, cut):
    kept.write("one", b"x" * 200)
    assert kept.read("one") == b"x" * 200
    path = kept.folder / f"one{SUFFIX}"
    path.write_bytes(path.read_bytes()[:cut])
    with pytest.warns(UserWarning, match="one.kernel is damaged: compiled again"):
        assert kept.read("one") is None
    assert not path.exists() and kept.read("one") is None


@pytest.mark.parametrize("place", [0, 8, 15, 16, 50, 215])
def test_a_wrong_byte_is_noticed(kept, place):
    kept.write("one", bytes(range(200)))
    path = kept.folder / f"one{SUFFIX}"
    content = bytearray(path.read_bytes())
    content[place] ^= 1
    path.write_bytes(content)
    with pytest.warns(UserWarning, match="damaged"):
        assert kept.read("one") is None


@posix
def test_a_file_that_is_a_link_is_not_read(kept, tmp_path):
    kept.write("one", b"code")
    (tmp_path / "planted").write_bytes((kept.folder / f"one{SUFFIX}").read_bytes())
    (kept.folder / f"two{SUFFIX}").symlink_to(tmp_path / "planted")
    with pytest.warns(UserWarning, match="two.kernel cannot be read"):
        assert kept.read("two") is None


@pytest.mark.parametrize("error", [errno.ENOSPC, errno.EROFS, errno.EACCES, errno.EDQUOT])
def test_what_cannot_be_written_is_said_once(kept, monkeypatch, error):
    def fail(self, content):
        raise OSError(error, os.strerror(error))

    monkeypatch.setattr(Path, "write_bytes", fail)
    with pytest.warns(UserWarning, match="cannot be kept") as found:
        for number in range(5):
            kept.write(f"one{number}", b"code")
    assert len(found) == 1 and not os.listdir(kept.folder)


@pytest.mark.parametrize(("days", "stays"), [(0.0, True), (13.9, True), (14.1, False), (400.0, False)])
def test_what_was_not_used_for_two_weeks_goes(kept, days, stays):
    kept.write("one", b"code")
    at = time.time() - days * 86_400.0
    os.utime(kept.folder / f"one{SUFFIX}", (at, at))
    kept.sweep()
    assert kept.has("one") == stays


@pytest.mark.parametrize("used", range(4))
def test_what_was_used_last_stays_when_the_folder_outgrows_its_limit(kept, monkeypatch, used):
    """The most recently used files stay when the folder exceeds its limit.

    There are four files and room for two. The file number `used` is read first, which counts as use.
    """
    monkeypatch.setattr(module, "LIMIT", 2 * 1016)
    for number in range(4):
        kept.write(f"k{number}", b"x" * 1000)
        at = time.time() - 86_400.0 * (9 - number)
        os.utime(kept.folder / f"k{number}{SUFFIX}", (at, at))
    assert kept.read(f"k{used}") is not None
    kept.sweep()
    newest = [each for each in range(4) if each != used][-1]
    assert {each for each in range(4) if kept.has(f"k{each}")} == {used, newest}
    assert LIMIT == 240 << 20


@pytest.mark.parametrize("suffix", [".part", ".claim"])
@pytest.mark.parametrize(("hours", "stays"), [(0.5, True), (2.0, False)])
def test_what_a_killed_process_left_goes_after_an_hour(kept, suffix, hours, stays):
    path = kept.folder / f"one.123{suffix}"
    path.write_bytes(b"")
    os.utime(path, (time.time() - hours * 3600.0,) * 2)
    kept.sweep()
    assert path.exists() == stays


HOLD = """
import sys, time
from pathlib import Path
from physics.jit.store import Store
with Store(Path(sys.argv[1])).claim("one"):
    print("held", flush=True)
    time.sleep(60)
"""


@pytest.mark.skipif(module.fcntl is None, reason="everybody has every claim there")
def test_a_claim_ends_with_its_process_and_is_not_waited_for_for_ever(kept, monkeypatch):
    other = subprocess.Popen(
        [sys.executable, "-c", HOLD, str(kept.folder)],
        stdout=subprocess.PIPE,
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )
    assert other.stdout is not None and other.stdout.readline().strip() == b"held"
    monkeypatch.setattr(module, "PATIENCE", 0.3)
    started = time.monotonic()
    with kept.claim("one"):
        assert time.monotonic() - started >= 0.3, "it waits, and goes on without"
    other.kill()
    other.wait()
    other.stdout.close()
    monkeypatch.setattr(module, "PATIENCE", 60.0)
    started = time.monotonic()
    with kept.claim("one"):
        assert time.monotonic() - started < 30.0


COMPILE = """
import json, warnings
from physics import Circle, Effects, World
from physics.jit import kernels as totals
world = World(Effects())
world.add_body(Circle(4))
world.add_body(Circle(4), position=(3, 0))
world.step()
print(json.dumps([totals.compiled, totals.loaded, len(world.contacts)]))
"""


@jitted
def test_two_programs_that_start_at_once_compile_each_kernel_once(tmp_path):
    environment = {**os.environ, "HITBOX_CACHE_DIR": str(tmp_path / "kernels"), "PYTHONPATH": str(ROOT)}
    both = [
        subprocess.Popen([sys.executable, "-c", COMPILE], stdout=subprocess.PIPE, cwd=ROOT, env=environment, text=True)
        for _ in range(2)
    ]
    found = [json.loads(each.communicate()[0].splitlines()[-1]) for each in both]
    files = [each for each in os.listdir(tmp_path / "kernels") if not each.startswith("all.")]
    assert all(compiled + loaded == sum(found[0][:2]) and touching == 1 for compiled, loaded, touching in found)
    assert sum(compiled for compiled, *_ in found) == found[0][0] + found[0][1]
    assert not [each for each in files if not each.endswith(SUFFIX)]
