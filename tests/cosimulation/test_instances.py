"""Many instances: interleaved, in threads, in cycles; nothing is shared, nothing stays."""

import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from cosimulation import decks, raw
from cosimulation.decks import pack
from cosimulation.raw import OK, Fmu, Instance

STEPS = 5


def course(instance, fmu, scale):
    """Outputs after each of some steps whose inputs depend on `scale`."""
    (port, *_) = fmu.names("input")
    rows = []
    for k in range(STEPS):
        assert instance.set_values({port: scale * (k + 1)}) == OK
        assert instance.step(0.1 * k, 0.1) == OK, instance.log
        rows.append(instance.outputs())
    return rows


@pytest.mark.parametrize(("kind", "scale"), [("law_fmu", 1e-4), ("deck_fmu", -0.001)])
def test_interleaved_instances_do_not_see_each_other(request, new_instance, kind, scale):
    fmu = request.getfixturevalue(kind)
    scales = [scale * (1 + 0.1 * n) for n in range(8)]
    alone = [course(new_instance(fmu).start(), fmu, s) for s in scales]
    assert len({str(rows) for rows in alone}) == len(scales)
    together = [new_instance(fmu).start() for _ in scales]
    (port, *_) = fmu.names("input")
    rows = [[] for _ in scales]
    for k in range(STEPS):
        for instance, s in zip(together, scales, strict=True):
            instance.set_values({port: s * (k + 1)})
        for n in reversed(range(len(scales))):
            assert together[n].step(0.1 * k, 0.1) == OK
            rows[n].append(together[n].outputs())
    assert rows == alone


@pytest.mark.parametrize(("kind", "scale"), [("law_fmu", 1e-4), ("deck_fmu", -0.001)])
def test_instances_in_threads_give_the_bits_of_one_alone(request, new_instance, kind, scale):
    fmu = request.getfixturevalue(kind)
    expected = course(new_instance(fmu).start(), fmu, scale)
    results, failures = [], []

    def work():
        try:
            for _ in range(3):
                instance = Instance(fmu)
                assert instance.instantiate(logging=False)
                instance.start()
                results.append(course(instance, fmu, scale))
                instance.free()
        except BaseException as error:
            failures.append(error)

    threads = [threading.Thread(target=work) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(timeout=60)
    assert not failures
    assert results == [expected] * 18


def test_two_fmus_in_one_process_do_not_mix(law_fmu, deck_fmu, new_instance):
    law, deck = new_instance(law_fmu).start(), new_instance(deck_fmu).start()
    a, b = course(law, law_fmu, 1e-4), course(deck, deck_fmu, -0.001)
    assert course(new_instance(law_fmu).start(), law_fmu, 1e-4) == a
    assert course(new_instance(deck_fmu).start(), deck_fmu, -0.001) == b


def usage():
    """Resident kilobytes, open files, threads of this process."""
    status = Path("/proc/self/status").read_text()
    kilobytes = int(status.split("VmRSS:")[1].split()[0])
    threads = int(status.split("Threads:")[1].split()[0])
    return kilobytes, len(os.listdir("/proc/self/fd")), threads


@pytest.fixture(scope="module")
def small_fmu(tmp_path_factory):
    """Two bricks, so that a thousand preparations take seconds."""
    folder = tmp_path_factory.mktemp("small")
    (folder / "two.inp").write_text(decks.two_bricks())
    pack(folder / "two.inp", "-o", folder / "two.fmu")
    return Fmu.unpack(folder / "two.fmu", folder / "fmu")


@pytest.mark.parametrize(("kind", "cycles"), [("law_fmu", 10_000), ("small_fmu", 2_000)])
def test_cycles_of_instantiation_leave_nothing_behind(request, kind, cycles):
    fmu = request.getfixturevalue(kind)

    def cycle():
        instance = Instance(fmu)
        assert instance.instantiate(logging=False)
        if kind == "small_fmu":
            instance.start()
            instance.step(0, 0.5)
        instance.save()
        instance.free()

    for _ in range(cycles // 10):
        cycle()
    before = usage()
    for _ in range(cycles):
        cycle()
    after = usage()
    assert after[1:] == before[1:], "files and threads"
    assert after[0] - before[0] < 2048, f"{before} to {after}"


def test_states_that_are_never_freed_go_with_their_instance(law_fmu):
    def burden():
        instance = Instance(law_fmu)
        assert instance.instantiate(logging=False)
        for _ in range(2000):
            instance.save()
        instance.free()

    burden()
    before = usage()[0]
    for _ in range(10):
        burden()
    assert usage()[0] - before < 4096


RELOAD = """
import _ctypes, os, sys, threading, time
from pathlib import Path
from cosimulation.raw import Fmu, Instance

rows, opened = [], []

def use():
    fmu = Fmu(sys.argv[1])
    instance = Instance(fmu)
    assert instance.instantiate()
    instance.start()
    assert instance.step(0, 0.5) == 0
    rows.append(instance.outputs())
    instance.free()
    opened.append(fmu.library._handle)

def close():
    _ctypes.dlclose(opened.pop())

def threads():
    return len(os.listdir("/proc/self/task"))

def loaded():
    return str(Path(sys.argv[1]).resolve()) in Path("/proc/self/maps").read_text()

before = threads()  # numpy brings its own
if sys.argv[2] == "also here":
    for _ in range(3):
        use()
        close()
rows, first = [], rows
for _ in range(3):
    thread = threading.Thread(target=use)
    thread.start()
    thread.join()
    deadline = time.monotonic() + 10
    while threads() > before and time.monotonic() < deadline:
        pass
    assert threads() == before, "a thread survives"
    close()
assert len(rows) == 3 and all(row == rows[0] for row in first + rows)
if sys.argv[2] == "threads only":
    assert not loaded(), "the library could not be unloaded"
"""


@pytest.mark.parametrize("where", ["threads only", "also here"])
@pytest.mark.parametrize("kind", ["law_fmu", "deck_fmu"])
def test_the_library_can_be_unloaded_and_loaded_again(request, kind, where):
    # The linear algebra keeps work memory per thread; the library leaves the process when the threads that used it do.
    fmu = request.getfixturevalue(kind)
    path = str(Path(raw.__file__).resolve().parent.parent)
    done = subprocess.run(
        [sys.executable, "-c", RELOAD, str(fmu.folder), where],
        capture_output=True,
        text=True,
        check=False,
        env={"PYTHONPATH": path},
    )
    assert done.returncode == 0, done.stderr
