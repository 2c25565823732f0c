"""Dynamic decks as FMUs: the bits of a run, steps of any size, states saved in the middle of an impact."""

import struct
import subprocess
import sys

import pytest

import support
from cosimulation import moving, raw
from cosimulation.decks import pack
from cosimulation.moving import PERIOD
from cosimulation.raw import OK, Fmu

NAMES = list(moving.decks())
# Sizes that are no multiples of any increment and end at the end of the step.
SIZES = [0.0137, 0.021, 0.0005, 0.0311, 0.0202, 0.0401, 0.0277, 0.0123, PERIOD - 0.1666]


@pytest.fixture(scope="module")
def packed(tmp_path_factory):
    """Packs each deck once: deck and FMU by name."""
    folder, made = tmp_path_factory.mktemp("moving"), {}

    def get(name):
        if name not in made:
            deck = folder / f"{name}.inp"
            deck.write_text(moving.decks()[name])
            pack(deck, "-o", folder / f"{name}.fmu")
            made[name] = deck, Fmu.unpack(folder / f"{name}.fmu", folder / f"{name}_fmu")
        return made[name]

    return get


def bits(values):
    """The 64 bits of each number."""
    return [struct.pack("<d", value) for value in values]


def walk(instance, sizes, point=0.0):
    """Outputs after each of some steps."""
    rows = []
    for size in sizes:
        assert instance.step(point, size) == OK, instance.log
        point += size
        rows.append(bits(instance.outputs()))
    return rows


def test_motions_are_outputs_with_their_names(packed):
    for name in NAMES:
        _, fmu = packed(name)
        for kind in "UVA":
            assert {f"node.TOP.{kind}{d}" for d in (1, 2, 3)} <= set(fmu.outputs), name
        assert "work.impacts" in fmu.outputs and "energy.ALLKE" in fmu.outputs


@pytest.mark.parametrize(
    ("name", "size"), [("implicit_hard", 0.002), ("implicit_fixed", 0.004), ("explicit_penalty", PERIOD / 100)]
)
def test_the_default_experiment_has_steps_that_a_master_can_take(packed, name, size):
    _, fmu = packed(name)
    experiment = fmu.description.defaultExperiment
    assert (float(experiment.stopTime), float(experiment.stepSize)) == (PERIOD, size)


@pytest.mark.parametrize("name", NAMES)
def test_one_step_over_everything_has_the_bits_of_a_run(packed, new_instance, tmp_path, name):
    deck, fmu = packed(name)
    (row,) = support.run(deck, tmp_path).last("ports")
    instance = new_instance(fmu).start()
    assert instance.step(0, PERIOD) == OK, instance.log
    expected = [float(row[output]) for output in fmu.outputs]
    assert bits(instance.outputs()) == bits(expected)
    values = dict(zip(fmu.outputs, expected, strict=True))
    assert values["energy.ALLKE"] > 0 and values["node.TOP.V3"] != 0 and values["node.TOP.A3"] != 0
    if "implicit" in name and "softened" not in name:
        assert values["work.impacts"] >= 1 and values["energy.IMPACT_LOSS"] > 0


@pytest.mark.parametrize("name", ["implicit_fixed", "explicit_softened"])
def test_a_master_on_the_grid_of_fixed_increments_has_the_bits_of_a_run(packed, new_instance, tmp_path, name):
    deck, fmu = packed(name)
    rows = {float(row["time"]): row for row in support.run(deck, tmp_path).table("ports")}
    size = 0.004 if name == "implicit_fixed" else 0.003
    instance = new_instance(fmu).start()
    point, compared = 0.0, 0
    for k in range(1, int(PERIOD / size + 0.5)):
        assert instance.step(point, k * size - point) == OK
        point = k * size
        expected = [float(rows[point][output]) for output in fmu.outputs]
        assert bits(instance.outputs()) == bits(expected), k
        compared += 1
    assert compared >= 40


@pytest.mark.parametrize("name", NAMES)
def test_a_step_of_any_size_ends_on_time(packed, new_instance, name):
    _, fmu = packed(name)
    steps = new_instance(fmu).start()
    point = 0.0
    for size in SIZES:
        assert steps.step(point, size) == OK, steps.log
        point += size
    assert point == pytest.approx(PERIOD, rel=1e-15)
    # The same motion but for the error of increments that such steps cut in two; a speed of 1 is thrown.
    whole = new_instance(fmu).start()
    assert whole.step(0, PERIOD) == OK
    for output, error in (("node.TOP.U3", 0.002), ("node.TOP.V3", 0.05)):
        assert abs(steps.real(output) - whole.real(output)) < error, output


@pytest.mark.parametrize("name", NAMES)
def test_a_rejected_step_leaves_no_trace(packed, new_instance, name):
    _, fmu = packed(name)
    straight = walk(new_instance(fmu).start(), SIZES)
    tried = new_instance(fmu).start()
    point, touched, state = 0.0, False, None
    for size, expected in zip(SIZES, straight, strict=True):
        state = tried.save(state)
        touched |= tried.real("contact.ABOVE_BELOW.closed") > 0
        for part in (0.43, 1.9):
            assert tried.step(point, part * size) == OK, tried.log
            assert tried.load(state) == OK
        assert walk(tried, [size], point) == [expected], point
        point += size
    assert touched, "a state was saved in the middle of an impact"


