"""A deck that was prepared before starts from disk, with the same bits; sessions of one deck hold one copy of it."""

import re
import subprocess
from pathlib import Path

import pytest

import generate_deck
import overclosure
import support


@pytest.fixture
def punch(tmp_path):
    """A small punch in a few increments."""
    deck = tmp_path / "punch.inp"
    generate_deck.generate(["punch", "6", str(deck), "--increments", "3"])
    return deck


def files(result):
    """Content of everything that a run wrote but JOB.json, which tells the times."""
    return {path.name: path.read_bytes() for path in result.folder.iterdir() if path.suffix != ".json"}


def factorizations(result):
    return [step["factorizations"] for step in result.summary()["steps"]]


def test_a_second_run_factors_nothing_and_writes_the_same_files(tmp_path, punch):
    plain = support.run(punch, tmp_path / "plain")
    first = support.run(punch, tmp_path / "first", "--cache", tmp_path / "models")
    second = support.run(punch, tmp_path / "second", "--cache", tmp_path / "models", "--threads", 2)
    assert factorizations(plain) == factorizations(first) == [2]
    assert factorizations(second) == [0]
    assert files(plain) == files(first) == files(second)
    assert len(files(plain)) >= 4
    assert "numeric" not in second.summary()["wall_seconds"]


@pytest.mark.parametrize("place", [0.0, 0.02, 0.5, 0.999])
def test_a_damaged_model_is_said_and_does_no_harm(tmp_path, punch, place):
    plain = support.run(punch, tmp_path / "plain")
    support.run(punch, tmp_path / "first", "--cache", tmp_path / "models")
    [model] = (tmp_path / "models").iterdir()
    content = bytearray(model.read_bytes())
    content[int(place * (len(content) - 1))] ^= 1
    model.write_bytes(content)
    done = support.call("run", punch, "--out", tmp_path / "again", "--quiet", "--cache", tmp_path / "models")
    assert done.returncode == 0
    assert model.name in done.stderr and "damaged" in done.stderr
    assert files(support.Result(tmp_path / "again", "punch")) == files(plain)


def test_a_model_on_the_sparse_path_is_not_kept_and_that_is_said(tmp_path, punch):
    models = tmp_path / "models"
    done = support.call("run", punch, "--out", tmp_path / "out", "--quiet", "--path", "sparse", "--cache", models)
    assert done.returncode == 0
    assert "sparse path" in done.stderr
    assert not models.exists()


def test_two_sessions_of_a_deck_hold_one_copy(tmp_path):
    deck = tmp_path / "punch.inp"
    generate_deck.generate(["punch", "12", str(deck)])
    command = [support.binary(), "serve", "--listen", "tcp/127.0.0.1:0", "--cache", tmp_path / "models"]
    with subprocess.Popen(list(map(str, command)), stdout=subprocess.PIPE, text=True) as daemon:
        try:
            locator = re.search(r"listens on (\S+?)(,|$)", daemon.stdout.readline().strip())[1]

            def resident():
                """Resident memory of the daemon [MB]."""
                status = Path(f"/proc/{daemon.pid}/status").read_text()
                return int(re.search(r"VmRSS:\s+(\d+)", status)[1]) / 1024

            with overclosure.connect(locator) as client:
                sizes, fields = [resident()], []
                for _ in range(2):
                    session = client.open(deck)
                    session.step(1.0)
                    fields.append(session.field("U").values)
                    sizes.append(resident())
            first, second = sizes[1] - sizes[0], sizes[2] - sizes[1]
            assert first > 20 and second < 0.2 * first, sizes
            assert (fields[0] == fields[1]).all()
        finally:
            daemon.terminate()
    assert len(list((tmp_path / "models").iterdir())) == 1
