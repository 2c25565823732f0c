"""Contact that remembers has the same bits by command line, daemon and FMU."""

import pytest

import demo
import overclosure
from demonstration import ways


@pytest.fixture(scope="module")
def client(tmp_path_factory):
    """A client of a daemon."""
    with (
        demo.running_daemon(tmp_path_factory.mktemp("daemon")) as endpoint,
        overclosure.connect(endpoint) as connected,
    ):
        yield connected


@pytest.mark.parametrize("name", ways.decks())
def test_contact_that_remembers_has_the_same_bits_in_all_three_ways(tmp_path, client, name):
    """Every output of every increment, as 64 bits."""
    path = tmp_path / f"{name}.inp"
    path.write_text(ways.decks()[name], encoding="utf-8")
    times, begin, expected = ways.by_command_line(path, tmp_path)
    assert len(times) == ways.INCREMENTS
    for found in (ways.by_daemon(client, path, times), ways.by_fmu(path, tmp_path, times, begin)):
        assert set(found) == set(expected)
        wrong = [output for output in expected if ways.bits(found[output]) != ways.bits(expected[output])]
        assert not wrong, {output: (found[output], expected[output]) for output in wrong[:3]}


def test_the_decks_exercise_what_they_are_named_for(tmp_path):
    """Points open and close, carry tension, stick, are damped; multipliers are augmented."""
    seen = {}
    for name, text in ways.decks().items():
        path = tmp_path / f"{name}.inp"
        path.write_text(text, encoding="utf-8")
        result = ways.support.run(path, tmp_path / name)
        table = result.table("contact")
        seen[name] = (
            {row["status"] for row in table},
            min(float(row["CPRESS"]) for row in table),
            sum(step["augmentations"] for step in result.summary()["steps"]),
        )
    assert seen["modified_hard"][0] == {"OP", "CL"} and seen["modified_hard"][1] < 0.0
    assert seen["augmented"][0] == {"OP", "CL"} and seen["augmented"][2] > 4
    assert "ST" in seen["bonded"][0] and seen["bonded"][1] < 0.0
    assert seen["damped"][0] >= {"CL", "VD"} and seen["damped"][1] < 0.0
    assert seen["nonlinear"][0] == {"OP", "CL"}
    assert seen["preloaded"][2] > 2
