"""Decks in several files."""

import pytest

import overclosure
from overclosure._deck import read_deck


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "sub").mkdir()
    return tmp_path


def test_included_text_stands_where_it_was_included(folder):
    (folder / "deck.inp").write_bytes(
        b"\xef\xbb\xbf*HEADING\r\n** *INCLUDE, INPUT=no\r\n * include , input = sub/a.inc\r\n*STEP\n** gr\xf6\xdfe\n"
    )
    (folder / "sub" / "a.inc").write_text('*NODE\n*Include,\n INPUT="b.inc"\n*INCLUDE, INPUT=b.inc\n')
    (folder / "sub" / "b.inc").write_text("1, 0, 0, 0")
    assert read_deck(folder / "deck.inp") == (
        "*HEADING\r\n** *INCLUDE, INPUT=no\r\n*NODE\n1, 0, 0, 0\n1, 0, 0, 0\n*STEP\n** gr\ufffd\ufffde\n"
    )


@pytest.mark.parametrize(
    ("text", "inner", "says"),
    [
        ("*INCLUDE, INPUT=deck.inp\n" * 50, "", "line 1: .*deck.inp is being included already"),
        ("**\n*INCLUDE, INPUT=sub/a.inc\n", "*INCLUDE, INPUT=../deck.inp\n", "a.inc, line 1: .*included already"),
        ("**\n*INCLUDE, INPUT=gone.inc\n", "", "deck.inp, line 2: cannot read .*gone.inc: No such file"),
        ("*INCLUDE,\n INPUT=sub/a.inc\n*INCLUDE, INPUT=gone.inc\n", "", "deck.inp, line 3: cannot read"),
        ("*INCLUDE, FILE=sub/a.inc\n", "", "names no file"),
        ("*INCLUDE, INPUT=sub\n", "", "cannot read .*sub: Is a directory"),
    ],
)
def test_what_cannot_be_included_is_said_with_its_place(folder, text, inner, says):
    (folder / "deck.inp").write_text(text)
    (folder / "sub" / "a.inc").write_text(inner)
    with pytest.raises(overclosure.IncludeError, match=says):
        read_deck(folder / "deck.inp")


def test_very_many_files_are_refused(folder):
    (folder / "deck.inp").write_text("*INCLUDE, INPUT=a.inc\n" * 101)
    (folder / "a.inc").write_text("*INCLUDE, INPUT=b.inc\n" * 101)
    (folder / "b.inc").write_text("**\n")
    with pytest.raises(overclosure.IncludeError, match="more than 10000 files"):
        read_deck(folder / "deck.inp")


def test_a_deck_that_is_not_there_is_an_os_error(folder):
    with pytest.raises(FileNotFoundError):
        read_deck(folder / "gone.inp")


def test_a_deck_in_several_files_gives_the_same_numbers_and_as_text_is_refused(client, deck, folder):
    whole = deck.read_text()
    cut = whole.index("\n*STEP") + 1
    (folder / "sub" / "steps.inc").write_text(whole[cut:])
    parts = whole[:cut] + "*include, input=sub/steps.inc\n"
    (folder / "deck.inp").write_text(parts)
    with client.open(folder / "deck.inp") as session, client.open(deck) as same:
        assert session.step(1.0).vector.tobytes() == same.step(1.0).vector.tobytes()
    with pytest.raises(overclosure.Fault, match="INCLUDE") as caught:
        client.open(parts)
    assert caught.value.code == "deck_refused"


def test_port_declarations_beside_the_deck_are_taken_as_by_the_command_line(client, deck, folder, caplog):
    def inputs(source, **options):
        with client.open(source, **options) as session:
            return [port.name for port in session.ports.inputs]

    declare = '[[port]]\nport = "boundary.NTOP.3"\nname = "{}"\n'
    copy = folder / "blocks.v2.inp"
    copy.write_text(deck.read_text())
    assert inputs(copy) == ["boundary.NTOP.3"]
    (folder / "ports.toml").write_text(declare.format("of_the_folder"))
    with caplog.at_level("INFO", "overclosure"):
        assert inputs(copy) == ["of_the_folder"]
    assert str(folder / "ports.toml") in caplog.text
    assert inputs(copy, ports_toml="") == ["boundary.NTOP.3"]
    assert inputs(copy.read_text()) == ["boundary.NTOP.3"]
    (folder / "blocks.v2.ports.toml").write_text(declare.format("of_the_deck"))
    assert inputs(str(copy)) == ["of_the_deck"]
    assert inputs(copy, ports_toml=declare.format("given")) == ["given"]
