"""A run that goes on from a snapshot gives what the run without a stop gives, bit for bit."""

import os
import shutil
import signal
import struct
import subprocess
import zlib

import pytest

import generate_deck
import support

TABLES = ("history", "ports", "contact", "nodes")
SECOND_STEP = """*STEP, INC=200
*STATIC
0.1, 1., 1e-4, 0.3
*BOUNDARY
NTOP, 3, 3, -0.001
*NODE PRINT, NSET=NTOP, FREQUENCY=3
U, RF
*CONTACT FILE, FREQUENCY=4
CDIS, CSTR
*END STEP
"""


def write_punch(folder, law, increments=5, *, cards="", tail=SECOND_STEP):
    """A small punch that is pressed down in fixed increments and, in a second step, half way up in automatic ones."""
    deck = folder / "punch.inp"
    generate_deck.generate(["punch", 4, deck, "--law", law, "--increments", increments])
    text = deck.read_text()
    deck.write_text(text.replace("*NODE PRINT", f"{cards}*NODE PRINT", 1) + tail)
    return deck


def push(deck):
    """Forces on the top in place of displacements: contact alone holds the punch."""
    text = deck.read_text()
    pushed = text.replace("*BOUNDARY\nNTOP, 3, 3, -0.005\n", "*CLOAD\nNTOP, 3, -30.\n")
    pushed = pushed.replace("*BOUNDARY\nNTOP, 3, 3, -0.001\n", "*CLOAD\nNTOP, 3, -5.\n")
    assert pushed.count("*CLOAD") == 2
    deck.write_text(pushed)


def snapshots(result):
    """Snapshots that JOB.json lists; all of them are there."""
    listed = result.summary()["snapshots"]
    assert all((result.folder / one["file"]).is_file() for one in listed)
    return listed


def after(rows, origin):
    """The rows of later increments than that of a snapshot."""
    return [row for row in rows if (int(row["step"]), int(row["increment"])) > (origin["step"], origin["increment"])]


def frames(result):
    """Content of the frames by their time."""
    entries = (result.folder / f"{result.job}.pvd").read_text().split("<DataSet ")[1:]
    parts = [(entry.split('"')[1], entry.split('file="')[1].split('"')[0]) for entry in entries]
    return {float(time): (result.folder / name).read_bytes() for time, name in parts}


def insist_on_the_rest(whole, rest, origin):
    """Every table and frame of a restarted run is the end of that of the whole run."""
    for table in TABLES:
        expected = after(whole.table(table), origin)
        assert rest.table(table) == expected, table
    late = {time: content for time, content in frames(whole).items() if time > origin["time"]}
    assert frames(rest) == late


@pytest.mark.parametrize("held", [True, False], ids=["held", "floating"])
@pytest.mark.parametrize("law", generate_deck.LAWS)
def test_every_snapshot_leads_to_the_same_end(tmp_path, law, held):
    deck = write_punch(tmp_path, law)
    if not held:
        push(deck)
    whole = support.run(deck, tmp_path / "whole", "--snapshots", 2)
    listed = snapshots(whole)
    # Both ends of steps are there, and so is every second increment.
    last = [step["increments"] for step in whole.summary()["steps"]]
    assert [(s["step"], s["increment"]) for s in listed][:3] == [(1, 2), (1, 4), (1, 5)]
    assert (listed[-1]["step"], listed[-1]["increment"]) == (2, last[1])
    for one in listed:
        rest = support.run(deck, tmp_path / one["file"], "--restart", whole.folder / one["file"])
        insist_on_the_rest(whole, rest, one)
        summary = rest.summary()
        origin = summary["restarted_from"]
        assert origin == {**one, "file": str(whole.folder / one["file"])}
        counts = ("increments", "equilibrium_iterations", "severe_discontinuity_iterations", "cutbacks")
        pairs = zip(summary["steps"], whole.summary()["steps"], strict=True)
        assert all(step[c] == wholly[c] for step, wholly in pairs for c in counts)


def test_a_whole_run_tells_what_its_increments_were(tmp_path):
    summary = support.run(write_punch(tmp_path, "linear"), tmp_path / "out").summary()
    assert summary["restarted_from"] is None
    assert summary["snapshots"] == []
    first, second = summary["steps"]
    assert first["increment_min"] == pytest.approx(0.2, abs=1e-12)
    assert first["increment_max"] == pytest.approx(0.2, abs=1e-12)
    history = support.Result(tmp_path / "out", "punch").table("history")
    sizes = [float(row["dt"]) for row in history if row["step"] == "2"]
    assert (second["increment_min"], second["increment_max"]) == (min(sizes), max(sizes))
    assert second["increment_min"] < second["increment_max"] <= 0.3


