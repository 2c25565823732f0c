"""The package against a running daemon."""

import json
import math
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import zenoh

import overclosure

ROOT = Path(__file__).parents[3]
INPUT = "boundary.NTOP.3"
FORCE = "contact.SSL_SMA.CFN3"


def test_info_names_the_daemon_and_its_limits(client):
    info = client.info()
    assert info.product == "overclosure" and info.daemon == client.daemon
    assert "exponential" in info.law_kinds and info.limits.sessions >= 1
    assert client.health().status == "ready"


def test_a_law_batch_agrees_with_its_formula(client):
    c0, p0 = 0.01, 5.0
    h = np.linspace(-2 * c0, 5 * c0, 1001)
    curve = client.law("exponential", {"c0": c0, "p0": p0}, h)
    np.testing.assert_array_equal(curve.overclosure, h)
    x = (h + c0) / c0
    expected = np.where(h > -c0, p0 / (math.e - 1) * x * np.expm1(x), 0.0)
    np.testing.assert_allclose(curve.pressure, expected, rtol=1e-12, atol=1e-15)


def test_a_table_may_be_pairs_or_text(client):
    pairs = client.law("tabular", {"table": [(0, 0), (10, 0.1), (30, 0.2)]}, [0.05, 0.15])
    text = client.law("tabular", {"table": "0:0,10:0.1,30:0.2"}, [0.05, 0.15])
    np.testing.assert_allclose(pairs.pressure, [5.0, 20.0], rtol=1e-14)
    np.testing.assert_array_equal(pairs.pressure, text.pressure)


def test_every_kind_of_law_comes_over_the_wire(client):
    parameters = {
        "linear": {"stiffness": 250},
        "tabular": {"table": [(0, 0), (10, 0.1)]},
        "exponential": {"c0": 0.01, "p0": 5},
        "calculix-exponential": {"c0": 0.01, "p0": 5},
        "penalty": {"stiffness": 3000, "clearance": 0.002},
        "nonlinear-penalty": {"ki": 100, "kf": 1e4, "d": 0.01, "e": 0.03},
        "augmented-lagrange": {"stiffness": 3000, "multiplier": 6},
        "damping": {"mu0": 8, "c0": 0.1, "eta": 0.4},
    }
    assert sorted(client.info().law_kinds) == sorted(parameters)
    h = np.array([-0.05, -0.001, 0.0, 0.02])
    curves = {kind: client.law(kind, values, h) for kind, values in parameters.items()}
    for kind, curve in curves.items():
        damping = kind == "damping"
        assert [curve.pressure.size, curve.stiffness.size, curve.energy.size] == [0 if damping else 4] * 3, kind
        assert [curve.coefficient.size, curve.coefficient_slope.size] == [4 if damping else 0] * 2, kind
    np.testing.assert_allclose(curves["penalty"].pressure, [0, 3, 6, 66], rtol=1e-14)
    np.testing.assert_allclose(curves["nonlinear-penalty"].pressure, [0, 0, 0, 26.75], rtol=1e-14)
    np.testing.assert_allclose(curves["augmented-lagrange"].pressure, [0, 3, 6, 66], rtol=1e-14)
    np.testing.assert_allclose(curves["damping"].coefficient, [8 * 0.05 / 0.06, 8, 8, 8], rtol=1e-14)


def test_a_refused_law_is_an_exception_with_its_reasons(client):
    with pytest.raises(overclosure.Fault) as caught:
        client.law("linear", {}, [0.0])
    assert caught.value.code == "law_refused" and "stiffness" in caught.value.message
    with pytest.raises(overclosure.Fault) as caught:
        client.law("linear", {"stiffness": 1}, [math.nan])
    assert caught.value.code == "not_finite"


def law_deck(name, *replacements):
    """A deck of the laws document with other lines."""
    text = (ROOT / "docs" / "laws" / "decks" / f"{name}.inp").read_text(encoding="utf-8")
    for old, new in replacements:
        assert old in text
        text = text.replace(old, new)
    return text


HARD = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n"


def test_augmentations_are_counted_per_step_and_in_the_report(client):
    # Spring 100, penalty 150 on an area of 2: each augmentation leaves a quarter of the overclosure, 0.03 / 4 at first.
    augmented = (HARD, "*SURFACE BEHAVIOR, AUGMENTED LAGRANGE\n150.,\n")
    tolerance = ("*BOUNDARY, AMPLITUDE", "*CONTACT CONTROLS, ABSOLUTE PENETRATION TOLERANCE=1e-4\n*BOUNDARY, AMPLITUDE")
    with client.open(law_deck("hard", augmented, tolerance)) as session:
        done = []
        for time in range(1, 12):
            done.append(session.step(float(time)).counts.augmentations)
            left = -session.field("COPEN").values[0]
            assert left <= 1e-4
        assert done[:4] == [0, 0, 0, 0] and max(done) > 0
        # A further 0.005 of the spring presses the point in by 0.00125; without kept multipliers it would be 0.0075.
        assert 1 <= done[-1] <= 4
        assert session.report().steps[0].counts.augmentations == sum(done)


