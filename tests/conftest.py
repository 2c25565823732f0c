"""Fixtures of the Python tests."""

import pytest

import support


@pytest.fixture(scope="session")
def overclosure_binary():
    """Path of the executable under test."""
    return support.binary()


@pytest.fixture
def write_deck(tmp_path):
    """Writes deck text into the test's own folder and returns the path."""

    def write(text, name="deck.inp"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write