def test_the_deck_asks_for_snapshots_and_the_option_goes_before_it(tmp_path):
    deck = write_punch(tmp_path, "linear", cards="*RESTART, WRITE, FREQUENCY=3\n", tail="")
    named = [s["file"] for s in snapshots(support.run(deck, tmp_path / "deck"))]
    assert named == ["punch_restart_1_3.ovck", "punch_restart_1_5.ovck"]
    named = [s["file"] for s in snapshots(support.run(deck, tmp_path / "option", "--snapshots", 4))]
    assert named == ["punch_restart_1_4.ovck", "punch_restart_1_5.ovck"]


def test_overlay_keeps_the_latest_alone(tmp_path):
    deck = write_punch(tmp_path, "linear", cards="*RESTART, WRITE, OVERLAY\n", tail="")
    result = support.run(deck, tmp_path / "out")
    assert snapshots(result) == [{"file": "punch_restart.ovck", "step": 1, "increment": 5, "time": 1.0}]
    assert [path.name for path in result.folder.glob("*.ovck*")] == ["punch_restart.ovck"]


def test_a_new_run_replaces_the_snapshots_of_an_earlier_one(tmp_path):
    deck = write_punch(tmp_path, "linear")
    support.run(deck, tmp_path / "out", "--snapshots", 1)
    support.run(deck, tmp_path / "out")
    assert not list((tmp_path / "out").glob("*.ovck"))


def test_magnitudes_that_were_set_stay_set(tmp_path):
    deck = write_punch(tmp_path, "linear", tail="")
    whole = support.run(deck, tmp_path / "whole", "--snapshots", 2, "--set", "boundary.NTOP.3=-0.002")
    first = snapshots(whole)[0]
    rest = support.run(deck, tmp_path / "rest", "--restart", whole.folder / first["file"])
    insist_on_the_rest(whole, rest, first)
    assert rest.summary()["inputs_set"] == {"boundary.NTOP.3": -0.002}
    other = support.run(
        deck, tmp_path / "other", "--restart", whole.folder / first["file"], "--set", "boundary.NTOP.3=-0.004"
    )
    assert float(other.last("ports")[0]["node.NTOP.U3"]) == pytest.approx(-0.004, rel=1e-12)


