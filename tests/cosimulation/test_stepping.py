"""Steps of any size, start times, preloads, inputs."""

import ctypes
import math

import fmpy
import pytest

from cosimulation import decks
from cosimulation.conftest import INCREMENTS
from cosimulation.decks import pack
from cosimulation.raw import ERROR, OK, Fmu


def close(a, b, relative=1e-9):
    """All values agree relative to the largest."""
    scale = max(map(abs, a + b))
    return all(abs(x - y) <= relative * scale for x, y in zip(a, b, strict=True))


def physical(fmu):
    """Outputs that do not count work."""
    return [name for name in fmu.outputs if not name.startswith(("work.", "contact.last_status_change"))]


def walk(instance, sizes):
    """Steps one after the other; the end."""
    point = 0.0
    for size in sizes:
        assert instance.step(point, size) == OK, instance.log
        point += size
    return point


def test_steps_of_any_size_lead_to_the_same_place(deck_fmu, new_instance):
    # Frictionless contact has no memory but the work integral, which is a trapezoidal sum over the increments.
    names = [name for name in physical(deck_fmu) if "energy" not in name]
    ends = []
    for sizes in ([1.0], [0.1] * 10, [0.01] * 100, [0.37, 0.002, 0.128, 0.3, 0.2]):
        instance = new_instance(deck_fmu).start()
        walk(instance, sizes)
        ends.append(instance.reals(names))
    assert all(close(ends[0], end) for end in ends)
    assert max(map(abs, ends[0])) > 1


def test_a_step_of_many_increments_has_the_bits_of_single_ones(deck_fmu, new_instance):
    one, many = new_instance(deck_fmu).start(), new_instance(deck_fmu).start()
    assert one.step(0, 1.0) == OK
    for k in range(INCREMENTS):
        point, end = k / INCREMENTS, (k + 1) / INCREMENTS
        assert many.step(point, end - point) == OK
    assert one.outputs() == many.outputs()


def test_a_zero_step_changes_nothing_without_new_inputs(deck, deck_fmu):
    deck.step(0, 0.3)
    before = deck.outputs()
    assert deck.step(0.3, 0) == OK
    assert deck.outputs() == before


def test_a_zero_step_applies_new_inputs(deck, deck_fmu):
    (port,) = deck_fmu.names("input")
    deck.step(0, 0.3)
    deck.set_values({port: -0.004})
    stale = deck.outputs()
    assert deck.step(0.3, 0) == OK
    assert deck.real("node.NTOP.U3") == pytest.approx(-0.004, rel=1e-12)
    assert deck.outputs() != stale


def test_an_input_is_reached_linearly_and_then_held(deck, deck_fmu):
    (port,) = deck_fmu.names("input")
    deck.set_values({port: -0.004})
    assert deck.real(port) == -0.004
    walk(deck, [0.05] * 2)
    assert deck.real("node.NTOP.U3") == pytest.approx(-0.004, rel=1e-12)
    walk_from = deck.outputs()
    assert deck.step(0.1, 0.2) == OK
    assert close(
        deck.reals(["node.NTOP.U3", "node.NTOP.RF3"]), [-0.004, walk_from[deck_fmu.outputs.index("node.NTOP.RF3")]]
    )


def test_an_input_set_during_initialisation_acts_from_the_start(deck_fmu, new_instance):
    instance = new_instance(deck_fmu)
    (port,) = deck_fmu.names("input")
    instance.setup()
    instance.call("EnterInitializationMode")
    assert instance.real("node.NTOP.U3") == 0
    instance.set_values({port: -0.003})
    assert instance.real("node.NTOP.U3") == pytest.approx(-0.003, rel=1e-12), "outputs follow in initialisation mode"
    instance.call("ExitInitializationMode")
    loaded = instance.outputs()
    assert instance.step(0, 0.5) == OK
    assert close(instance.reals(physical(deck_fmu)), [loaded[deck_fmu.outputs.index(n)] for n in physical(deck_fmu)])


def test_an_input_set_before_initialisation_acts_from_the_start(deck_fmu, new_instance):
    instance = new_instance(deck_fmu)
    (port,) = deck_fmu.names("input")
    instance.set_values({port: -0.003})
    instance.start()
    assert instance.real(port) == -0.003
    assert instance.real("node.NTOP.U3") == pytest.approx(-0.003, rel=1e-12)


def test_a_port_that_is_never_set_follows_the_deck(deck, deck_fmu):
    (port,) = deck_fmu.names("input")
    deck.step(0, 0.5)
    assert deck.real(port) == pytest.approx(-0.0025, rel=1e-12)
    assert deck.real("node.NTOP.U3") == pytest.approx(-0.0025, rel=1e-12)


def test_after_the_end_of_the_deck_inputs_hold(deck):
    deck.step(0, 1.0)
    end = deck.reals(["node.NTOP.U3", "node.NTOP.RF3"])
    assert deck.step(1.0, 5.0) == OK
    assert close(deck.reals(["node.NTOP.U3", "node.NTOP.RF3"]), end)


