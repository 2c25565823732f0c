"""Call order, null pointers, nonsense numbers, logging: nothing crashes, everything is said."""

import ctypes as c
import shutil
from pathlib import Path

import pytest

from cosimulation import decks
from cosimulation.decks import pack
from cosimulation.raw import ERROR, OK, WARNING, Callbacks, Fmu, Instance

# Which calls the standard allows, by phase: I instantiated, M initialisation mode, S step complete, T terminated.
# Arguments are such that an allowed call succeeds.
ZERO = c.c_size_t(0)
CALLS = {
    "SetDebugLogging": ("IMST", lambda i: i.call("SetDebugLogging", 1, ZERO, None)),
    "SetupExperiment": ("I", lambda i: i.setup()),
    "EnterInitializationMode": ("I", lambda i: i.call("EnterInitializationMode")),
    "ExitInitializationMode": ("M", lambda i: i.call("ExitInitializationMode")),
    "Terminate": ("S", lambda i: i.call("Terminate")),
    "Reset": ("IMST", lambda i: i.call("Reset")),
    "GetReal": ("MST", lambda i: i.call("GetReal", None, ZERO, None)),
    "GetInteger": ("MST", lambda i: i.call("GetInteger", None, ZERO, None)),
    "GetBoolean": ("MST", lambda i: i.call("GetBoolean", None, ZERO, None)),
    "GetString": ("MST", lambda i: i.call("GetString", None, ZERO, None)),
    "SetReal": ("IMS", lambda i: i.call("SetReal", None, ZERO, None)),
    "SetInteger": ("IMS", lambda i: i.call("SetInteger", None, ZERO, None)),
    "SetBoolean": ("IMS", lambda i: i.call("SetBoolean", None, ZERO, None)),
    "SetString": ("IMS", lambda i: i.call("SetString", None, ZERO, None)),
    "GetFMUstate": ("IMST", lambda i: i.call("GetFMUstate", c.byref(c.c_void_p()))),
    "SetFMUstate": ("IMST", lambda i: i.load(i.saved)),
    "FreeFMUstate": ("IMST", lambda i: i.call("FreeFMUstate", c.byref(c.c_void_p()))),
    "SerializedFMUstateSize": ("IMST", lambda i: i.call("SerializedFMUstateSize", i.saved, c.byref(c.c_size_t()))),
    "SerializeFMUstate": (
        "IMST",
        lambda i: i.call("SerializeFMUstate", i.saved, (c.c_ubyte * 65536)(), c.c_size_t(65536)),
    ),
    "DeSerializeFMUstate": ("IMST", lambda i: i.deserialize(i.bytes)[0]),
    "SetRealInputDerivatives": ("IMS", lambda i: i.call("SetRealInputDerivatives", None, ZERO, None, None)),
    "GetRealOutputDerivatives": ("ST", lambda i: i.call("GetRealOutputDerivatives", None, ZERO, None, None)),
    "DoStep": ("S", lambda i: i.step(0, 0.1)),
    "GetStatus": ("ST", lambda i: i.call("GetStatus", 0, c.byref(c.c_int()))),
    "GetRealStatus": ("ST", lambda i: i.call("GetRealStatus", 2, c.byref(c.c_double()))),
    "GetBooleanStatus": ("ST", lambda i: i.call("GetBooleanStatus", 3, c.byref(c.c_int()))),
    # These have nothing to offer: an error wherever they are called.
    "GetDirectionalDerivative": ("", lambda i: i.call("GetDirectionalDerivative", None, ZERO, None, ZERO, None, None)),
    "CancelStep": ("", lambda i: i.call("CancelStep")),
    "GetIntegerStatus": ("", lambda i: i.call("GetIntegerStatus", 0, c.byref(c.c_int()))),
    "GetStringStatus": ("", lambda i: i.call("GetStringStatus", 1, c.byref(c.c_char_p()))),
}


