//! Start, configuration, end.

use std::process::Output;

use overclosure_client::OpenRequest;

use crate::support::{DECK, Daemon, overclosure};

fn serve(arguments: &[&str]) -> (Option<i32>, String) {
    let Output { status, stderr, .. } = overclosure().arg("serve").args(arguments).output().unwrap();
    (status.code(), String::from_utf8(stderr).unwrap())
}

#[test]
fn sigterm_and_sigint_end_the_daemon_with_success() {
    for signal in ["-TERM", "-INT"] {
        let mut daemon = Daemon::start();
        let _session = daemon.client().open(OpenRequest { deck: DECK.into(), ..Default::default() }).unwrap();
        let sent = std::process::Command::new("kill").args([signal, &daemon.child.id().to_string()]).status().unwrap();
        assert!(sent.success());
        assert_eq!(daemon.wait().code(), Some(0), "{signal}");
    }
}

#[test]
fn an_occupied_endpoint_is_named() {
    let daemon = Daemon::start();
    let (code, text) = serve(&["--listen", &daemon.endpoint]);
    assert_eq!(code, Some(1));
    assert!(text.contains(&daemon.endpoint), "{text}");
    assert!(!text.contains(".rs:"), "no places in source code: {text}");
}

#[test]
fn what_is_not_there_is_refused_and_not_ignored() {
    let (code, text) = serve(&["--state-dir", "/tmp"]);
    assert_eq!(code, Some(2));
    assert!(text.contains("journal"), "{text}");
}

#[test]
fn a_wrong_configuration_is_refused_as_a_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("daemon.toml");
    std::fs::write(&path, "daemon = \"a/b\"\n[limits]\nqueue = 0\n").unwrap();
    let (code, text) = serve(&["--config", path.to_str().unwrap(), "--listen", "nowhere"]);
    assert_eq!(code, Some(2));
    for part in ["a/b", "limits.queue", "nowhere"] {
        assert!(text.contains(part), "{part} in {text}");
    }
    std::fs::write(&path, "[limits]\nsesions = 1\n").unwrap();
    let (code, text) = serve(&["--config", path.to_str().unwrap()]);
    assert_eq!((code, text.contains("sesions")), (Some(2), true), "{text}");
}

#[test]
fn an_id_that_is_given_is_taken() {
    let daemon = Daemon::start_with("daemon = \"press-7\"");
    assert_eq!((daemon.id.as_str(), daemon.client().info().daemon.as_str()), ("press-7", "press-7"));
}

#[test]
fn a_log_in_a_file_has_no_colours_and_ready_is_said_once() {
    let mut child = overclosure()
        .args(["serve", "--listen", "tcp/127.0.0.1:0"])
        .env("OVERCLOSURE_LOG", "info")
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let mut out = std::io::BufReader::new(child.stdout.take().unwrap());
    let mut ready = String::new();
    std::io::BufRead::read_line(&mut out, &mut ready).unwrap();
    let sent = std::process::Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    let log = String::from_utf8(child.wait_with_output().unwrap().stderr).unwrap();
    assert!(ready.contains(" ready: daemon "), "{ready}");
    assert!(log.contains("stopped") && !log.contains('\u{1b}') && !log.contains(" ready"), "{log}");
}
