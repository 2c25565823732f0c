"""Nonsense on the command line is refused with exit code 2 and a reason."""

import pytest

import generate_deck
import support

DECK = support.ROOT / "examples" / "two_blocks.inp"


def refused(*arguments):
    """Standard error of a call that must end with 2."""
    done = support.call(*arguments)
    assert done.returncode == 2, (done.returncode, done.stdout, done.stderr)
    assert "panicked" not in done.stderr
    return done.stderr


@pytest.mark.parametrize("value", ["nan", "inf", "-inf", "NaN"])
def test_a_port_that_is_not_finite_is_refused(tmp_path, value):
    message = refused("run", DECK, "--out", tmp_path, "--set", f"boundary.NTOP.3={value}")
    assert "boundary.NTOP.3" in message and "finite" in message


@pytest.mark.parametrize("value", ["", "deep", "1,5", "1e"])
def test_a_port_value_that_is_no_number_is_refused(tmp_path, value):
    assert "boundary.NTOP.3" in refused("run", DECK, "--out", tmp_path, "--set", f"boundary.NTOP.3={value}")


def test_an_unknown_port_is_refused_and_the_known_ones_are_named(tmp_path):
    message = refused("run", DECK, "--out", tmp_path, "--set", "boundary.NTIP.3=1")
    assert "boundary.NTIP.3" in message and "boundary.NTOP.3" in message


def test_a_set_port_replaces_the_magnitude(tmp_path):
    result = support.run(DECK, tmp_path, "--set", "boundary.NTOP.3=-0.01")
    moved = [float(row["U3"]) for row in result.last("nodes")]
    assert moved == [-0.01] * 4


def test_a_deck_that_needs_more_memory_than_it_may_is_refused_with_numbers(tmp_path):
    deck = tmp_path / "punch.inp"
    generate_deck.generate(["punch", 9, deck])
    message = refused("run", deck, "--out", tmp_path / "out", "--memory-limit", "1M")
    assert "FOUNDATION" in message and "1.0 MB may be used" in message
    assert not (tmp_path / "out").exists()
    assert support.run(deck, tmp_path / "out", "--memory-limit", "0.5G").summary()["outcome"] == "completed"


@pytest.mark.parametrize("size", ["0", "-1G", "4X", "much", "nan", ""])
def test_a_memory_limit_that_makes_no_sense_is_refused(tmp_path, size):
    assert "memory-limit" in refused("run", DECK, "--out", tmp_path, f"--memory-limit={size}")
    assert "memory-limit" in refused("serve", f"--memory-limit={size}")


@pytest.mark.parametrize(
    ("kind", "parameters", "words"),
    [
        ("linear", [], ["stiffness"]),
        ("linear", ["stiffness=0"], ["stiffness"]),
        ("linear", ["stiffness=-3"], ["stiffness"]),
        ("linear", ["stiffness=nan"], ["stiffness"]),
        ("linear", ["stiffness=soft"], ["stiffness", "soft"]),
        ("linear", ["stiffness=1", "stifness=2"], ["stifness"]),
        ("linear", ["stiffness=1", "separation=prevented"], ["separation"]),
        ("exponential", ["c0=0", "p0=1"], ["clearance_at_zero_pressure"]),
        ("exponential", ["c0=0.1", "p0=0"], ["pressure_at_zero_clearance"]),
        ("exponential", ["c0=0.1", "p0=1", "separation=prevented", "procedure=explicit"], ["separation"]),
        ("exponential", ["c0=0.1", "p0=1", "kmax=10"], []),
        ("tabular", ["table=0:0"], ["two"]),
        ("tabular", ["table=0:0,1:0"], ["increas"]),
        ("tabular", ["table=0:0,2:0.1,1:0.2"], ["increas"]),
        ("tabular", ["table=1:0,2:0.1"], ["zero"]),
        ("tabular", ["table=0-0,1-1"], ["table"]),
        ("hard", [], ["hard"]),
        ("quadratic", [], ["quadratic", "linear"]),
    ],
)
def test_a_law_that_makes_no_sense_is_refused(kind, parameters, words):
    arguments = [word for parameter in parameters for word in ("--param", parameter)]
    done = support.call("law", kind, *arguments, "--at=0,0.1")
    if not words:
        # A stiffness limit alone selects the explicit law, where the manual has one.
        assert done.returncode == 0
        return
    assert done.returncode == 2, (done.stdout, done.stderr)
    for word in words:
        assert word.lower() in done.stderr.lower(), done.stderr
    assert not done.stdout


@pytest.mark.parametrize("at", ["", "0:1", "0:1:0", "1:0:0.1", "a,b", "0:1:nan"])
def test_a_range_that_makes_no_sense_is_refused(at):
    refused("law", "linear", "--param", "stiffness=1", f"--at={at}")


def test_an_unknown_dialect_is_refused(tmp_path):
    assert "nastran" in refused("run", DECK, "--out", tmp_path, "--dialect", "nastran")


def test_a_folder_that_cannot_be_written_is_reported(tmp_path):
    (tmp_path / "file").write_text("in the way")
    done = support.call("run", DECK, "--out", tmp_path / "file" / "results", "--quiet")
    assert done.returncode in (1, 2)
    assert "panicked" not in done.stderr and "file" in done.stderr