def in_phase(new_instance, fmu, phase):
    """A fresh instance in a phase, with a state saved there and its bytes."""
    instance = new_instance(fmu)
    if phase != "I":
        assert instance.setup() == OK
        assert instance.call("EnterInitializationMode") == OK
    if phase in "ST":
        assert instance.call("ExitInitializationMode") == OK
    if phase == "T":
        assert instance.call("Terminate") == OK
    instance.saved = instance.save()
    instance.bytes = instance.serialize(instance.saved)
    instance.log.clear()
    return instance


@pytest.mark.parametrize("phase", "IMST")
@pytest.mark.parametrize("kind", ["law_fmu", "deck_fmu"])
def test_every_call_in_every_phase(request, new_instance, kind, phase):
    fmu = request.getfixturevalue(kind)
    for name, (phases, act) in CALLS.items():
        instance = in_phase(new_instance, fmu, phase)
        status = act(instance)
        if phase in phases:
            assert (name, status, instance.errors()) == (name, OK, [])
        else:
            assert (name, status) == (name, ERROR)
            assert any(f"fmi2{name}" in text for text in instance.errors()), (name, instance.log)
            assert instance.call("Reset") == OK, "the instance is still usable"
        instance.free()


def test_a_null_component_is_an_error_everywhere(law_fmu):
    nobody = Instance(law_fmu)
    nobody.saved, nobody.bytes = c.c_void_p(), b"x"
    for name, (_, act) in CALLS.items():
        assert (name, act(nobody)) == (name, ERROR)
    nobody.free()


@pytest.mark.parametrize(
    ("what", "options"),
    [
        ("GUID", {"guid": b"{00000000-0000-0000-0000-000000000000}"}),
        ("GUID", {"guid": None}),
        ("name", {"name": None}),
        ("name", {"name": b""}),
        ("co-simulation", {"kind": 0}),
        ("http", {"location": b"http://example.org/resources"}),
        ("options.json", {"location": b"file:///nowhere/resources"}),
    ],
)
def test_instantiation_refuses(law_fmu, what, options):
    instance = Instance(law_fmu)
    assert not instance.instantiate(**options)
    assert what in instance.errors()[0]


def test_instantiation_accepts_missing_callbacks(law_fmu):
    for callbacks in (None, Callbacks()):
        instance = Instance(law_fmu)
        assert instance.instantiate(callbacks=callbacks)
        instance.start()
        assert instance.set(overclosure=float("nan")) == ERROR, "the reason goes nowhere, and nothing crashes"
        instance.free()
    assert not Instance(law_fmu).instantiate(callbacks=None, guid=b"wrong")


def test_every_form_of_the_resource_location_is_accepted(law_fmu, tmp_path):
    tree = tmp_path / "sp ace"
    fmu = law_fmu.copied_to(tree)
    path = str((tree / "resources").resolve())
    encoded = path.replace(" ", "%20")
    for location in (
        None,
        "",
        path,
        path + "/",
        "file://" + encoded,
        "file://" + encoded + "/",
        "file:" + encoded,
        "file:///" + encoded,
        "file://localhost" + encoded,
        "file://" + path,
    ):
        instance = Instance(fmu)
        assert instance.instantiate(location=None if location is None else location.encode()), (location, instance.log)
        instance.free()