CHILD = """
import struct, sys
from cosimulation.raw import Fmu, Instance
instance = Instance(Fmu(sys.argv[1]))
assert instance.instantiate()
status, state = instance.deserialize(open(sys.argv[2], "rb").read())
assert status == 0, instance.log
assert instance.load(state) == 0, instance.log
point = float(sys.argv[3])
for size in map(float, sys.argv[4:]):
    assert instance.step(point, size) == 0, instance.log
    point += size
sys.stdout.write(struct.pack(f"<{len(instance.fmu.outputs)}d", *instance.outputs()).hex())
"""


@pytest.mark.parametrize("name", NAMES)
def test_an_impact_goes_on_in_another_process(packed, new_instance, tmp_path, name):
    _, fmu = packed(name)
    instance = new_instance(fmu).start()
    for begun in range(1, len(SIZES)):
        walk(instance, SIZES[begun - 1 : begun], sum(SIZES[: begun - 1]))
        if instance.real("contact.ABOVE_BELOW.closed") > 0:
            break
    assert instance.real("contact.ABOVE_BELOW.closed") > 0
    file = tmp_path / "state"
    file.write_bytes(instance.serialize(instance.save()))
    expected = walk(instance, SIZES[begun:], sum(SIZES[:begun]))[-1]
    arguments = [str(fmu.folder), str(file), repr(sum(SIZES[:begun])), *map(repr, SIZES[begun:])]
    path = str(raw.Path(raw.__file__).resolve().parent.parent)
    command = [sys.executable, "-c", CHILD, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env={"PYTHONPATH": path})
    assert done.returncode == 0, done.stderr
    assert done.stdout == b"".join(expected).hex()


@pytest.mark.parametrize("name", NAMES)
def test_a_force_that_a_master_sets_pushes(packed, new_instance, name):
    _, fmu = packed(name)
    free, pushed = new_instance(fmu).start(), new_instance(fmu).start()
    assert "cload.TOP.3" in fmu.names("input")
    for instance, force in ((free, 0.0), (pushed, 5.0)):
        for k in range(4):
            assert instance.set_values({"cload.TOP.3": force}) == OK
            assert instance.step(0.001 * k, 0.001) == OK, instance.log
        assert instance.real("cload.TOP.3") == force
    # 4 nodes of force 5 over 0.003 after a rise over 0.001, on a mass of 1 whose top moves first: upwards and more than as one.
    gained = pushed.real("node.TOP.V3") - free.real("node.TOP.V3")
    assert 0.05 < gained < 0.5, gained
    assert bits(pushed.outputs()) != bits(free.outputs())


def test_reset_is_the_start_again(packed, new_instance):
    for name in NAMES:
        _, fmu = packed(name)
        instance = new_instance(fmu).start()
        first = walk(instance, SIZES)
        assert instance.call("Reset") == OK
        assert walk(instance.start(), SIZES) == first, name


@pytest.mark.parametrize("procedure", [moving.IMPLICIT, moving.EXPLICIT], ids=["implicit", "explicit"])
def test_a_velocity_that_a_master_sets_is_integrated(new_instance, tmp_path, procedure):
    deck = tmp_path / "driven.inp"
    driven = "*BOUNDARY, TYPE=VELOCITY\nTOP, 3, 3, -1.\n*NODE PRINT, NSET=TOP"
    text = moving.thrown(procedure).replace("*NODE PRINT, NSET=TOP", driven, 1)
    deck.write_text(text.replace("TOP, 3, -0.5\n", ""))
    pack(deck, "-o", tmp_path / "driven.fmu")
    fmu = Fmu.unpack(tmp_path / "driven.fmu", tmp_path / "fmu")
    instance = new_instance(fmu).start()
    port = "velocity.TOP.3"
    assert port in fmu.names("input")
    assert instance.real(port) == -1.0
    assert instance.step(0, 0.0041) == OK, instance.log
    assert instance.real("node.TOP.U3") == pytest.approx(-0.0041, rel=1e-9), "the velocity of the deck"
    # From -1 to 3 linearly over 0.01, then held.
    assert instance.set_values({port: 3.0}) == OK
    assert instance.step(0.0041, 0.01) == OK, instance.log
    turned = -0.0041 + 0.5 * (-1.0 + 3.0) * 0.01
    assert instance.real("node.TOP.U3") == pytest.approx(turned, rel=1e-9)
    assert instance.real(port) == 3.0
    state = instance.save()
    for _ in range(2):
        assert instance.step(0.0141, 0.0033) == OK, instance.log
        assert instance.real("node.TOP.U3") == pytest.approx(turned + 3 * 0.0033, rel=1e-9)
        assert instance.load(state) == OK
