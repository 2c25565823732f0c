//! Nonsense is refused with a typed fault, and the daemon lives.

use overclosure_client::{
    CallError, Fault, FaultCode, HealthStatus, InputValue, LawRequest, OpenRequest, RestoreRequest, StepRequest,
};
use overclosure_protocol::codec::{self, Format};
use overclosure_protocol::key::SessionVerb;

use crate::support::{DECK, Daemon, INPUT};

fn fault<T>(outcome: Result<T, CallError>) -> Fault {
    match outcome {
        Err(CallError::Fault(fault)) => fault,
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("accepted"),
    }
}

/// After all of a test's nonsense: well, and no session lost to a panic.
fn assert_well(daemon: &Daemon) {
    let health = daemon.client().health().unwrap();
    assert_eq!((health.status, health.sessions_failed), (HealthStatus::Ready, 0));
}

fn replaced(from: &str, to: &str) -> String {
    assert!(DECK.contains(from), "{from:?}");
    DECK.replacen(from, to, 1)
}

#[test]
fn bad_decks_are_refused_with_their_diagnostics() {
    let daemon = Daemon::start();
    let client = daemon.client();
    let binary = String::from_utf8_lossy(&(0..=255).cycle().take(5000).collect::<Vec<u8>>()).into_owned();
    let decks = [
        ("empty", String::new()),
        ("binary", binary),
        ("cut in the middle", DECK[..DECK.len() / 2].to_owned()),
        ("unknown set", replaced("*BOUNDARY\nNBOT", "*BOUNDARY\nNOWHERE")),
        ("missing material", replaced("MATERIAL=RUBBER\n*SOLID", "MATERIAL=STONE\n*SOLID")),
        (
            "a body that is loaded where nothing holds it",
            replaced("NTOP, 3, 3, -0.02", "NTOP, 3, 3, -0.02\n*CLOAD\nNTOP, 1, 5.").replacen("NTOP, 1, 2\n", "", 1),
        ),
        ("include", replaced("*STEP", "*INCLUDE, INPUT=other.inp\n*STEP")),
    ];
    for (what, deck) in decks {
        let fault = fault(client.open(OpenRequest { deck, ..Default::default() }));
        assert_eq!(fault.code, FaultCode::DeckRefused, "{what}: {fault}");
        assert!(
            fault
                .details
                .findings
                .iter()
                .any(|f| f.severity == overclosure_client::Severity::Error && !f.message.is_empty()),
            "{what}"
        );
    }
    assert_eq!(client.load().unwrap().sessions.len(), 0, "a refused deck leaves no session");
    assert_well(&daemon);
}

#[test]
fn bad_steps_are_refused_and_change_nothing() {
    let daemon = Daemon::start();
    let client = daemon.client();
    let mut session = client.open(OpenRequest { deck: DECK.into(), ..Default::default() }).unwrap();
    session.advance(0.5, &[(INPUT, -0.01)]).unwrap();
    let before = session.get(&[]).unwrap();

    let step = |time: f64, inputs: &[(&str, f64)]| StepRequest {
        time,
        inputs: inputs.iter().map(|&(name, value)| InputValue { name: name.into(), value }).collect(),
        ..Default::default()
    };
    let by_position = |indices: &[u32], values: &[f64]| StepRequest {
        indices: indices.to_vec(),
        values: values.to_vec(),
        ..step(0.75, &[])
    };
    let cases = [
        (FaultCode::NotFinite, step(0.75, &[(INPUT, f64::NAN)])),
        (FaultCode::NotFinite, step(0.75, &[(INPUT, f64::INFINITY)])),
        (FaultCode::NotFinite, step(f64::NAN, &[])),
        (FaultCode::NotFinite, by_position(&[0], &[f64::NAN])),
        (FaultCode::TimeInPast, step(0.25, &[(INPUT, -0.02)])),
        (FaultCode::UnknownPort, step(0.75, &[("boundary.NTOP.9", 0.0)])),
        (FaultCode::UnknownPort, step(0.75, &[("contact.SSL_SMA.CFN3", 0.0)])),
        (FaultCode::UnknownPort, by_position(&[1], &[0.0])),
        (FaultCode::BadRequest, by_position(&[0, 0], &[0.0, 0.0])),
        (FaultCode::BadRequest, by_position(&[0], &[])),
        (FaultCode::BadRequest, StepRequest { inputs: step(0.0, &[(INPUT, 0.0)]).inputs, ..by_position(&[0], &[0.0]) }),
        (FaultCode::UnknownField, StepRequest { frames: vec!["NONSENSE".into()], ..step(0.75, &[]) }),
    ];
    for (code, request) in cases {
        let fault = fault(session.step(request.clone()));
        assert_eq!(fault.code, code, "{request:?}: {fault}");
        assert!(!fault.retryable);
    }
    assert_eq!(fault(session.restore(b"not a checkpoint")).code, FaultCode::CheckpointRefused);
    let mut damaged = session.checkpoint().unwrap().state;
    let middle = damaged.len() / 2;
    damaged[middle] ^= 1;
    assert_eq!(fault(session.restore(&damaged)).code, FaultCode::CheckpointRefused);
    assert_eq!(fault(session.field("NONSENSE")).code, FaultCode::UnknownField);
    assert_eq!(fault(session.get(&["nothing"])).code, FaultCode::UnknownPort);

    assert_eq!(session.get(&[]).unwrap(), before, "time, inputs, outputs and sequence number are as they were");
    session.advance(0.75, &[(INPUT, -0.015)]).unwrap();
    assert_well(&daemon);
}