def test_null_pointers_with_a_count_are_refused(law, deck):
    one = c.c_size_t(1)
    reference = c.byref(c.c_uint(0))
    for instance in (law, deck):
        for name in ("GetReal", "GetInteger", "GetString", "SetReal", "SetInteger", "SetString"):
            assert instance.call(name, None, one, None) == ERROR, name
            assert instance.call(name, reference, one, None) == ERROR, name
        for name in ("GetBoolean", "SetBoolean"):
            assert instance.call(name, None, one, None) == ERROR, name
        assert instance.call("SetDebugLogging", 1, one, None) == ERROR
        assert instance.call("GetFMUstate", None) == ERROR
        assert instance.call("SetFMUstate", None) == ERROR
        assert instance.call("FreeFMUstate", None) == OK
        assert instance.call("SerializedFMUstateSize", None, None) == ERROR
        assert instance.call("SerializeFMUstate", None, None, one) == ERROR
        assert instance.call("DeSerializeFMUstate", None, one, None) == ERROR
        assert instance.call("GetRealStatus", 2, None) == ERROR
        assert instance.call("GetBooleanStatus", 3, None) == ERROR
        assert instance.call("GetStatus", 0, None) == ERROR
        assert instance.step(0, 0) == OK


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf")])
def test_numbers_that_are_not_finite_are_refused_by_name(law, deck, deck_fmu, value):
    (port,) = deck_fmu.names("input")
    for instance, name in ((law, "overclosure"), (deck, port)):
        before = instance.real(name)
        assert instance.set_values({name: value}) == ERROR
        assert name in instance.errors()[-1] and "finite" in instance.errors()[-1]
        assert instance.real(name) == before
        for point, size in ((value, 0.1), (0.0, value)):
            assert instance.step(point, size) == ERROR
        assert instance.step(0, 0.1) == OK


@pytest.mark.parametrize("kind", ["law_fmu", "deck_fmu"])
def test_unknown_value_references_and_wrong_types_are_refused(request, new_instance, kind):
    fmu = request.getfixturevalue(kind)
    instance = new_instance(fmu).start()
    one, number, whole, text = c.c_size_t(1), c.c_double(1), c.c_int(1), c.c_char_p(b"x")
    for reference in (len(fmu.variables), 2**32 - 1):
        for name, value in (("Real", number), ("Integer", whole), ("Boolean", whole), ("String", text)):
            for verb in ("Get", "Set"):
                status = instance.call(verb + name, c.byref(c.c_uint(reference)), one, c.byref(value))
                assert status == ERROR
                assert str(reference) in instance.errors()[-1] and name in instance.errors()[-1]
    real = c.c_uint(fmu.references[fmu.names("input")[0]])
    for name, value in (("Integer", whole), ("String", text), ("Boolean", whole)):
        assert instance.call("Get" + name, c.byref(real), one, c.byref(value)) == ERROR
        assert instance.call("Set" + name, c.byref(real), one, c.byref(value)) == ERROR


def test_outputs_cannot_be_set(law, deck, deck_fmu):
    for instance, name in ((law, "pressure"), (deck, deck_fmu.outputs[0])):
        before = instance.outputs()
        assert instance.set_values({name: 1.0}) == ERROR
        assert name in instance.errors()[-1]
        assert instance.outputs() == before


def test_a_set_of_several_takes_all_or_none(law, law_fmu):
    references = (c.c_uint * 2)(law_fmu.references["overclosure"], law_fmu.references["closing_velocity"])
    assert law.call("SetReal", references, c.c_size_t(2), (c.c_double * 2)(1e-3, float("nan"))) == ERROR
    assert law.reals(["overclosure", "closing_velocity", "pressure"]) == [0, 0, 0]


def test_strings_stay_until_the_next_call(law, law_fmu):
    law.set(table__text="0:0,1e6:1e-3")
    reference = c.byref(c.c_uint(law_fmu.references["table.text"]))
    value = c.c_char_p()
    assert law.call("GetString", reference, c.c_size_t(1), c.byref(value)) == OK
    law.set(overclosure=1e-3)
    law.step(0, 0.1)
    assert value.value == b"0:0,1e6:1e-3"


def test_the_wrong_communication_point_is_refused(law, deck):
    for instance in (law, deck):
        assert instance.step(0, 0.1) == OK
        for point in (0.0, 0.2, 0.1001, -0.1):
            assert instance.step(point, 0.1) == ERROR
            assert "communication point" in instance.errors()[-1]
        assert instance.step(0.1, -0.1) == ERROR
        assert instance.step(0.1, 0.1) == OK


