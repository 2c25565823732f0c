"""The archive and its description, as public checkers and an importer see them."""

import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import fmpy
import numpy
import pytest
from fmpy.validation import validate_fmu

import support
from cosimulation import decks
from cosimulation.raw import FUNCTIONS, Fmu, Instance

FMUTOOL = [sys.executable, "-m", "fmu_manipulation_toolbox"]


@pytest.fixture(params=["law_file", "deck_file"])
def fmu_file(request):
    """Both kinds of FMU."""
    return request.getfixturevalue(request.param)


def fmutool_complaints(path):
    """Errors of `fmutool -check`."""
    tool = shutil.which("fmutool", path=str(Path(sys.executable).parent)) or shutil.which("fmutool")
    done = subprocess.run([tool, "-input", path, "-check"], capture_output=True, text=True, check=False, timeout=120)
    text = done.stdout + done.stderr
    assert "Conformity Checks" in text, text
    return [line for line in text.splitlines() if line.startswith(("ERROR", "CRITICAL")) or "does not validate" in line]


def test_the_checkers_have_nothing_to_say(fmu_file):
    assert validate_fmu(str(fmu_file)) == []
    assert fmutool_complaints(fmu_file) == []


def test_the_command_line_of_fmpy_is_silent_and_runs_it(fmu_file, tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "fmpy", "validate", fmu_file], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0 and "No problems" in done.stdout, done.stdout + done.stderr
    out = tmp_path / "out.csv"
    done = subprocess.run(
        [sys.executable, "-m", "fmpy", "simulate", fmu_file, "--output-file", out],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert len(out.read_text().splitlines()) > 5


def test_everything_that_belongs_into_an_fmu_is_there(fmu_file):
    with zipfile.ZipFile(fmu_file) as archive:
        entries = {entry.filename: entry for entry in archive.infolist()}
    identifier = fmpy.read_model_description(str(fmu_file)).coSimulation.modelIdentifier
    library = f"binaries/linux64/{identifier}.so"
    wanted = {"modelDescription.xml", "model.png", "documentation/index.html", "resources/options.json", library}
    wanted |= {
        f"documentation/licenses/{name}"
        for name in ("license.txt", "LICENSE-MIT.txt", "LICENSE-APACHE.txt", "third-party.txt")
    }
    assert wanted <= set(entries)
    assert (entries[library].external_attr >> 16) & 0o777 == 0o755
    assert list(entries) == sorted(entries)
    assert {entry.date_time for entry in entries.values()} == {(1980, 1, 1, 0, 0, 0)}
    assert not any("\\" in name or name.startswith("/") or ".." in name for name in entries)


def test_packing_twice_gives_the_same_bytes(deck_path, deck_file, tmp_path):
    again = tmp_path / "another name.fmu"
    assert support.call("pack", deck_path, "-o", again).returncode == 0
    assert again.read_bytes() == deck_file.read_bytes()


def test_another_deck_has_another_guid(tmp_path, deck_fmu):
    deck = tmp_path / "punch.inp"
    deck.write_text(decks.two_bricks())
    assert support.call("pack", deck, "-o", tmp_path / "x.fmu").returncode == 0
    assert fmpy.read_model_description(str(tmp_path / "x.fmu")).guid != deck_fmu.description.guid


def test_the_library_exports_the_34_functions_and_nothing_else(deck_fmu):
    done = subprocess.run(
        ["nm", "-D", "--defined-only", deck_fmu.library_path], capture_output=True, text=True, check=True
    )
    symbols = {line.split()[-1] for line in done.stdout.splitlines()}
    assert symbols == {f"fmi2{name}" for name in FUNCTIONS}
    assert len(symbols) == 34
    assert deck_fmu.library.fmi2GetVersion() == b"2.0"
    assert deck_fmu.library.fmi2GetTypesPlatform() == b"default"


def test_the_library_is_stripped_and_needs_only_the_c_library(deck_fmu):
    done = subprocess.run(["readelf", "-S", "-d", deck_fmu.library_path], capture_output=True, text=True, check=True)
    assert ".symtab" not in done.stdout
    needed = set(re.findall(r"NEEDED.*\[(.*)\]", done.stdout))
    assert needed <= {
        "libc.so.6",
        "libm.so.6",
        "libgcc_s.so.1",
        "libdl.so.2",
        "libpthread.so.0",
        "ld-linux-x86-64.so.2",
    }, needed


def test_value_references_are_positions_and_indices_count_from_one(fmu_file):
    description = fmpy.read_model_description(str(fmu_file))
    assert [v.valueReference for v in description.modelVariables] == list(range(len(description.modelVariables)))
    outputs = [v.name for v in description.modelVariables if v.causality == "output"]
    assert [u.variable.name for u in description.outputs] == outputs
    assert [u.variable.name for u in description.initialUnknowns] == outputs


def test_start_and_bounds_and_experiment_make_sense(fmu_file):
    description = fmpy.read_model_description(str(fmu_file))
    for v in description.modelVariables:
        if v.start is not None and v.min is not None:
            assert float(v.min) <= float(v.start), v.name
        if v.start is not None and v.max is not None:
            assert float(v.start) <= float(v.max), v.name
        if v.type == "Enumeration":
            assert int(v.start) in {int(item.value) for item in v.declaredType.items}
    experiment = description.defaultExperiment
    assert float(experiment.stopTime) > float(experiment.startTime) and float(experiment.stepSize) > 0


def test_the_experiment_of_a_deck_is_that_of_its_last_step(deck_fmu):
    experiment = deck_fmu.description.defaultExperiment
    assert (float(experiment.startTime), float(experiment.stopTime), float(experiment.stepSize)) == (0.0, 1.0, 0.1)


def test_a_deck_lists_no_feed_through_and_a_law_exactly_what_a_perturbation_shows(law_fmu, law, deck_fmu):
    assert all(list(u.dependencies) == [] for u in deck_fmu.description.outputs)
    # On the ramp of the damping coefficient, where the exponential law presses too: every output has a slope.
    assert law.set_values({"damping.coefficient": 1e6, "damping.clearance": 1e-4}) == 0
    law.set(overclosure=-5e-5, closing_velocity=0.1)
    law.set(law__kind=3)
    moved = {}
    base = dict(zip(law_fmu.outputs, law.outputs(), strict=True))
    for name, value in (("overclosure", -4e-5), ("closing_velocity", 0.2)):
        state = law.save()
        law.set(**{name: value})
        now = dict(zip(law_fmu.outputs, law.outputs(), strict=True))
        moved[name] = {output for output in base if base[output] != now[output]}
        law.load(state)
    for unknown in law_fmu.description.outputs:
        if unknown.variable.type == "Real":
            listed = {v.name for v in unknown.dependencies}
            assert listed == {name for name, outputs in moved.items() if unknown.variable.name in outputs}


def test_units_are_defined_in_si(law_fmu):
    units = {unit.name: unit.baseUnit for unit in law_fmu.description.unitDefinitions}
    pascal = units["Pa"]
    assert (pascal.kg, pascal.m, pascal.s, pascal.factor) == (1, -1, -2, 1)
    assert law_fmu.variables["overclosure"].unit == "m"


def test_declared_units_of_a_deck_are_defined_and_others_absent(tmp_path):
    deck = tmp_path / "d.inp"
    deck.write_text(decks.two_bricks())
    assert support.call("pack", deck, "-o", tmp_path / "plain.fmu").returncode == 0
    plain = fmpy.read_model_description(str(tmp_path / "plain.fmu"))
    assert plain.unitDefinitions == [] and all(v.unit is None for v in plain.modelVariables)


def test_included_files_are_inside(tmp_path, new_instance):
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "steel.inc").write_text(decks.MATERIAL + "\n")
    deck = tmp_path / "d.inp"
    deck.write_text(decks.two_bricks(material="*INCLUDE, INPUT=sub/steel.inc"))
    assert support.call("pack", deck, "-o", tmp_path / "d.fmu").returncode == 0
    shutil.rmtree(tmp_path / "sub")
    deck.unlink()
    fmu = Fmu.unpack(tmp_path / "d.fmu", tmp_path / "fmu")
    instance = new_instance(fmu).start()
    assert instance.step(0, 1) == 0
    assert instance.real("node.TOP.RF3") < 0


def test_the_unpacked_tree_may_move(deck_fmu, tmp_path):
    first = Instance(deck_fmu)
    assert first.instantiate()
    first.start()
    assert first.step(0, 0.5) == 0
    expected = first.outputs()
    first.free()
    tree = tmp_path / "a folder with blanks & percent 100%"
    moved = deck_fmu.copied_to(tree)
    for location in (moved.resources.encode(), None, b"", str(tree / "resources").encode()):
        second = Instance(moved)
        assert second.instantiate(location=location), (location, second.log)
        second.start()
        assert second.step(0, 0.5) == 0
        assert second.outputs() == expected
        second.free()


def test_fmpy_gives_the_bits_of_the_command_line(deck_path, deck_file, tmp_path):
    result = fmpy.simulate_fmu(str(deck_file))
    rows = support.run(deck_path, tmp_path).table("ports")
    assert len(result) == len(rows) + 1
    names = [name for name in result.dtype.names if name != "time"]
    ours = numpy.array([[float(row[name]) for name in names] for row in rows])
    theirs = numpy.array([[line[name] for name in names] for line in result[1:]])
    assert abs(ours).max() > 1
    assert (ours == theirs).all(), numpy.argwhere(ours != theirs)