#[test]
fn unknown_sessions_and_ambiguous_keys_are_refused() {
    let daemon = Daemon::start();
    let raw = daemon.raw();
    let id = &daemon.id;
    let session = daemon.client().open(OpenRequest { deck: DECK.into(), ..Default::default() }).unwrap();
    for unknown in ["7", "zzzz-1", "a b", &format!("{}x", session.id())] {
        let selector = format!("overclosure/v1/{id}/s/{unknown}/ports");
        assert_eq!(raw.fault(&selector, None, None).code, FaultCode::UnknownSession, "{selector}");
    }
    for wild in [
        "overclosure/v1/*/s/*/step",
        "overclosure/v1/*/open",
        "overclosure/**",
        &format!("overclosure/v1/{id}/s/*/close"),
    ] {
        assert_eq!(raw.fault(wild, None, None).code, FaultCode::WildcardKey, "{wild}");
    }
    for verb in [format!("overclosure/v1/{id}/fly"), format!("overclosure/v1/{id}/s/{}/fly", session.id())] {
        assert_eq!(raw.fault(&verb, None, None).code, FaultCode::UnknownVerb, "{verb}");
    }
    session.get(&[]).unwrap();
    assert_well(&daemon);
}

#[test]
fn encodings_and_bytes_that_do_not_fit_are_refused() {
    let daemon = Daemon::start();
    let raw = daemon.raw();
    let session = daemon.client().open(OpenRequest { deck: DECK.into(), ..Default::default() }).unwrap();
    let step = raw.key(session.id(), SessionVerb::Step);
    let good = codec::encode(&StepRequest { sequence: 1, time: 0.5, ..Default::default() }, Format::Postcard).unwrap();
    let mut long = good.clone();
    long.push(0);
    let postcard = "application/postcard;StepRequest/1";
    let cases: [(FaultCode, &str, Option<&str>, &[u8]); 9] = [
        (FaultCode::UnsupportedEncoding, &step, Some("application/cbor"), &good),
        (FaultCode::UnsupportedEncoding, &step, Some("application/postcard;StepRequest/2"), &good),
        (FaultCode::UnsupportedEncoding, &step, Some("application/postcard;GetRequest/1"), &good),
        (FaultCode::BadRequest, &step, Some(postcard), &good[..good.len() - 1]),
        (FaultCode::BadRequest, &step, Some(postcard), &long),
        (FaultCode::BadRequest, &step, Some(postcard), &[0xff; 40]),
        (FaultCode::BadRequest, &step, None, b"{\"sequence\": 1}"),
        (FaultCode::BadRequest, &step, None, b"\xff\xfe"),
        (FaultCode::BadRequest, "overclosure/v1/*/info", None, b"hello"),
    ];
    for (code, selector, encoding, payload) in cases {
        let fault = raw.fault(selector, encoding, Some(payload));
        assert_eq!(fault.code, code, "{encoding:?} {payload:?}: {fault}");
    }
    assert_eq!(raw.fault(&format!("{step}?sequence=1;time=soon"), None, None).code, FaultCode::BadRequest);
    assert_eq!(session.get(&[]).unwrap().sequence_next, 1, "nothing was done");
    assert_well(&daemon);
}

#[test]
fn oversize_requests_are_refused_by_the_daemon_and_before_that_by_the_client() {
    let daemon = Daemon::start_with("[limits]\nmessage_bytes = 65536\nlaw_points = 100");
    let raw = daemon.raw();
    let big = vec![b' '; 100_000];
    let refused = raw.fault(&format!("overclosure/v1/{}/open", daemon.id), None, Some(&big));
    assert_eq!((refused.code, refused.details.limit), (FaultCode::TooLarge, Some(65536)));

    let client = daemon.client();
    let deck = String::from_utf8(big).unwrap();
    assert_eq!(fault(client.open(OpenRequest { deck, ..Default::default() })).code, FaultCode::TooLarge);
    let many = LawRequest { kind: "linear".into(), overclosure: vec![0.0; 101], ..Default::default() };
    assert_eq!(fault(client.law(&many)).code, FaultCode::LimitExceeded);
    let threads = OpenRequest { deck: DECK.into(), threads: 5000, ..Default::default() };
    assert_eq!(fault(client.open(threads)).code, FaultCode::LimitExceeded);
    assert_well(&daemon);
}

#[test]
fn bad_laws_are_refused_with_the_reason() {
    let daemon = Daemon::start();
    let client = daemon.client();
    let law = |kind: &str, overclosure: Vec<f64>| {
        client.law(&LawRequest { kind: kind.into(), overclosure, ..Default::default() })
    };
    assert_eq!(fault(law("sticky", vec![0.0])).code, FaultCode::LawRefused);
    let missing = fault(law("linear", vec![0.0]));
    assert_eq!(missing.code, FaultCode::LawRefused);
    assert!(missing.message.contains("stiffness"), "{missing}");
    assert_eq!(fault(law("linear", vec![f64::NAN])).code, FaultCode::NotFinite);
    assert_well(&daemon);
}

#[test]
fn a_state_of_another_deck_is_refused() {
    let daemon = Daemon::start();
    let client = daemon.client();
    let mut session = client.open(OpenRequest { deck: DECK.into(), ..Default::default() }).unwrap();
    let other = client.open(OpenRequest { deck: replaced("1000., 0.3", "2000., 0.3"), ..Default::default() }).unwrap();
    let state = other.checkpoint().unwrap().state;
    let request = RestoreRequest { sequence: 1, state: state.clone() };
    assert_eq!(fault(session.restore(&request.state)).code, FaultCode::CheckpointRefused);
    assert_eq!(session.sequence_next(), 1);
    session.advance(0.5, &[]).unwrap();
}