def test_statuses_of_points_come_over_the_wire(client):
    def statuses(text, end):
        with client.open(text) as session:
            found = []
            for time in range(1, end + 1):
                session.step(float(time))
                field = session.field("CSTATUS")
                assert field.labels.tolist() == [11]
                found.append(int(field.values[0]))
            return found

    # At time 5 the point just touches: open or closed.
    hard = statuses(law_deck("hard"), 8)
    assert hard[:4] == [0, 0, 0, 0] and hard[5:] == [1, 1, 1]
    rough = (HARD, HARD + "*FRICTION, ROUGH\n")
    springs = ("*MATERIAL", "*ELEMENT, TYPE=SPRING1, ELSET=SIDE\n102, 11\n*SPRING, ELSET=SIDE\n1,\n7.,\n*MATERIAL")
    side = ("POINT, 1, 2\n", "POINT, 2, 2\n")
    assert statuses(law_deck("hard", rough, side, springs), 8)[5:] == [2, 2, 2]
    damped = (HARD, HARD + "*CONTACT DAMPING\n8., 0.1, 0.4\n")
    assert statuses(law_deck("hard", damped), 8)[1:4] == [4, 4, 4]


def test_the_touch_of_no_separation_survives_the_wire(client):
    """After a restore into another session a latched point still pulls, with the same bits."""
    deck = law_deck("no-separation")
    with client.open(deck) as first, client.open(deck) as second:
        first.step(10.0)
        assert first.field("CSTATUS").values[0] == 1
        state = first.checkpoint()
        ends = []
        for session in (first, second):
            session.restore(state)
            step = session.step(20.0)
            ends.append((step.vector.tobytes(), session.field("CPRESS").values.tobytes()))
            assert session.field("CPRESS").values[0] < 0 and session.field("CSTATUS").values[0] == 1
        assert ends[0] == ends[1]


def test_a_session_steps_reads_and_goes_back_bit_for_bit(client, deck):
    with client.open(deck) as session:
        assert [p.name for p in session.ports.inputs] == [INPUT]
        assert session.time == 0.0 and session.time_end == 1.0
        start = session.checkpoint()
        first = [session.step(i / 4, {INPUT: -0.005 * i}) for i in range(1, 5)]
        assert all(s.status == "reached" and s.counts.increments >= 1 for s in first)
        assert [s.time for s in first] == [0.25, 0.5, 0.75, 1.0]
        assert first[3].outputs[FORCE] > first[0].outputs[FORCE] > 0
        assert list(first[3].outputs.values()) == first[3].vector.tolist()
        assert session.get(INPUT, FORCE) == {INPUT: -0.02, FORCE: first[3].outputs[FORCE]}

        displacement, pressure = session.field("U"), session.field("CPRESS")
        assert displacement.values.shape == (displacement.labels.size, 3)
        assert pressure.values.shape == (4,) and (pressure.values > 0).all()

        session.restore(start)
        assert session.time == 0.0
        again = [session.step(i / 4, [-0.005 * i]) for i in range(1, 5)]
        assert [s.vector.tobytes() for s in again] == [s.vector.tobytes() for s in first]
        assert session.report().steps[0].counts.increments == sum(s.counts.increments for s in again)
    with pytest.raises(overclosure.Fault) as caught:
        session.step(1.0)
    assert caught.value.code == "unknown_session"


def test_a_deck_may_be_text(client, deck):
    with client.open(deck.read_text(), dialect="calculix", label="text") as session:
        assert [s.label for s in client.load().sessions] == ["text"]
        assert client.attach(session.id).outputs == session.outputs


@pytest.mark.parametrize("text", ["", "\x00\x01\x02\n\xff", "*NODE\n1, 0, 0, 0\n*ELEM"])
def test_a_bad_deck_is_an_exception_with_every_finding(client, text):
    with pytest.raises(overclosure.Fault) as caught:
        client.open(text)
    assert caught.value.code == "deck_refused"
    assert any(f.severity == "error" and f.message for f in caught.value.findings)
    lines = str(caught.value).splitlines()
    assert len(lines) == 1 + len(caught.value.findings)
    assert all(str(caught.value).count(f.message) == 1 for f in caught.value.findings)


