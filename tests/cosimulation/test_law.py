"""ContactLaw.fmu: every law of the command line, parameters, refusals."""

import csv
import io

import fmpy
import numpy
import pytest

import support
from cosimulation.raw import ERROR, OK

TABLE = [(0.0, -0.02), (3.0, 0.0), (12.0, 0.03), (40.0, 0.05)]
TEXT = ",".join(f"{p}:{h}" for p, h in TABLE)
LAWS = {
    "linear": (1, {"law.stiffness": 250.0}, ["stiffness=250"]),
    "tabular": (2, {"table.text": TEXT}, [f"table={TEXT}"]),
    "exponential": (
        3,
        {"law.clearance_at_zero_pressure": 0.01, "law.pressure_at_zero_clearance": 5.0},
        ["c0=0.01", "p0=5"],
    ),
    "exponential with a limit": (
        3,
        {"law.clearance_at_zero_pressure": 0.01, "law.pressure_at_zero_clearance": 5.0, "law.stiffness_max": 2e4},
        ["c0=0.01", "p0=5", "kmax=2e4"],
    ),
    "calculix-exponential": (
        4,
        {"law.clearance_at_zero_pressure": 0.01, "law.pressure_at_zero_clearance": 5.0},
        ["c0=0.01", "p0=5"],
    ),
}
AT = [-0.03, -0.01, -0.005, 0.0, 0.004, 0.015, 0.03, 0.06, 0.2]


def by_command_line(kind, parameters):
    """(pressure, stiffness, energy) per overclosure."""
    words = [word for parameter in parameters for word in ("--param", parameter)]
    done = support.call("law", kind.split()[0], *words, "--at=" + ",".join(map(repr, AT)))
    assert done.returncode == 0, done.stderr
    return [
        [float(row[name]) for name in ("pressure", "stiffness", "energy")]
        for row in csv.DictReader(io.StringIO(done.stdout))
    ]


@pytest.mark.parametrize("twin", [True, False])
@pytest.mark.parametrize("law_name", LAWS)
def test_the_fmu_gives_the_bits_of_the_command_line(law, law_name, twin):
    kind, parameters, words = LAWS[law_name]
    assert law.set_values(parameters | {"law.kind_integer" if twin else "law.kind": kind, "area": 2.0}) == OK, law.log
    for h, (pressure, stiffness, energy) in zip(AT, by_command_line(law_name, words), strict=True):
        assert law.set(overclosure=h, closing_velocity=-0.25) == OK
        assert law.reals(["pressure", "stiffness", "energy"]) == [pressure, stiffness, energy]
        assert law.reals(["force", "force_stiffness", "stored_energy"]) == [2 * pressure, 2 * stiffness, 2 * energy]
        assert law.real("power") == 2 * pressure * -0.25
        assert law.integer("status") == int(pressure != 0)


def test_fmpy_sets_parameters_and_tables_as_start_values(law_file):
    start = {"law.kind": "tabular", "table.n": len(TABLE), "overclosure": 0.015}
    for i, (p, h) in enumerate(TABLE, 1):
        start |= {f"table.pressure[{i}]": p, f"table.overclosure[{i}]": h}
    start["law.kind"] = 2
    result = fmpy.simulate_fmu(str(law_file), start_values=start)
    assert result["pressure"][0] == pytest.approx(7.5, rel=1e-14)
    text = fmpy.simulate_fmu(
        str(law_file), start_values={"law.kind_integer": 2, "table.text": TEXT, "overclosure": 0.015}
    )
    assert text["pressure"][0] == result["pressure"][0]


def test_fmpy_drives_it_with_a_signal(law_file):
    signal = numpy.array([(0, 0.0), (1, 1e-3)], dtype=[("time", float), ("overclosure", float)])
    result = fmpy.simulate_fmu(str(law_file), input=signal, start_values={"law.stiffness": 1e6, "area": 0.5})
    assert result["force"][-1] == pytest.approx(0.5 * 1e6 * 0.99e-3, rel=1e-9), "the input of the last step"
    assert (numpy.diff(result["force"]) >= 0).all()


def test_outputs_follow_an_input_without_a_step(law):
    assert law.set(law__stiffness=10.0, overclosure=2.0) == OK
    assert law.real("pressure") == 20.0
    assert law.set(overclosure=3.0) == OK
    assert law.real("pressure") == 30.0


def test_outputs_follow_during_initialisation(law_fmu, new_instance):
    instance = new_instance(law_fmu)
    instance.set(law__stiffness=10.0)
    instance.setup()
    instance.call("EnterInitializationMode")
    instance.set(overclosure=2.0)
    assert instance.real("pressure") == 20.0


@pytest.mark.parametrize(
    ("values", "named"),
    [
        ({"law.stiffness": 0.0}, "stiffness"),
        ({"law.stiffness": -1.0}, "stiffness"),
        ({"area": 0.0}, "area"),
        ({"law.kind": 3, "law.clearance_at_zero_pressure": -1e-3}, "clearance_at_zero_pressure"),
        ({"law.kind": 3, "law.pressure_at_zero_clearance": 0.0}, "pressure_at_zero_clearance"),
        ({"law.kind": 2, "table.text": "0:0"}, "table"),
        ({"law.kind": 2, "table.text": "0:0,1:x"}, "table"),
        ({"law.kind": 2, "table.text": "0:0,2:1,1:2"}, "table"),
        ({"law.kind": 2, "table.n": 3}, "table"),
    ],
)
def test_parameters_that_make_no_law_are_named_and_the_previous_values_stay(law_fmu, new_instance, values, named):
    before = new_instance(law_fmu)
    assert before.set_values(values) == OK, "nothing is judged before the initialisation ends"
    before.setup()
    assert before.call("EnterInitializationMode") == OK
    assert before.call("ExitInitializationMode") == ERROR
    assert named in before.errors()[-1]
    live = new_instance(law_fmu).start()
    live.set(overclosure=1e-4)
    *harmless, (name, value) = values.items()
    assert live.set_values(dict(harmless)) == OK
    outputs = live.outputs()
    assert live.set_values({name: value}) == ERROR
    assert named in live.errors()[-1] and "kept" in live.errors()[-1]
    assert live.outputs() == outputs
    assert live.set(overclosure=1e-4) == OK and live.outputs() == outputs


def test_initialisation_can_be_mended(law_fmu, new_instance):
    instance = new_instance(law_fmu)
    instance.set(area=-1.0)
    instance.setup()
    instance.call("EnterInitializationMode")
    assert instance.call("ExitInitializationMode") == ERROR
    assert instance.set(area=1.0) == OK
    assert instance.call("ExitInitializationMode") == OK


@pytest.mark.parametrize(
    ("name", "value"), [("law.kind", 0), ("law.kind", 5), ("law.kind_integer", -1), ("table.n", 1), ("table.n", 101)]
)
def test_integers_outside_their_bounds_are_refused(law, name, value):
    before = law.integer(name)
    assert law.set_values({name: value}) == ERROR
    assert name in law.errors()[-1]
    assert law.integer(name) == before


def test_the_twin_wins_over_the_enumeration_whatever_the_order(law):
    law.set(overclosure=1e-4)
    law.set_values({"law.kind_integer": 3, "law.kind": 1})
    exponential = law.real("pressure")
    law.set_values({"law.kind": 3, "law.kind_integer": 1})
    linear = law.real("pressure")
    assert exponential != linear
    law.set_values({"law.kind_integer": 0})
    assert law.real("pressure") == exponential
