"""Dynamic decks have the same bits by command line, daemon and FMU, and steps of the daemon end when they are asked to."""

import pytest

import demo
import overclosure
import support
from cosimulation import moving
from cosimulation.moving import PERIOD
from demonstration import ways

NAMES = list(moving.decks())
# No multiples of any increment.
TIMES = [0.0137, 0.0347, 0.0352, 0.0663, 0.0865, 0.1266, 0.1543, 0.1666, PERIOD]


@pytest.fixture(scope="module")
def client(tmp_path_factory):
    """A client of a daemon."""
    with (
        demo.running_daemon(tmp_path_factory.mktemp("daemon")) as endpoint,
        overclosure.connect(endpoint) as connected,
    ):
        yield connected


@pytest.fixture
def written(tmp_path):
    """Writes a deck by its name."""

    def write(name):
        path = tmp_path / f"{name}.inp"
        path.write_text(moving.decks()[name], encoding="utf-8")
        return path

    return write


def same(found, expected):
    """Outputs whose bits differ."""
    assert set(found) == set(expected)
    return {
        name: (found[name], expected[name]) for name in expected if ways.bits(found[name]) != ways.bits(expected[name])
    }


@pytest.mark.parametrize("name", NAMES)
def test_one_request_for_everything_has_the_bits_of_a_run(written, client, tmp_path, name):
    path = written(name)
    times, begin, table = ways.by_command_line(path, tmp_path / "out")
    assert times[-1] == PERIOD and len(times) > 5
    last = {output: values[-1:] for output, values in table.items()}
    assert not same(ways.by_daemon(client, path, [PERIOD]), last)
    assert not same(ways.by_fmu(path, tmp_path, [PERIOD], begin), last)


@pytest.mark.parametrize("name", NAMES)
def test_daemon_and_fmu_agree_in_steps_of_any_size(written, client, tmp_path, name):
    path = written(name)
    assert not same(ways.by_fmu(path, tmp_path, TIMES, 0.0), ways.by_daemon(client, path, TIMES))


@pytest.mark.parametrize("name", NAMES)
def test_a_step_ends_when_it_is_asked_to_and_can_be_taken_back(written, client, name):
    path = written(name)
    expected = ways.by_daemon(client, path, TIMES)
    touched = False
    with client.open(path) as session:
        for k, time in enumerate(TIMES):
            state = session.checkpoint()
            touched |= session.outputs["contact.ABOVE_BELOW.closed"] > 0
            ahead = session.step(time + 0.0123)
            assert ahead.time == time + 0.0123
            session.restore(state)
            reply = session.step(time)
            assert reply.time == time == session.time
            found = {output: [value] for output, value in reply.outputs.items()}
            assert not same(found, {output: [values[k]] for output, values in expected.items()}), time
        counts = session.report().steps[0].counts
        assert counts.impacts == expected["work.impacts"][-1]
        assert (counts.impacts > 0) == (name in ("implicit_hard", "implicit_fixed"))
    assert touched, "a state was taken in the middle of an impact"


@pytest.mark.parametrize("name", NAMES)
def test_fields_of_motion_are_those_of_the_tables(written, client, tmp_path, name):
    path = written(name)
    rows = {int(row["node"]): row for row in support.run(path, tmp_path / "out").last("nodes")}
    with client.open(path) as session:
        session.step(PERIOD)
        for field in "UVA":
            found = session.field(field)
            assert found.labels.tolist() == [1, 2, 3, 4, 5, 6, 7, 8, *range(11, 19)]
            assert set(rows) == {15, 16, 17, 18, 1, 2, 3, 4}
            for label, values in zip(found.labels.tolist(), found.values, strict=True):
                if label in rows:
                    expected = [float(rows[label][f"{field}{d}"]) for d in (1, 2, 3)]
                    assert ways.bits(values.tolist()) == ways.bits(expected), (field, label)
            mean = [found.values[found.labels.tolist().index(label)] for label in (15, 16, 17, 18)]
            assert sum(v[2] for v in mean) / 4 == pytest.approx(session.outputs[f"node.TOP.{field}3"], rel=1e-12)
        assert session.field("VR").values.size == 0, "nothing in this deck turns"
        with pytest.raises(overclosure.Fault) as caught:
            session.field("W")
        assert "V, VR, A, AR" in caught.value.message


def test_a_static_deck_has_no_velocities(client):
    with client.open(support.ROOT / "examples" / "two_blocks.inp") as session:
        assert not [name for name in session.outputs if ".V" in name or name == "work.impacts"]
        with pytest.raises(overclosure.Fault) as caught:
            session.field("V")
        assert caught.value.code == "unknown_field" and "VR" not in caught.value.message