def test_the_experiment_may_start_at_any_time(deck_fmu, deck_file, new_instance):
    plain, later = new_instance(deck_fmu).start(), new_instance(deck_fmu).start(start=100.0)
    for k in range(4):
        assert plain.step(0.25 * k, 0.25) == OK
        assert later.step(100 + 0.25 * k, 0.25) == OK
    assert plain.outputs() == later.outputs()
    shifted = fmpy.simulate_fmu(str(deck_file), start_time=7.0, stop_time=8.0)
    straight = fmpy.simulate_fmu(str(deck_file))
    assert shifted["time"][-1] == 8.0
    assert shifted["node.NTOP.RF3"][-1] == pytest.approx(straight["node.NTOP.RF3"][-1], rel=1e-12)


def test_earlier_steps_run_at_initialisation(tmp_path, new_instance):
    deck = tmp_path / "preload.inp"
    deck.write_text(decks.two_bricks(displacements=(-0.01, -0.03), period=2.0))
    pack(deck, "-o", tmp_path / "preload.fmu")
    fmu = Fmu.unpack(tmp_path / "preload.fmu", tmp_path / "fmu")
    experiment = fmu.description.defaultExperiment
    assert (float(experiment.startTime), float(experiment.stopTime)) == (0.0, 2.0)
    (port,) = fmu.names("input")
    assert float(fmu.variables[port].start) == pytest.approx(-0.01, rel=1e-12)
    instance = new_instance(fmu).start()
    assert instance.real("node.TOP.U3") == pytest.approx(-0.01, rel=1e-12)
    preload = instance.real("node.TOP.RF3")
    assert preload < 0
    assert instance.step(0, 1.0) == OK
    assert instance.real("node.TOP.U3") == pytest.approx(-0.02, rel=1e-12)
    assert instance.step(1.0, 1.0) == OK
    assert instance.real("node.TOP.RF3") == pytest.approx(3 * preload, rel=1e-9)
    assert instance.call("Reset") == OK
    instance.start()
    assert instance.real("node.TOP.RF3") == preload


@pytest.mark.parametrize("accumulate", [True, False])
def test_a_million_steps_of_a_rounding_clock_are_accepted(law, accumulate):
    size, point = 1e-3, 0.0
    for k in range(1_000_000 if accumulate else 300_000):
        if law.step(point, size) != OK:
            raise AssertionError((k, law.log[-1]))
        law.log.clear()
        point = point + size if accumulate else (k + 1) * size
    assert not math.isclose(point, 0)


def test_inputs_beyond_the_range_of_numbers_are_an_error_and_a_saved_state_helps(deck_fmu, new_instance):
    instance = new_instance(deck_fmu).start()
    (port,) = deck_fmu.names("input")
    assert instance.step(0, 0.5) == OK
    state, before = instance.save(), instance.outputs()
    instance.set_values({port: 1e300})
    assert instance.step(0.5, 0.5) == ERROR
    assert "range of numbers" in instance.errors()[-1]
    assert instance.load(state) == OK
    assert instance.outputs() == before
    assert instance.step(0.5, 0.25) == OK


@pytest.fixture
def sliding(tmp_path, new_instance):
    """A brick that is dragged over the other one until small sliding no longer holds."""
    deck = tmp_path / "slide.inp"
    drag = "TOP, 3, 3, -0.01\nTOP, 1, 1, 0.9"
    deck.write_text(decks.two_bricks().replace("TOP, 3, 3, -0.01", drag))
    pack(deck, "-o", tmp_path / "slide.fmu")
    fmu = Fmu.unpack(tmp_path / "slide.fmu", tmp_path / "fmu")
    return new_instance(fmu).start()


def test_a_solver_that_stops_keeps_the_last_good_time_and_can_be_brought_back(sliding):
    assert sliding.step(0, 0.3) == OK
    state, before = sliding.save(), sliding.outputs()
    assert sliding.step(0.3, 0.6) == ERROR
    assert "slid" in sliding.errors()[-1], sliding.log
    reached, status = ctypes.c_double(), ctypes.c_int()
    assert sliding.call("GetRealStatus", 2, ctypes.byref(reached)) == OK
    assert 0.3 <= reached.value < 0.9
    assert sliding.call("GetStatus", 0, ctypes.byref(status)) == OK and status.value == ERROR
    assert sliding.real("node.TOP.U1") == pytest.approx(0.9 * reached.value, rel=1e-9)
    assert sliding.step(reached.value, 0.1) == ERROR, "not from here"
    assert sliding.load(state) == OK
    assert sliding.outputs() == before
    assert sliding.set_values({"boundary.TOP.1": 0.1}) == OK
    assert sliding.step(0.3, 0.6) == OK, sliding.log
    assert sliding.call("Reset") == OK
    sliding.start()
    assert sliding.step(0, 0.3) == OK
    assert sliding.outputs() == before
