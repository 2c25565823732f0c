"""`overclosure pack`: what it refuses, and that it leaves nothing behind when it does."""

import os
import shutil
import subprocess

import fmpy
import pytest

import support
from cosimulation import decks


@pytest.fixture
def deck(tmp_path):
    """A deck in a folder of its own."""
    path = tmp_path / "two.inp"
    path.write_text(decks.two_bricks())
    return path


def left(folder):
    """Names in a folder."""
    return sorted(path.name for path in folder.iterdir())


def refused(code, *arguments, **options):
    """Standard error of a call that must end with a code."""
    done = support.call("pack", *arguments, **options)
    assert done.returncode == code, (done.returncode, done.stdout, done.stderr)
    assert "panicked" not in done.stderr
    return done.stderr


def test_attached_is_refused_with_a_reason(deck, tmp_path):
    assert "attached" in refused(2, deck, "-o", tmp_path / "x.fmu", "--backend", "attached")
    assert left(tmp_path) == ["two.inp"]


def test_embedded_is_what_there_is(deck, tmp_path):
    assert support.call("pack", deck, "-o", tmp_path / "x.fmu", "--backend", "embedded").returncode == 0


@pytest.mark.parametrize("arguments", [[], ["-o", "x.fmu"], ["--law"], ["--law", "deck.inp", "-o", "x.fmu"]])
def test_incomplete_calls_are_refused(arguments):
    refused(2, *arguments)


def test_a_missing_deck_is_named(tmp_path):
    assert "gone.inp" in refused(2, tmp_path / "gone.inp", "-o", tmp_path / "x.fmu")


def test_a_wrong_deck_gives_all_findings_and_no_file(deck, tmp_path):
    deck.write_text(
        decks.two_bricks()
        .replace("MATERIAL=STEEL\n*SURFACE", "MATERIAL=WOOD\n*SURFACE")
        .replace("BOTTOM, 1, 3", "BOTTUM, 1, 3")
    )
    message = refused(2, deck, "-o", tmp_path / "x.fmu")
    assert "WOOD" in message and "BOTTUM" in message
    assert left(tmp_path) == ["two.inp"]


def test_an_existing_fmu_survives_a_refusal_and_is_replaced_by_success(deck, tmp_path):
    target = tmp_path / "x.fmu"
    assert support.call("pack", deck, "-o", target).returncode == 0
    first = target.read_bytes()
    good = deck.read_text()
    deck.write_text("nonsense")
    refused(2, deck, "-o", target)
    assert target.read_bytes() == first
    deck.write_text(good.replace("-0.01", "-0.02"))
    assert support.call("pack", deck, "-o", target).returncode == 0
    assert target.read_bytes() != first


def test_a_folder_that_is_not_there_is_our_failure(deck, tmp_path):
    assert "x.fmu" in refused(1, deck, "-o", tmp_path / "nowhere" / "x.fmu")


def test_the_library_is_found_in_three_places_and_named_when_it_is_not(deck, tmp_path):
    lonely = tmp_path / "bin" / "overclosure"
    lonely.parent.mkdir()
    shutil.copy(support.binary(), lonely)
    library = support.binary().parent / "liboverclosure_fmu.so"
    target = tmp_path / "x.fmu"

    def pack(**environment):
        env = {name: value for name, value in os.environ.items() if name != "OVERCLOSURE_FMU_LIB"} | environment
        return subprocess.run(
            [lonely, "pack", deck, "-o", target], capture_output=True, text=True, env=env, check=False
        )

    missing = pack()
    assert missing.returncode == 1
    for place in (str(lonely.parent), "lib/overclosure", "OVERCLOSURE_FMU_LIB"):
        assert place in missing.stderr
    assert pack(OVERCLOSURE_FMU_LIB=str(library)).returncode == 0
    installed = tmp_path / "lib" / "overclosure"
    installed.mkdir(parents=True)
    shutil.copy(library, installed)
    assert pack().returncode == 0


def test_a_library_that_fails_its_trial_leaves_no_file(deck, tmp_path):
    lonely = tmp_path / "overclosure"
    shutil.copy(support.binary(), lonely)
    (tmp_path / "liboverclosure_fmu.so").write_bytes(b"not a library")
    done = subprocess.run([lonely, "pack", deck, "-o", tmp_path / "x.fmu"], capture_output=True, text=True, check=False)
    assert done.returncode == 1 and "trial" in done.stderr
    assert left(tmp_path) == ["liboverclosure_fmu.so", "overclosure", "two.inp"]


def test_the_dialect_changes_the_answer(deck, tmp_path):
    forces = {}
    for dialect in ("abaqus", "calculix"):
        target = tmp_path / f"{dialect}.fmu"
        assert support.call("pack", deck, "-o", target, "--dialect", dialect).returncode == 0
        forces[dialect] = fmpy.simulate_fmu(str(target))["node.TOP.RF3"][-1]
        result = support.run(deck, tmp_path / dialect, "--dialect", dialect)
        assert float(result.table("ports")[-1]["node.TOP.RF3"]) == forces[dialect]
    assert all(force < 0 for force in forces.values())


def test_a_ports_file_renames_selects_and_gives_units(deck, tmp_path):
    ports = tmp_path / "selection.toml"
    ports.write_text(
        'select = "listed"\n'
        '[[port]]\nport = "boundary.TOP.3"\nname = "depth"\nunit = "mm"\n'
        '[[port]]\nport = "node.TOP.RF3"\nname = "force"\nunit = "N"\ndescription = "Force & more"\n'
        '[[port]]\nport = "energy.ALLSE"\nunit = "furlong"\n'
    )
    done = support.call("pack", deck, "-o", tmp_path / "x.fmu", "--ports", ports)
    assert done.returncode == 0 and "furlong" in done.stderr, done.stderr
    description = fmpy.read_model_description(str(tmp_path / "x.fmu"), validate=True)
    assert [(v.name, v.unit) for v in description.modelVariables] == [
        ("depth", "mm"),
        ("force", "N"),
        ("energy.ALLSE", "furlong"),
    ]
    assert description.modelVariables[1].description == "Force & more"
    units = {unit.name: unit.baseUnit for unit in description.unitDefinitions}
    assert (units["mm"].m, units["mm"].factor) == (1, 1e-3)
    assert units["furlong"] is None
    assert fmpy.simulate_fmu(str(tmp_path / "x.fmu"))["force"][-1] < 0
    (tmp_path / "ports.toml").write_text(ports.read_text())
    assert support.call("pack", deck, "-o", tmp_path / "y.fmu").returncode == 0
    assert (tmp_path / "y.fmu").read_bytes() == (tmp_path / "x.fmu").read_bytes(), "found beside the deck"
    ports.write_text('[[port]]\nport = "boundary.TIP.3"\n')
    assert "boundary.TIP.3" in refused(2, deck, "-o", tmp_path / "z.fmu", "--ports", ports)
    assert "gone.toml" in refused(2, deck, "-o", tmp_path / "z.fmu", "--ports", tmp_path / "gone.toml")