def killed(deck, folder, number, increments):
    """Runs a deck with a snapshot per increment and sends it a signal when so many increments are told."""
    command = [support.binary(), "run", deck, "--out", folder, "--snapshots", "1"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    with process:
        for line in process.stdout:
            if line.split()[:2] == ["1", str(increments)]:
                process.send_signal(number)
                break
        # Nothing is written to a pipe that nobody empties.
        process.stdout.read()
        return process.wait(timeout=60)


def test_a_killed_run_leaves_snapshots_to_go_on_from(tmp_path):
    deck = write_punch(tmp_path, "linear", 1500, tail="")
    deck.write_text(
        deck.read_text()
        .replace("*CONTACT FILE\n", "*CONTACT FILE, FREQUENCY=500\n")
        .replace("*NODE FILE\n", "*NODE FILE, FREQUENCY=500\n")
    )
    assert killed(deck, tmp_path / "killed", signal.SIGKILL, 20) == -signal.SIGKILL
    names = [path.name for path in (tmp_path / "killed").glob("punch_restart_*.ovck")]
    numbers = sorted(int(name.removesuffix(".ovck").split("_")[-1]) for name in names)
    assert numbers[:20] == list(range(1, 21))
    assert not (tmp_path / "killed" / "punch.json").exists()
    whole = support.run(deck, tmp_path / "whole")
    latest = tmp_path / "killed" / f"punch_restart_1_{numbers[-1]}.ovck"
    rest = support.run(deck, tmp_path / "rest", "--restart", latest)
    insist_on_the_rest(whole, rest, rest.summary()["restarted_from"])
    # What the killed run had told by then is the beginning of the whole one.
    kept = support.Result(tmp_path / "killed", "punch").table("history")
    assert kept[:20] == whole.table("history")[:20]


def test_a_run_that_is_told_to_stop_leaves_a_snapshot_of_its_end(tmp_path):
    deck = write_punch(tmp_path, "linear", 1500, cards="*RESTART, WRITE, FREQUENCY=1000\n", tail="")
    command = [support.binary(), "run", deck, "--out", tmp_path / "out"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as process:
        for line in process.stdout:
            if line.split()[:2] == ["1", "5"]:
                process.send_signal(signal.SIGTERM)
                break
        process.stdout.read()
        assert process.wait(timeout=60) == 3
    stopped = support.Result(tmp_path / "out", "punch")
    (one,) = snapshots(stopped)
    last = stopped.table("history")[-1]
    assert (one["increment"], one["time"]) == (int(last["increment"]), float(last["time"]))
    assert one["time"] == stopped.summary()["time_reached"] < 1.0


@pytest.fixture
def snapshot(tmp_path):
    """A deck and a snapshot of it."""
    deck = write_punch(tmp_path, "linear", tail="")
    result = support.run(deck, tmp_path / "whole", "--snapshots", 2)
    return deck, result.folder / snapshots(result)[0]["file"]


def refusal(deck, file, folder, *, factors=False):
    """Standard error of a run that must be refused before it writes anything, and unless told otherwise before it factors."""
    environment = {**os.environ, "OVERCLOSURE_LOG": "overclosure=debug"}
    done = support.call("run", deck, "--out", folder, "--restart", file, env=environment)
    assert done.returncode == 2, (done.returncode, done.stderr)
    assert "panicked" not in done.stderr
    assert not folder.exists() or not any(folder.iterdir())
    assert ("factor" in done.stderr) == factors
    return done.stderr


def test_a_damaged_snapshot_is_refused(tmp_path, snapshot):
    deck, file = snapshot
    good = file.read_bytes()
    damaged = tmp_path / "damaged.ovck"
    for content in (b"", good[:19], good[:-1], good[:40] + bytes([good[40] ^ 1]) + good[41:], b"OVCX" + good[4:]):
        damaged.write_bytes(content)
        message = refusal(deck, damaged, tmp_path / "out")
        assert "damaged.ovck" in message and "damaged" in message.split("damaged.ovck", 1)[1], message


def test_a_snapshot_of_another_version_is_refused(tmp_path, snapshot):
    deck, file = snapshot
    good = file.read_bytes()
    other = tmp_path / "other.ovck"
    other.write_bytes(good[:4] + struct.pack("<I", 4711) + good[8:])
    assert "version 4711" in refusal(deck, other, tmp_path / "out")


def test_a_snapshot_whose_content_does_not_fit_is_refused(tmp_path, snapshot):
    deck, file = snapshot
    good = file.read_bytes()
    payload = good[20:] + b"\0"
    forged = tmp_path / "forged.ovck"
    forged.write_bytes(good[:16] + struct.pack("<I", zlib.crc32(payload)) + payload)
    assert "does not fit" in refusal(deck, forged, tmp_path / "out", factors=True)


def test_a_snapshot_of_another_deck_is_refused(tmp_path, snapshot):
    deck, file = snapshot
    other = tmp_path / "other.inp"
    other.write_text(deck.read_text().replace("-0.005", "-0.006"))
    assert "another model" in refusal(other, file, tmp_path / "out")


def test_a_missing_snapshot_is_refused(tmp_path, snapshot):
    deck, _ = snapshot
    assert "nowhere.ovck" in refusal(deck, tmp_path / "nowhere.ovck", tmp_path / "out")


def test_results_that_a_restart_would_replace_are_kept(tmp_path, snapshot):
    deck, file = snapshot
    before = {path.name: path.read_bytes() for path in file.parent.iterdir()}
    done = support.call("run", deck, "--out", file.parent, "--restart", file)
    assert done.returncode == 2
    assert "--out" in done.stderr
    assert {path.name: path.read_bytes() for path in file.parent.iterdir()} == before


def test_a_snapshot_in_the_folder_of_the_restart_stays(tmp_path, snapshot):
    deck, file = snapshot
    folder = tmp_path / "moved"
    folder.mkdir()
    copy = shutil.copy(file, folder)
    support.run(deck, folder, "--restart", copy)
    assert os.path.isfile(copy)


@pytest.mark.parametrize("number", ["0", "-1", "1.5", "all"])
def test_a_number_of_snapshots_that_makes_no_sense_is_refused(tmp_path, number):
    deck = write_punch(tmp_path, "linear", tail="")
    assert support.call("run", deck, "--out", tmp_path / "out", f"--snapshots={number}").returncode == 2
