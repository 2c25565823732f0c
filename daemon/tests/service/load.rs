//! Full queues, slow work, and the end of a daemon that is busy.

use std::time::{Duration, Instant};

use overclosure_client::{CallError, FaultCode, OpenRequest, Options, StepRequest, StepStatus};
use overclosure_protocol::codec::{self, Format};
use overclosure_protocol::key::SessionVerb;
use overclosure_protocol::message::StepReply;

use crate::support::{DECK, Daemon};

/// Increments of a ten-millionth of the step, as many as wanted: work that does not end by itself.
fn endless_deck() -> String {
    DECK.replacen("*STEP\n*STATIC\n0.25, 1.", "*STEP, INC=2000000000\n*STATIC, DIRECT\n1e-7, 1.", 1)
}

/// Until a condition holds; a minute at most.
fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let deadline = Instant::now() + Duration::from_secs(60);
    while !holds() {
        assert!(Instant::now() < deadline, "{what} does not come");
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn a_full_queue_is_busy_others_go_on_and_sigterm_ends_all_within_bounds() {
    let mut daemon = Daemon::start_with(
        "[limits]\nqueue = 1\nincrements_per_request = 4000000000\n[shutdown]\ndrain_seconds = 20.0",
    );
    let client = daemon.client();
    let session = client.open(OpenRequest { deck: endless_deck(), ..Default::default() }).unwrap();
    let id = session.id().to_owned();
    let summary = || client.load().unwrap().sessions.into_iter().find(|s| s.session == id).unwrap();

    std::thread::scope(|scope| {
        let endless = scope.spawn(|| {
            daemon.raw().post(&id, SessionVerb::Step, &StepRequest { sequence: 1, time: 1.0, ..Default::default() })
        });
        until("work", || summary().working);
        let waiting = scope.spawn(|| daemon.raw().query(&daemon.raw().key(&id, SessionVerb::Ports), None, None));
        until("a full queue", || summary().waiting == 1);

        match session.get(&[]) {
            Err(CallError::Fault(fault)) => {
                assert_eq!((fault.code, fault.retryable, fault.details.limit), (FaultCode::Busy, true, Some(1)));
            }
            other => panic!("{other:?}"),
        }
        // Neither the daemon nor another session waits for the busy one.
        let begin = Instant::now();
        client.health().unwrap();
        let other = client.open(OpenRequest { deck: DECK.into(), ..Default::default() }).unwrap();
        other.close().unwrap();
        assert!(begin.elapsed() < Duration::from_secs(5));

        daemon.terminate();
        let (bytes, _) = endless.join().unwrap().expect("a reply, not a fault");
        let reply: StepReply = codec::decode(&bytes, Format::Postcard, 1 << 20).unwrap();
        assert_eq!(reply.status, StepStatus::Cancelled);
        assert!(reply.time > 0.0 && reply.time < 1.0, "the state of the last completed increment");
        let refused = waiting.join().unwrap().expect("a reply");
        assert!(refused.is_err(), "what waited is refused");
    });
    assert!(daemon.wait().success());
}

#[test]
fn a_request_takes_a_limited_number_of_increments() {
    let daemon = Daemon::start_with("[limits]\nincrements_per_request = 3");
    let client = daemon.client();
    let deck = DECK.replacen("0.25, 1.", "0.1, 1., , 0.1", 1);
    let mut session = client.open(OpenRequest { deck, ..Default::default() }).unwrap();
    let first = session.advance(1.0, &[]).unwrap();
    assert_eq!((first.status, first.counts.increments), (StepStatus::IncrementLimit, 3));
    assert!((first.time - 0.3).abs() < 1e-12);
    let mut reply = first;
    while reply.status == StepStatus::IncrementLimit {
        reply = session.advance(1.0, &[]).unwrap();
    }
    assert_eq!((reply.status, reply.time), (StepStatus::Reached, 1.0));
}

#[test]
fn a_killed_daemon_is_unavailable_at_once() {
    let mut daemon = Daemon::start();
    let client = overclosure_client::blocking::Client::connect(Options { attempts: 2, ..daemon.options() }).unwrap();
    let mut session = client.open(OpenRequest { deck: DECK.into(), ..Default::default() }).unwrap();
    daemon.child.kill().unwrap();
    daemon.child.wait().unwrap();
    let begin = Instant::now();
    match session.advance(0.5, &[]) {
        Err(CallError::Unavailable { .. }) => {}
        other => panic!("{other:?}"),
    }
    assert!(begin.elapsed() < Duration::from_secs(10), "long before the timeout");
}

#[test]
fn a_session_whose_client_died_is_closed_and_one_that_is_used_or_works_is_not() {
    let daemon = Daemon::start_with("[limits]\nidle_seconds = 0.5\nincrements_per_request = 4000000000");
    let client = daemon.client();
    assert_eq!(client.info().limits.idle_seconds, 0.5);
    let open = |deck: String| client.open(OpenRequest { deck, ..Default::default() }).unwrap();
    let (used, watched) = (open(DECK.into()), open(DECK.into()));
    let frames = watched.frames().unwrap();
    let abandoned = {
        // A client that goes away without closing anything.
        let dying = daemon.client();
        dying.open(OpenRequest { deck: DECK.into(), ..Default::default() }).unwrap().id().to_owned()
    };
    let busy = open(endless_deck()).id().to_owned();
    std::thread::scope(|scope| {
        let endless = scope.spawn(|| {
            daemon.raw().post(&busy, SessionVerb::Step, &StepRequest { sequence: 1, time: 1.0, ..Default::default() })
        });
        let begin = Instant::now();
        let mut gone = false;
        // Four times the limit, with a request to one of them far more often than that.
        while begin.elapsed() < Duration::from_secs(2) || !gone {
            assert!(begin.elapsed() < Duration::from_secs(60), "the idle sessions stay");
            used.get(&[]).expect("a session that is used stays");
            let load = client.load().unwrap();
            let ids: Vec<&str> = load.sessions.iter().map(|s| s.session.as_str()).collect();
            gone = !ids.contains(&abandoned.as_str()) && !ids.contains(&watched.id());
            assert!(ids.contains(&busy.as_str()), "a running step is not idle");
            std::thread::sleep(Duration::from_millis(20));
        }
        assert_eq!(frames.count(), 0, "who only watches learns of the end");
        assert_eq!(client.load().unwrap().sessions_free, 14);
        match watched.get(&[]) {
            Err(CallError::Fault(fault)) => {
                assert_eq!(fault.code, FaultCode::UnknownSession);
                assert!(fault.message.contains("idle"), "{fault}");
            }
            other => panic!("{other:?}"),
        }
        daemon.terminate();
        assert!(endless.join().unwrap().is_ok());
    });
}

#[test]
fn without_an_idle_limit_sessions_stay() {
    let daemon = Daemon::start_with("[limits]\nidle_seconds = 0.0");
    let client = daemon.client();
    let session = client.open(OpenRequest { deck: DECK.into(), ..Default::default() }).unwrap();
    std::thread::sleep(Duration::from_millis(300));
    let load = client.load().unwrap();
    assert!(load.sessions[0].idle_seconds >= 0.25, "{load:?}");
    session.close().unwrap();
}
