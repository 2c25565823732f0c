"""Saved states: bit-equal continuations, here and in another process; damaged bytes are refused."""

import ctypes as c
import random
import struct
import subprocess
import sys

import pytest

from cosimulation import raw
from cosimulation.raw import ERROR, OK


def drive(instance, fmu, point, size, value=None):
    """One step with an input that moves, if one is given; all outputs."""
    if value is not None:
        assert instance.set_values({fmu.names("input")[0]: value}) == OK
    assert instance.step(point, size) == OK, instance.log
    return instance.outputs()


@pytest.fixture(params=["law_fmu", "deck_fmu", "hard_fmu", "exponential_fmu"])
def fmu(request):
    """Both kinds of FMU, and decks whose solution takes different ways."""
    return request.getfixturevalue(request.param)


def values_of(fmu):
    """Input values that close and open the contact."""
    scale = 1e-3 if "pressure" in fmu.references else -0.005
    return [scale * factor for factor in (0.2, 0.9, 0.4, 1.0, -0.1, 0.7)]


def test_get_step_set_step_is_bit_equal(fmu, new_instance):
    instance = new_instance(fmu).start()
    values = values_of(fmu)
    saved, expected = [], []
    for k, value in enumerate(values):
        saved.append(instance.save())
        expected.append(drive(instance, fmu, 0.1 * k, 0.1, value))
    assert len({tuple(row) for row in expected}) == len(values), "the steps differ from each other"
    for k in (5, 0, 3, 1, 4, 2, 2):
        assert instance.load(saved[k]) == OK
        for j in range(k, len(values)):
            assert drive(instance, fmu, 0.1 * j, 0.1, values[j]) == expected[j], (k, j)


def test_outputs_and_pending_inputs_come_back_before_any_step(fmu, new_instance):
    instance = new_instance(fmu).start()
    drive(instance, fmu, 0, 0.1, values_of(fmu)[1])
    name = fmu.names("input")[0]
    instance.set_values({name: values_of(fmu)[2]})
    state, outputs, pending = instance.save(), instance.outputs(), instance.real(name)
    after = drive(instance, fmu, 0.1, 0.1)
    drive(instance, fmu, 0.2, 0.1, values_of(fmu)[3])
    assert instance.load(state) == OK
    assert (instance.outputs(), instance.real(name)) == (outputs, pending)
    assert drive(instance, fmu, 0.1, 0.1) == after


def test_a_state_of_every_phase_brings_that_phase_back(fmu, new_instance):
    instance = new_instance(fmu)
    start = instance.save()
    instance.setup()
    instance.call("EnterInitializationMode")
    initial = instance.save()
    instance.call("ExitInitializationMode")
    expected = drive(instance, fmu, 0, 0.1, values_of(fmu)[1])
    instance.call("Terminate")
    assert instance.load(initial) == OK
    assert instance.step(0, 0.1) == ERROR
    assert instance.call("ExitInitializationMode") == OK
    assert drive(instance, fmu, 0, 0.1, values_of(fmu)[1]) == expected
    assert instance.load(start) == OK
    instance.start()
    assert drive(instance, fmu, 0, 0.1, values_of(fmu)[1]) == expected


def test_reset_is_a_fresh_start_bit_for_bit_and_keeps_saved_states(fmu, new_instance):
    instance = new_instance(fmu).start()
    values = values_of(fmu)
    first = [drive(instance, fmu, 0.1 * k, 0.1, value) for k, value in enumerate(values)]
    state = instance.save()
    assert instance.call("Reset") == OK
    instance.start()
    assert [drive(instance, fmu, 0.1 * k, 0.1, value) for k, value in enumerate(values)] == first
    assert instance.call("Reset") == OK
    assert instance.load(state) == OK
    assert instance.outputs() == first[-1]


def test_a_handle_is_reused_freed_and_then_refused(fmu, new_instance):
    instance = new_instance(fmu).start()
    state = instance.save()
    before = state.value
    drive(instance, fmu, 0, 0.1, values_of(fmu)[1])
    outputs = instance.outputs()
    assert instance.save(state).value == before, "the same handle"
    drive(instance, fmu, 0.1, 0.1, values_of(fmu)[2])
    assert instance.load(state) == OK and instance.outputs() == outputs, "with the later state"
    stale = c.c_void_p(state.value)
    assert instance.call("FreeFMUstate", c.byref(state)) == OK and not state.value
    assert instance.call("FreeFMUstate", c.byref(state)) == OK, "null is fine"
    for call in (lambda: instance.load(stale), lambda: instance.call("FreeFMUstate", c.byref(stale))):
        assert call() == ERROR
        assert "state" in instance.errors()[-1]
    assert instance.call("GetFMUstate", c.byref(c.c_void_p(0xDEADBEEF))) == ERROR
    other = new_instance(fmu).start()
    assert other.load(instance.save()) == ERROR, "states belong to their instance"


