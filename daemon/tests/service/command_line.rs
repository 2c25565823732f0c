//! The client verbs of the command line.

use std::process::{Output, Stdio};

use crate::support::{Daemon, INPUT, overclosure};

struct Ran {
    code: Option<i32>,
    out: String,
    err: String,
}

fn run(daemon: &Daemon, arguments: &[&str]) -> Ran {
    let Output { status, stdout, stderr } =
        overclosure().args(arguments).args(["--connect", &daemon.endpoint]).output().unwrap();
    Ran { code: status.code(), out: String::from_utf8(stdout).unwrap(), err: String::from_utf8(stderr).unwrap() }
}

fn deck() -> String {
    format!("{}/../examples/two_blocks.inp", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn a_session_is_opened_listed_stepped_read_watched_and_closed() {
    let daemon = Daemon::start();
    let opened = run(&daemon, &["sessions", "--open", &deck()]);
    assert_eq!(opened.code, Some(0), "{}", opened.err);
    let session = opened.out.trim();
    let listed = run(&daemon, &["sessions"]);
    assert!(listed.out.contains(session) && listed.out.contains("two_blocks.inp"), "{}", listed.out);

    let stepped = run(&daemon, &["step", session, "--time", "0.25", "--set", &format!("{INPUT}=-0.005")]);
    assert_eq!(stepped.code, Some(0), "{}", stepped.err);
    assert!(stepped.out.starts_with("time 0.25\n"), "{}", stepped.out);
    let got = run(&daemon, &["get", session, INPUT]);
    assert_eq!(got.out, format!("{INPUT} -0.005\n"));
    let field = run(&daemon, &["get", session, "--field", "U"]);
    assert!(field.out.starts_with("node,U1,U2,U3\n") && field.out.lines().count() == 17, "{}", field.out);

    let mut watching = overclosure()
        .args(["watch", session, "--count", "2", "--connect", &daemon.endpoint])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    // The header is printed once the daemon knows of the subscription.
    let mut lines = std::io::BufRead::lines(std::io::BufReader::new(watching.stdout.take().unwrap()));
    assert!(lines.next().unwrap().unwrap().starts_with("number,step,increment,time,contact."));
    for time in ["0.5", "0.75"] {
        assert_eq!(run(&daemon, &["step", session, "--time", time]).code, Some(0));
    }
    assert_eq!(lines.collect::<Result<Vec<_>, _>>().unwrap().len(), 2);
    assert!(watching.wait().unwrap().success());

    assert_eq!(run(&daemon, &["sessions", "--close", session]).code, Some(0));
    assert!(run(&daemon, &["sessions"]).out.contains("0 open"));
}

#[test]
fn refusals_exit_2_and_an_absent_daemon_exits_1() {
    let daemon = Daemon::start();
    let unknown = run(&daemon, &["get", "zzzz-1"]);
    assert_eq!(unknown.code, Some(2), "{}", unknown.err);
    assert!(unknown.err.contains("zzzz-1"), "{}", unknown.err);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bad.inp");
    std::fs::write(&path, "*NODE\n1, 0, 0\n").unwrap();
    let refused = run(&daemon, &["sessions", "--open", path.to_str().unwrap()]);
    assert_eq!(refused.code, Some(2));
    assert!(refused.err.contains("deck_refused"), "{}", refused.err);
    let lines: Vec<&str> = refused.err.lines().collect();
    assert!(lines[1..].iter().all(|line| refused.err.matches(line).count() == 1), "each finding once: {lines:?}");

    let opened = run(&daemon, &["sessions", "--open", &deck()]);
    let session = opened.out.trim();
    assert_eq!(run(&daemon, &["step", session, "--time", "1", "--set", "boundary.NTOP.3=soon"]).code, Some(2));
    assert_eq!(run(&daemon, &["step", session, "--time", "nan"]).code, Some(2));

    let mut gone = daemon;
    gone.terminate();
    gone.wait();
    let absent = run(&gone, &["sessions"]);
    assert_eq!(absent.code, Some(1), "{}", absent.err);
    assert!(absent.err.contains(&gone.endpoint), "{}", absent.err);
    assert!(absent.err.contains("overclosure serve") && !absent.err.contains(".rs"), "{}", absent.err);
}

#[test]
fn several_sessions_are_closed_at_once() {
    let daemon = Daemon::start();
    let open = || run(&daemon, &["sessions", "--open", &deck()]).out.trim().to_owned();
    let ids = [open(), open(), open(), open()];
    let some = run(&daemon, &["sessions", "--close", &ids[0], "zzzz-1", &ids[1]]);
    assert_eq!(some.code, Some(2), "one of them is unknown");
    assert!(some.err.contains("zzzz-1"), "{}", some.err);
    let left = run(&daemon, &["sessions"]).out;
    assert!(left.contains("2 open") && !left.contains(&ids[0]) && !left.contains(&ids[1]), "{left}");
    assert!(left.contains("3600 s"), "{left}");
    assert_eq!(run(&daemon, &["sessions", "--close-all"]).code, Some(0));
    assert!(run(&daemon, &["sessions"]).out.contains("0 open"));
    assert_eq!(run(&daemon, &["sessions", "--close-all", "--open", &deck()]).code, Some(2));
}

#[test]
fn fields_are_watched_when_steps_ask_for_them() {
    let daemon = Daemon::start();
    let opened = run(&daemon, &["sessions", "--open", &deck()]);
    let session = opened.out.trim();
    let mut watching = overclosure()
        .args(["watch", session, "--field", "CPRESS", "--count", "1", "--connect", &daemon.endpoint])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = std::io::BufRead::lines(std::io::BufReader::new(watching.stdout.take().unwrap()));
    assert!(lines.next().unwrap().unwrap().starts_with("time,node,CPRESS"));
    let stepped = run(&daemon, &["step", session, "--time", "0.25", "--frames", "U,CPRESS"]);
    assert_eq!(stepped.code, Some(0), "{}", stepped.err);
    let rows = lines.collect::<Result<Vec<_>, _>>().unwrap();
    assert!(rows.len() == 4 && rows[0].starts_with("2.5"), "{rows:?}");
    assert!(watching.wait().unwrap().success());
    assert_eq!(run(&daemon, &["step", session, "--time", "0.5", "--frames", "CPRES"]).code, Some(2));
}

#[test]
fn a_deck_is_opened_with_the_files_that_it_includes() {
    let daemon = Daemon::start();
    let folder = tempfile::tempdir().unwrap();
    let whole = std::fs::read_to_string(deck()).unwrap();
    let cut = whole.find("\n*STEP").unwrap() + 1;
    let path = folder.path().join("deck.inp");
    std::fs::write(&path, format!("{}*include, input=steps.inc\n", &whole[..cut])).unwrap();
    let open = || run(&daemon, &["sessions", "--open", path.to_str().unwrap()]);
    let missing = open();
    assert_eq!(missing.code, Some(2));
    assert!(missing.err.contains("steps.inc"), "{}", missing.err);
    std::fs::write(folder.path().join("steps.inc"), &whole[cut..]).unwrap();
    let opened = open();
    assert_eq!(opened.code, Some(0), "{}", opened.err);
    assert_eq!(run(&daemon, &["step", opened.out.trim(), "--time", "1"]).code, Some(0));
}
