"""Nonsense sent to the daemon is answered with a fault that says what is wrong, and the daemon lives on."""

import numpy as np
import pytest

import demo
import overclosure
import support

DECK = support.ROOT / "examples" / "two_blocks.inp"
DRIVE = "boundary.NTOP.3"


@pytest.fixture(scope="module")
def client(tmp_path_factory):
    """A client of a daemon of our own; at the end the daemon must still work."""
    with demo.running_daemon(tmp_path_factory.mktemp("daemon")) as endpoint, overclosure.connect(endpoint) as found:
        yield found
        with found.open(DECK) as session:
            assert session.step(1.0).status == "reached"
        assert found.health().sessions_failed == 0


@pytest.fixture
def session(client):
    """A session at time 0.5."""
    with client.open(DECK) as found:
        found.step(0.5)
        yield found


@pytest.mark.parametrize("value", [float("nan"), float("inf"), float("-inf")])
def test_an_input_that_is_not_finite_is_refused_and_changes_nothing(session, value):
    before = session.get()
    with pytest.raises(overclosure.Fault) as caught:
        session.step(0.75, inputs={DRIVE: value})
    assert caught.value.code == "not_finite" and DRIVE in str(caught.value)
    assert session.get() == before


def test_a_target_that_is_not_finite_is_refused(session):
    with pytest.raises(overclosure.Fault) as caught:
        session.step(float("nan"))
    assert caught.value.code == "not_finite"


def test_a_step_to_the_past_is_refused_and_the_session_goes_on(session):
    before = session.outputs
    with pytest.raises(overclosure.Fault) as caught:
        session.step(0.25)
    assert caught.value.code == "time_in_past"
    assert "0.25" in str(caught.value) and "0.5" in str(caught.value)
    assert session.step(0.5).outputs == before
    assert session.step(0.75).status == "reached"


def test_an_unknown_session_is_refused(client):
    with pytest.raises(overclosure.Fault) as caught:
        client.attach("nobody-1")
    assert caught.value.code == "unknown_session" and "nobody-1" in str(caught.value)


def test_a_closed_session_is_unknown(client):
    session = client.open(DECK)
    session.close()
    with pytest.raises(overclosure.Fault) as caught:
        session.step(0.5)
    assert caught.value.code == "unknown_session"


def test_an_unknown_port_and_an_unknown_field_are_refused_by_name(session):
    with pytest.raises(overclosure.Fault, match=r"boundary\.NTIP\.3"):
        session.step(0.75, inputs={"boundary.NTIP.3": 1.0})
    with pytest.raises(overclosure.Fault, match="CPRES") as caught:
        session.field("CPRES")
    assert "CPRESS" in str(caught.value)


@pytest.mark.parametrize(
    ("deck", "word"),
    [
        ("\n", "empty"),
        ("*NODE\n1, 0., 0., 0.\n", "*STEP"),
        ("\x00\x01\x02\n\x03\xff\n", ""),
        (DECK.read_text().replace("SSL, SMA", "SSL, SMB"), "SMB"),
        (DECK.read_text()[:700], ""),
        (DECK.read_text().replace("NTOP, 1, 2\n", "*CLOAD\n15, 1, 1.\n*BOUNDARY\n"), "UPPER"),
        ("*INCLUDE, INPUT=/etc/hostname\n", "*INCLUDE"),
    ],
    ids=["empty", "cut after nodes", "binary", "unknown surface", "cut in the middle", "body pushed away", "include"],
)
def test_a_bad_deck_is_refused_with_its_diagnostics(client, deck, word):
    with pytest.raises(overclosure.Fault) as caught:
        client.open(deck)
    fault = caught.value
    assert fault.code == "deck_refused"
    assert fault.findings and any(finding.severity == "error" for finding in fault.findings)
    text = " ".join(f"{f.keyword} {f.message} {f.remedy}" for f in fault.findings)
    assert word.lower() in (text + str(fault)).lower()


def test_a_law_that_makes_no_sense_is_refused(client):
    with pytest.raises(overclosure.Fault) as caught:
        client.law("linear", {"stiffness": -1}, [0.1])
    assert caught.value.code == "law_refused" and "stiffness" in str(caught.value)
    with pytest.raises(overclosure.Fault) as caught:
        client.law("linear", {"stiffness": 1}, np.array([0.1, np.nan]))
    assert caught.value.code == "not_finite"