def test_the_stop_time_counts_only_if_it_is_defined(law_fmu, new_instance):
    free = new_instance(law_fmu).start()
    assert free.step(0, 100) == OK
    bound = new_instance(law_fmu).start(stop=1.0)
    assert bound.step(0, 1.0) == OK
    assert bound.step(1.0, 0.1) == ERROR
    assert "stop time" in bound.errors()[-1]
    assert bound.step(1.0, 0) == OK


def test_nonsense_times_are_refused(law_fmu, new_instance):
    instance = new_instance(law_fmu)
    assert instance.setup(start=float("nan")) == ERROR
    assert instance.setup(start=0, stop=float("inf")) == ERROR
    assert instance.setup(start=2, stop=1) == ERROR
    assert instance.setup(start=2, stop=3) == OK


def test_statuses_tell_the_last_good_time(deck):
    assert deck.step(0, 0.25) == OK
    time, terminated, status = c.c_double(), c.c_int(7), c.c_int(7)
    assert deck.call("GetRealStatus", 2, c.byref(time)) == OK and time.value == 0.25
    assert deck.call("GetBooleanStatus", 3, c.byref(terminated)) == OK and terminated.value == 0
    assert deck.call("GetStatus", 0, c.byref(status)) == OK and status.value == OK
    assert deck.call("GetRealStatus", 77, c.byref(time)) == ERROR


def test_categories_filter_and_unknown_ones_are_a_warning(law):
    def configure(on, *names):
        law.log.clear()
        return law.call("SetDebugLogging", on, c.c_size_t(len(names)), (c.c_char_p * max(len(names), 1))(*names))

    assert configure(1, b"logStatusError") == OK
    law.step(0, 0.1)
    assert law.log == []
    law.step(0, 0.1)
    assert [m.category for m in law.log] == ["logStatusError"]
    assert configure(1, b"logEvents") == OK
    law.step(0, 0.1)
    assert law.log == []
    law.step(0.1, 0.1)
    assert [m.category for m in law.log] == ["logEvents"]
    assert configure(1, b"logAll", b"logNonsense") == WARNING
    assert "logNonsense" in law.log[-1].text
    assert configure(0) == OK
    law.step(0, 0.1)
    assert law.set(overclosure=float("nan")) == ERROR
    assert law.log == []


def test_nothing_is_logged_when_logging_is_off(law_fmu, new_instance):
    instance = new_instance(law_fmu, logging=False).start()
    assert instance.step(5, 0.1) == ERROR
    assert instance.log == []


def test_percent_signs_arrive_doubled(tmp_path, law_fmu, new_instance):
    # The logger is printf-like: what it gets is a format, so a literal percent sign comes twice.
    name = "100%n%s.inp"
    deck = tmp_path / name
    deck.write_text(decks.two_bricks(top="TOP%S"))
    pack(deck, "-o", tmp_path / "percent.fmu")
    fmu = Fmu.unpack(tmp_path / "percent.fmu", tmp_path / "fmu")
    instance = new_instance(fmu, name=b"50%n").start()
    (port,) = fmu.names("input")
    assert "%" in port
    assert instance.set_values({port: float("nan")}) == ERROR
    assert port.replace("%", "%%") in instance.errors()[-1]
    import fmpy

    with pytest.raises(fmpy.fmi1.FMICallException):
        fmpy.simulate_fmu(str(tmp_path / "percent.fmu"), start_values={port: "nan"}, debug_logging=True, validate=False)


def test_an_fmu_of_a_damaged_deck_says_what_is_wrong(deck_fmu, tmp_path):
    moved = deck_fmu.copied_to(tmp_path / "tree")
    deck = Path(moved.folder) / "resources" / "deck.inp"
    text = deck.read_text()
    deck.write_text(text[: len(text) // 2])
    instance = Instance(moved)
    assert not instance.instantiate()
    assert "cannot be prepared" in instance.errors()[0]
    shutil.rmtree(moved.folder / "resources")
    assert not Instance(moved).instantiate()
