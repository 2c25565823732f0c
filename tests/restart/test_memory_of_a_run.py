"""JOB.json remembers what happened to the increments."""

import itertools

import pytest

import support

HARD = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"


@pytest.fixture
def collision(write_deck):
    """Two bricks with hard surfaces and every direction of them prescribed: they meet at a quarter of the step."""
    text = (support.ROOT / "examples" / "two_blocks.inp").read_text()
    start, end = text.index("*SURFACE BEHAVIOR"), text.index("*CONTACT PAIR")
    text = f"{text[:start]}{HARD}\n{text[end:]}"
    text = text.replace("*NSET, NSET=NBOT\n1, 2, 3, 4\n", "*NSET, NSET=NBOT\n1, 2, 3, 4, 5, 6, 7, 8\n")
    text = text.replace("15, 16, 17, 18\n*SURFACE", "11, 12, 13, 14, 15, 16, 17, 18\n*SURFACE")
    return write_deck(text.replace("0.25, 1.\n", "0.2, 1., 0.01\n"))


def test_each_cutback_is_told_with_its_reason(tmp_path, collision):
    done = support.call("run", collision, "--out", tmp_path, "--quiet")
    assert done.returncode == 3, done.stderr
    summary = support.Result(tmp_path, "deck").summary()
    (step,), cutbacks = summary["steps"], summary["cutbacks"]
    assert step["cutbacks"] == len(cutbacks) >= 1
    first = cutbacks[0]
    assert (first["step"], first["increment"], first["attempt"]) == (1, 2, 1)
    assert (first["increment_size"], first["next_size"]) == (0.2, 0.05)
    assert "total time 0.2" in first["reason"] and "nothing can give way" in first["reason"]
    for earlier, later in itertools.pairwise(cutbacks):
        if later["attempt"] > 1:
            assert (later["attempt"], later["increment"]) == (earlier["attempt"] + 1, earlier["increment"])
            assert later["increment_size"] == pytest.approx(earlier["next_size"], rel=1e-12)
    assert step["increment_min"] < 0.2 == step["increment_max"]
    assert summary["time_reached"] == pytest.approx(0.25, rel=0.05)


def test_a_run_without_trouble_has_no_cutbacks(tmp_path):
    assert support.run(support.ROOT / "examples" / "two_blocks.inp", tmp_path).summary()["cutbacks"] == []
