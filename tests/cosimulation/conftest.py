"""FMUs for the tests: packed once per session, unpacked once."""

import pytest

import generate_deck
from cosimulation.decks import pack
from cosimulation.raw import Fmu, Instance

PUNCH = 4
INCREMENTS = 10


@pytest.fixture(scope="session")
def work(tmp_path_factory):
    """A folder for the session."""
    return tmp_path_factory.mktemp("cosimulation")


@pytest.fixture(scope="session")
def law_file(work):
    """ContactLaw.fmu."""
    path = work / "ContactLaw.fmu"
    pack("--law", "-o", path)
    return path


@pytest.fixture(scope="session")
def deck_path(work):
    """A small punch, pressed in fixed increments."""
    path = work / "punch.inp"
    generate_deck.generate(["punch", str(PUNCH), str(path), "--increments", str(INCREMENTS)])
    return path


@pytest.fixture(scope="session")
def deck_file(work, deck_path):
    """The punch as an FMU."""
    path = work / "punch.fmu"
    pack(deck_path, "-o", path)
    return path


@pytest.fixture(scope="session")
def law_fmu(work, law_file):
    """ContactLaw, unpacked."""
    return Fmu.unpack(law_file, work / "law")


@pytest.fixture(scope="session")
def deck_fmu(work, deck_file):
    """The punch, unpacked."""
    return Fmu.unpack(deck_file, work / "deck")


def punch_of(work, law):
    """The punch with another contact law, unpacked."""
    deck = work / f"punch_{law}.inp"
    generate_deck.generate(["punch", str(PUNCH), str(deck), "--law", law])
    pack(deck, "-o", deck.with_suffix(".fmu"))
    return Fmu.unpack(deck.with_suffix(".fmu"), work / f"fmu_{law}")


@pytest.fixture(scope="session")
def hard_fmu(work):
    """Hard contact: multipliers and an active set."""
    return punch_of(work, "hard")


@pytest.fixture(scope="session")
def exponential_fmu(work):
    """The exponential law: iterations in every increment."""
    return punch_of(work, "exponential")


@pytest.fixture
def new_instance():
    """Makes instances that are freed at the end of the test."""
    made = []

    def make(fmu, **options):
        instance = Instance(fmu)
        assert instance.instantiate(**options), instance.log
        made.append(instance)
        return instance

    yield make
    for instance in made:
        if instance.component is not None:
            instance.free()


@pytest.fixture
def law(law_fmu, new_instance):
    """A law at its first communication point."""
    return new_instance(law_fmu).start()


@pytest.fixture
def deck(deck_fmu, new_instance):
    """The punch at its first communication point."""
    return new_instance(deck_fmu).start()
