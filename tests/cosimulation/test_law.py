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
    "penalty": (5, {"law.stiffness": 3000.0, "penalty.clearance": 0.002}, ["stiffness=3000", "c0=0.002"]),
    "nonlinear-penalty": (
        6,
        {
            "penalty.stiffness_initial": 100.0,
            "penalty.stiffness_final": 1e4,
            "penalty.lower": 0.01,
            "penalty.upper": 0.03,
            "penalty.clearance": 0.005,
        },
        ["ki=100", "kf=1e4", "d=0.01", "e=0.03", "c0=0.005"],
    ),
    "augmented-lagrange": (
        7,
        {"law.stiffness": 3000.0, "penalty.multiplier": 6.0},
        ["stiffness=3000", "multiplier=6"],
    ),
    "linear without separation": (
        1,
        {"law.stiffness": 250.0, "law.separation": 1},
        ["stiffness=250", "separation=prevented", "procedure=explicit"],
    ),
    "tabular without separation": (
        2,
        {"table.text": TEXT, "law.separation": 1},
        [f"table={TEXT}", "separation=prevented", "procedure=explicit"],
    ),
    "penalty without separation": (
        5,
        {"law.stiffness": 250.0, "law.separation": 1},
        ["stiffness=250", "separation=prevented"],
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
    # The kind before an option that the present kind would refuse, after everything else.
    last = {"law.separation": parameters["law.separation"]} if "law.separation" in parameters else {}
    assert law.set_values(parameters | {"law.kind_integer" if twin else "law.kind": kind, "area": 2.0} | last) == OK, (
        law.log
    )
    for h, (pressure, stiffness, energy) in zip(AT, by_command_line(law_name, words), strict=True):
        assert law.set(overclosure=h, closing_velocity=-0.25) == OK
        assert law.reals(["pressure", "stiffness", "energy"]) == [pressure, stiffness, energy]
        assert law.reals(["force", "force_stiffness", "stored_energy"]) == [2 * pressure, 2 * stiffness, 2 * energy]
        assert law.real("power") == 2 * pressure * -0.25
        assert law.integer("status") == int(pressure != 0)


def test_damping_is_that_of_the_command_line_and_adds_to_the_force(law):
    parameters = {"coefficient": 8.0, "clearance": 0.1, "fraction": 0.4}
    assert law.set_values({f"damping.{name}": value for name, value in parameters.items()} | {"area": 2.0}) == OK
    assert law.set_values({"law.stiffness": 250.0}) == OK
    at = [-0.2, -0.1, -0.08, -0.05, 0.0, 0.06]
    words = [word for name, value in parameters.items() for word in ("--param", f"{name}={value}")]
    done = support.call("law", "damping", *words, "--at=" + ",".join(map(repr, at)))
    assert done.returncode == 0, done.stderr
    for h, row in zip(at, csv.DictReader(io.StringIO(done.stdout)), strict=True):
        coefficient, slope = float(row["coefficient"]), float(row["slope"])
        for speed in (0.25, 0.0, -0.5):
            assert law.set(overclosure=h, closing_velocity=speed) == OK
            pressure, viscous = law.real("pressure"), law.real("viscous_pressure")
            assert law.real("damping_coefficient") == coefficient and viscous == coefficient * speed
            assert law.real("force") == 2 * (pressure + viscous)
            assert law.real("power") == law.real("force") * speed
            assert law.real("dissipated_power") == 2 * viscous * speed >= 0
            assert law.reals(["force_stiffness", "force_damping"]) == [
                2 * (law.real("stiffness") + slope * speed),
                2 * coefficient,
            ]
            assert law.integer("status") == (1 if pressure else 2 if viscous else 0)


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
        ({"law.kind": 6, "penalty.lower": 1e-4}, "lower"),
        ({"law.kind": 6, "penalty.stiffness_final": 1e7}, "stiffness_final"),
        ({"law.kind": 7, "penalty.multiplier": -1.0}, "multiplier"),
        ({"law.kind": 5, "penalty.clearance": -1e-4}, "clearance_at_zero_pressure"),
        ({"law.kind": 3, "law.separation": 1}, "separation"),
        ({"damping.coefficient": -1.0}, "damping"),
        ({"damping.coefficient": 1.0, "damping.fraction": 1.0}, "fraction"),
        ({"damping.coefficient": 1.0, "damping.clearance": 0.0}, "clearance"),
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
    ("name", "value"),
    [
        ("law.kind", 0),
        ("law.kind", 8),
        ("law.kind_integer", -1),
        ("law.separation", 2),
        ("table.n", 1),
        ("table.n", 101),
    ],
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
