"""The main job, end to end, as `make demo` runs it; and the check that it would notice a single bit."""

import math
import subprocess
import sys

import pytest

import demo
import support

PNG = b"\x89PNG\r\n\x1a\n"


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """The demonstration, run as a newcomer runs it: exit code, printed lines, folder."""
    out = tmp_path_factory.mktemp("demo")
    command = [sys.executable, support.ROOT / "examples" / "demo.py", "--out", out]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout.splitlines(), out


def test_every_output_is_bit_equal_in_all_three_ways(finished):
    lines, _ = finished
    rows = [line for line in lines if line.startswith(("punch16", "hertz54"))]
    assert len(rows) == 6, rows
    for deck in ("punch16", "hertz54"):
        ways = [line for line in rows if line.startswith(deck)]
        assert [line.split()[-1] for line in ways] == ["-", "yes", "yes"], ways
    assert any(line.startswith("29 outputs compared in each of 20 increments") for line in lines), lines


def test_the_forces_are_the_reference_ones(finished):
    lines, _ = finished
    for deck, force in (("punch16", -464.474), ("hertz54", -354.486)):
        for line in (line for line in lines if line.startswith(deck)):
            found = next(word for word in line.split() if word.startswith("-") and len(word) > 1)
            assert math.isclose(float(found), force, rel_tol=5e-4), line


def test_pictures_of_both_decks_are_drawn(finished):
    _, out = finished
    for name in ("punch16_cpress", "punch16_force", "hertz54_cpress", "hertz54_force"):
        data = (out / f"{name}.png").read_bytes()
        assert data.startswith(PNG) and len(data) > 20_000, name


def test_results_for_paraview_and_the_table_are_kept(finished):
    lines, out = finished
    kept = (out / "table.txt").read_text(encoding="utf-8").splitlines()
    assert kept == lines[-len(kept) :]
    assert (out / "punch16.pvd").is_file() and list(out.glob("hertz54_*.vtu"))


def answers():
    """A job with three equal answers."""
    job = demo.Job("punch", 2, None, None)
    for way in demo.WAYS:
        job.answers[way] = demo.Answer([0.5, 1.0], {"a": [0.1, 0.2], "b": [0.0, 1e300]}, 0.0, 0.0)
    return job


def test_equal_answers_have_no_differences():
    job = answers()
    demo.compare(job)
    assert job.differences == []


@pytest.mark.parametrize("way", demo.WAYS[1:])
def test_one_bit_in_one_increment_is_noticed(way):
    job = answers()
    job.answers[way].outputs["a"][1] = math.nextafter(0.2, 1.0)
    demo.compare(job)
    assert job.differences == [f"{way}: a differs in 1 increments, first in 2"]


def test_the_sign_of_zero_a_missing_output_and_another_time_are_noticed():
    job = answers()
    job.answers[demo.WAYS[1]].outputs["b"][0] = -0.0
    del job.answers[demo.WAYS[2]].outputs["b"]
    job.answers[demo.WAYS[2]].times[0] = math.nextafter(0.5, 1.0)
    demo.compare(job)
    assert job.differences == [
        f"{demo.WAYS[1]}: b differs in 1 increments, first in 1",
        f"{demo.WAYS[2]}: outputs on one side only: b",
        f"{demo.WAYS[2]}: times differ",
    ]