@pytest.mark.parametrize(
    ("code", "time", "inputs"),
    [
        ("not_finite", 0.75, {INPUT: math.nan}),
        ("not_finite", math.inf, {}),
        ("time_in_past", 0.25, {}),
        ("unknown_port", 0.75, {"nothing": 1.0}),
        ("unknown_port", 0.75, [0.0, 0.0]),
    ],
)
def test_bad_steps_are_exceptions_and_change_nothing(client, deck, code, time, inputs):
    with client.open(deck) as session:
        session.step(0.5, {INPUT: -0.01})
        before = session.get()
        with pytest.raises(overclosure.Fault) as caught:
            session.step(time, inputs)
        assert caught.value.code == code and not caught.value.retryable
        assert session.get() == before
        assert session.step(0.75).status == "reached"


def test_two_clients_of_one_session_learn_the_sequence(client, deck):
    with client.open(deck) as first:
        second = client.attach(first.id)
        second.step(0.25)
        with pytest.raises(overclosure.Fault) as caught:
            first.step(0.5)
        assert caught.value.code == "sequence_conflict" and caught.value.sequence_expected == 2
        first.synchronize()
        assert first.time == 0.25 and first.step(0.5).time == 0.5


def test_how_long_a_session_is_idle_is_told(client, deck):
    assert client.info().limits.idle_seconds == 3600.0
    with client.open(deck):
        time.sleep(0.05)
        assert 0.04 <= client.load().sessions[0].idle_seconds < 60


def test_frames_arrive_and_end_with_the_session(client, deck):
    """Frames are live: on a busy machine some may be left out, which their numbers show, but none is wrong."""
    session = client.open(deck)
    with session.frames(timeout=10) as outputs, session.frames("CPRESS", timeout=10) as fields:
        expected, pressures = {}, {}
        for i in range(1, 5):
            step = session.step(i / 4, frames=["CPRESS"])
            expected[step.time] = step.vector
            pressures[step.time] = session.field("CPRESS")
        session.close()
        received = list(outputs)
        assert received
        numbers = [frame.number for frame in received]
        assert numbers == sorted(set(numbers))
        for frame in received:
            assert frame.values.tobytes() == expected[frame.time].tobytes()
        for frame in fields:
            np.testing.assert_array_equal(frame.labels, pressures[frame.time].labels)
            np.testing.assert_array_equal(frame.values, pressures[frame.time].values)


def test_waiting_for_a_frame_is_bounded(client, deck):
    with client.open(deck) as session, session.frames() as frames, pytest.raises(TimeoutError):
        frames.receive(timeout=0.05)


def test_a_program_that_forgets_to_close_still_ends(endpoint, deck):
    program = (
        "import sys, overclosure\n"
        "client = overclosure.connect(sys.argv[1])\n"
        "session = client.open(sys.argv[2])\n"
        "frames = session.frames()\n"
        "session.step(0.5)\n"
    )
    subprocess.run([sys.executable, "-c", program, endpoint, deck], check=True, timeout=60)


def test_nobody_there_is_said_soon():
    with pytest.raises(overclosure.Unavailable) as caught:
        overclosure.connect("tcp/127.0.0.1:1", timeout_connect=0.3, attempts=1)
    text = str(caught.value)
    assert text.startswith("no daemon answers at tcp/127.0.0.1:1; start one with `overclosure serve`"), text
    assert ".rs" not in text and "/root" not in text, text


def test_what_is_no_locator_is_said():
    with pytest.raises(overclosure.OverclosureError, match="nonsense"):
        overclosure.connect("nonsense", timeout_connect=0.3, attempts=1)


def test_a_tool_that_states_nothing_gets_readable_json(endpoint):
    config = zenoh.Config()
    config.insert_json5("mode", '"client"')
    config.insert_json5("connect/endpoints", json.dumps([endpoint]))
    with zenoh.open(config) as session:
        for selector, payload in [
            ("overclosure/v1/*/law?kind=linear;stiffness=100;at=-1,0.5", None),
            (
                "overclosure/v1/*/law",
                '{"kind": "linear", "parameters": [{"name": "k", "value": "100"}], "overclosure": [-1, 0.5]}',
            ),
        ]:
            replies = list(session.get(selector, payload=payload))
            assert len(replies) == 1 and replies[0].ok is not None
            text = replies[0].ok.payload.to_string()
            assert text.startswith("{\n") and json.loads(text)["pressure"] == [0.0, 50.0]