CHILD = """
import struct, sys
from cosimulation.raw import Fmu, Instance
instance = Instance(Fmu(sys.argv[1]))
assert instance.instantiate()
status, state = instance.deserialize(open(sys.argv[2], "rb").read())
assert status == 0, instance.log
assert instance.load(state) == 0, instance.log
name = instance.fmu.names("input")[0]
for k in range(3, 6):
    assert instance.set_values({name: float(sys.argv[k])}) == 0
    assert instance.step(0.1 * (k - 1), 0.1) == 0, instance.log
sys.stdout.write(struct.pack(f"<{len(instance.fmu.outputs)}d", *instance.outputs()).hex())
"""


def test_a_serialised_state_goes_on_in_another_process(fmu, new_instance, tmp_path):
    instance = new_instance(fmu).start()
    values = values_of(fmu)
    for k in (0, 1):
        drive(instance, fmu, 0.1 * k, 0.1, values[k])
    file = tmp_path / "state"
    file.write_bytes(instance.serialize(instance.save()))
    for k in (2, 3, 4):
        expected = drive(instance, fmu, 0.1 * k, 0.1, values[k])
    arguments = [str(fmu.folder), str(file), *map(repr, values[2:5])]
    path = str(raw.Path(raw.__file__).resolve().parent.parent)
    done = subprocess.run(
        [sys.executable, "-c", CHILD, *arguments], capture_output=True, text=True, check=False, env={"PYTHONPATH": path}
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == struct.pack(f"<{len(expected)}d", *expected).hex()


def test_serialising_is_deterministic_and_checks_the_room(fmu, new_instance):
    instance = new_instance(fmu).start()
    drive(instance, fmu, 0, 0.1, values_of(fmu)[1])
    state = instance.save()
    data = instance.serialize(state)
    status, again = instance.deserialize(data)
    assert status == OK and instance.serialize(again) == data
    short = (c.c_ubyte * (len(data) - 1))()
    assert instance.call("SerializeFMUstate", state, short, c.c_size_t(len(short))) == ERROR
    assert str(len(data)) in instance.errors()[-1]
    assert bytes(short) == bytes(len(short)), "nothing was written"


def test_damaged_truncated_and_foreign_bytes_are_refused(fmu, law_fmu, deck_fmu, new_instance):
    instance = new_instance(fmu).start()
    drive(instance, fmu, 0, 0.1, values_of(fmu)[1])
    data = instance.serialize(instance.save())
    outputs = instance.outputs()
    foreign = new_instance(deck_fmu if fmu is law_fmu else law_fmu).start()
    dice = random.Random(20)
    cases = [b"", b"\0", data[:-1], data + b"\0", bytes(len(data)), foreign.serialize(foreign.save())]
    cases += [data[: dice.randrange(len(data))] for _ in range(100)]
    cases += [dice.randbytes(dice.randrange(1, 300)) for _ in range(100)]
    for _ in range(500):
        changed = bytearray(data)
        for _ in range(dice.choice((1, 1, 2, 8))):
            changed[dice.randrange(len(data))] ^= 1 << dice.randrange(8)
        if changed != data:
            cases.append(bytes(changed))
    for case in cases:
        status, state = instance.deserialize(case)
        assert status == ERROR and not state.value, case[:40]
        assert "state" in instance.errors()[-1]
    assert instance.outputs() == outputs
    assert instance.step(0.1, 0.1) == OK


def test_bytes_with_a_right_checksum_and_wrong_content_are_refused(fmu, new_instance):
    import zlib

    instance = new_instance(fmu).start()
    drive(instance, fmu, 0, 0.1, values_of(fmu)[1])
    outputs = instance.outputs()
    data = instance.serialize(instance.save())
    dice = random.Random(7)
    refused = 0
    for _ in range(400):
        body = bytearray(data[:-4])
        body[dice.randrange(8, len(body))] ^= 1 << dice.randrange(8)
        status, state = instance.deserialize(bytes(body) + struct.pack("<I", zlib.crc32(body)))
        if status == OK and instance.load(state) == OK:
            # A changed number is a state like another; it must be usable, whatever it is.
            instance.call("Reset")
            instance.start()
            drive(instance, fmu, 0, 0.1, values_of(fmu)[1])
        else:
            refused += 1
    assert refused > 0
    assert instance.outputs() == outputs
