//! What a session does for its client.

use overclosure_client::{
    CallError, FaultCode, InputValue, LawRequest, OpenRequest, Parameter, StepRequest, StepStatus,
};
use overclosure_protocol::codec::{self, Format};
use overclosure_protocol::key::SessionVerb;
use overclosure_protocol::message::{OpenReply, StepReply};

use crate::support::{DECK, Daemon, INPUT};

fn request() -> OpenRequest {
    OpenRequest { deck: DECK.into(), label: "two blocks".into(), ..Default::default() }
}

/// Bits, so that -0.0 and 0.0 differ.
fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|v| v.to_bits()).collect()
}

#[test]
fn a_session_opens_steps_reads_goes_back_and_closes() {
    let daemon = Daemon::start();
    let client = daemon.client();
    assert_eq!(client.info().daemon, daemon.id);

    let mut session = client.open(request()).unwrap();
    assert_eq!(session.opened().time, 0.0);
    assert_eq!(session.opened().time_end, 1.0);
    assert_eq!(session.opened().outputs.len(), session.ports().outputs.len());
    assert_eq!(session.ports().inputs.iter().map(|p| p.name.as_str()).collect::<Vec<_>>(), [INPUT]);
    let force = session.ports().outputs.iter().position(|p| p.name == "contact.SSL_SMA.CFN3").unwrap();

    let before = session.checkpoint().unwrap();
    let mut replies = Vec::new();
    for i in 1..=4 {
        let reply = session.advance(f64::from(i) / 4.0, &[(INPUT, -0.005 * f64::from(i))]).unwrap();
        assert_eq!((reply.status, reply.time, reply.sequence), (StepStatus::Reached, f64::from(i) / 4.0, i as u64));
        assert!(reply.counts.increments >= 1);
        replies.push(reply);
    }
    assert!(replies[3].outputs[force] > replies[0].outputs[force], "pushed together, the contact force grows");

    let now = session.get(&[INPUT, "contact.SSL_SMA.CFN3"]).unwrap();
    assert_eq!(now.inputs[0].value, -0.02);
    assert_eq!(now.outputs[0].value.to_bits(), replies[3].outputs[force].to_bits());
    let field = session.field("CPRESS").unwrap();
    assert_eq!((field.components, field.labels.len(), field.values.len()), (1, 4, 4));
    assert!(field.values.iter().all(|p| *p > 0.0));
    let report = session.report().unwrap();
    assert_eq!(report.steps.len(), 1);
    assert!(report.steps[0].counts.increments >= 4);
    assert_eq!(report.sequence_next, 5);

    // Back, with the number going on; then the same again, by position, bit for bit.
    let restored = session.restore(&before.state).unwrap();
    assert_eq!((restored.time, restored.sequence), (0.0, 5));
    for (i, first) in (1..=4).zip(&replies) {
        let step = StepRequest {
            time: f64::from(i) / 4.0,
            indices: vec![0],
            values: vec![-0.005 * f64::from(i)],
            ..Default::default()
        };
        let again = session.step(step).unwrap();
        assert_eq!(bits(&again.outputs), bits(&first.outputs));
        assert_eq!(again.counts, first.counts);
    }

    let id = session.id().to_owned();
    let closed = session.close().unwrap();
    assert_eq!((closed.session.as_str(), closed.time), (id.as_str(), 1.0));
    match client.attach(&id).err() {
        Some(CallError::Fault(fault)) => assert_eq!(fault.code, FaultCode::UnknownSession),
        other => panic!("{other:?}"),
    }
}

#[test]
fn sessions_of_one_deck_share_its_model_and_nothing_else() {
    let daemon = Daemon::start();
    let client = daemon.client();
    let mut first = client.open(request()).unwrap();
    let mut second = client.open(request()).unwrap();
    let other = client.open(OpenRequest { dialect: overclosure_client::Dialect::Calculix, ..request() }).unwrap();
    assert_eq!(client.load().unwrap().models, 2);

    let a = first.advance(0.5, &[(INPUT, -0.01)]).unwrap();
    assert_eq!(second.get(&[]).unwrap().time, 0.0, "the other session stays where it is");
    let b = second.advance(0.5, &[(INPUT, -0.01)]).unwrap();
    assert_eq!(bits(&a.outputs), bits(&b.outputs));
    // A state of one continues in the other.
    let state = first.checkpoint().unwrap().state;
    second.advance(1.0, &[]).unwrap();
    second.restore(&state).unwrap();
    assert_eq!(
        bits(&first.advance(0.75, &[(INPUT, -0.02)]).unwrap().outputs),
        bits(&second.advance(0.75, &[(INPUT, -0.02)]).unwrap().outputs)
    );

    for session in [first, second, other] {
        session.close().unwrap();
    }
    let load = client.load().unwrap();
    assert_eq!((load.models, load.sessions.len(), load.steps), (0, 0, 5));
}

#[test]
fn a_repeated_request_is_answered_from_memory() {
    let daemon = Daemon::start_with("[limits]\nreplies_kept = 2");
    let client = daemon.client();
    let raw = daemon.raw();
    let session = client.open(request()).unwrap();
    let id = session.id();
    let step = |sequence: u64| StepRequest {
        sequence,
        time: 0.25 * sequence as f64,
        inputs: vec![InputValue { name: INPUT.into(), value: -0.005 * sequence as f64 }],
        ..Default::default()
    };
    let first = raw.step(id, &step(1));
    assert_eq!(raw.step(id, &step(1)), first, "the same bytes");
    assert_eq!(client.load().unwrap().steps, 1, "and no second step");

    // The same request as JSON is the same request.
    let json = codec::encode(&step(1), Format::Json).unwrap();
    let selector = raw.key(id, SessionVerb::Step);
    let (bytes, _) = raw.query(&selector, Some("application/json"), Some(&json)).unwrap().unwrap();
    let from_json: StepReply = codec::decode(&bytes, Format::Json, 1 << 20).unwrap();
    assert_eq!(from_json, codec::decode(&first, Format::Postcard, 1 << 20).unwrap());

    let gap = raw.step_fault(id, &step(3));
    assert_eq!((gap.code, gap.details.sequence_expected), (FaultCode::SequenceGap, Some(2)));
    let conflict = raw.step_fault(id, &StepRequest { sequence: 1, time: 0.9, ..Default::default() });
    assert_eq!(conflict.code, FaultCode::SequenceConflict);
    for sequence in 2..=3 {
        raw.step(id, &step(sequence));
    }
    assert_eq!(raw.step_fault(id, &step(1)).code, FaultCode::SequenceExpired);
    assert_eq!(client.load().unwrap().steps, 3);
}

#[test]
fn a_repeated_open_gives_the_same_session() {
    let daemon = Daemon::start_with("[limits]\nsessions = 1");
    let raw = daemon.raw();
    let bytes = codec::encode(&OpenRequest { token: "mine".into(), ..request() }, Format::Postcard).unwrap();
    let open = |bytes: &[u8]| {
        let selector = format!("overclosure/v1/{}/open", daemon.id);
        raw.query(&selector, Some("application/postcard;OpenRequest/1"), Some(bytes)).unwrap()
    };
    let reply = |answer: crate::support::Answer| {
        codec::decode::<OpenReply>(&answer.unwrap().0, Format::Postcard, 1 << 20).unwrap()
    };
    let first = reply(open(&bytes));
    assert_eq!(reply(open(&bytes)), first);
    let other = codec::encode(&OpenRequest { token: "yours".into(), ..request() }, Format::Postcard).unwrap();
    let (fault, _) = open(&other).unwrap_err();
    let fault: overclosure_client::Fault = codec::decode(&fault, Format::Postcard, 1 << 20).unwrap();
    assert_eq!((fault.code, fault.details.limit), (FaultCode::LimitExceeded, Some(1)));
}

#[test]
fn every_increment_is_published_and_the_stream_ends_with_the_session() {
    let daemon = Daemon::start();
    let client = daemon.client();
    let mut session = client.open(request()).unwrap();
    let outputs = session.frames().unwrap();
    let mut fields = session.frames_of("CPRESS").unwrap();
    let mut last = Vec::new();
    for i in 1..=4 {
        let step = StepRequest { time: f64::from(i) / 4.0, frames: vec!["CPRESS".into()], ..Default::default() };
        last = session.step(step).unwrap().outputs;
    }
    let increments = session.report().unwrap().steps[0].counts.increments;
    let field = session.field("CPRESS").unwrap();
    session.close().unwrap();

    let frames: Vec<_> = outputs.map(|f| f.unwrap()).collect();
    assert_eq!(frames.iter().map(|f| f.number).collect::<Vec<_>>(), (1..=u64::from(increments)).collect::<Vec<_>>());
    assert!(frames.windows(2).all(|w| w[0].time < w[1].time));
    assert_eq!(bits(&frames.last().unwrap().values), bits(&last));
    let published = (&mut fields).take(increments as usize).last().unwrap().unwrap();
    assert_eq!((published.field.as_str(), published.time, &published.labels), ("CPRESS", 1.0, &field.labels));
    assert_eq!(bits(&published.values), bits(&field.values));
}

#[test]
fn a_preload_is_run_at_open_and_magnitudes_are_replaced() {
    let daemon = Daemon::start();
    let client = daemon.client();
    // The step of the deck once more: the first becomes the preload.
    let at = DECK.find("*STEP").unwrap();
    let deck = format!("{}{}", DECK, &DECK[at..]);
    let session = client.open(OpenRequest { deck, ..request() }).unwrap();
    assert_eq!((session.opened().time, session.opened().time_end), (1.0, 2.0));
    assert!(session.field("CPRESS").unwrap().values.iter().all(|p| *p > 0.0), "pressed by the preload");

    let magnitudes = vec![InputValue { name: INPUT.into(), value: -0.04 }];
    let mut doubled = client.open(OpenRequest { magnitudes, ..request() }).unwrap();
    doubled.advance(0.5, &[]).unwrap();
    assert_eq!(
        doubled.get(&[INPUT]).unwrap().inputs[0].value,
        -0.02,
        "the amplitude of the deck, the magnitude of the request"
    );
}

#[test]
fn stock_tools_get_json_and_pass_arguments_in_the_selector() {
    let daemon = Daemon::start();
    let raw = daemon.raw();
    assert_eq!(raw.json("overclosure/v1/*/info")["daemon"], daemon.id.as_str());
    assert_eq!(raw.json("overclosure/v1/*/health")["status"], "ready");
    let law = raw.json("overclosure/v1/*/law?kind=exponential;c0=0.01;p0=5;at=-0.005,0,0.01");
    assert_eq!(law["pressure"][1], 5.0, "p0 at zero clearance");
    assert_eq!(law["overclosure"].as_array().unwrap().len(), 3);
    assert!(raw.json("overclosure/v1/*/schema")["messages"].as_array().unwrap().len() > 30);

    let session = daemon.client().open(request()).unwrap();
    let key = |verb| raw.key(session.id(), verb);
    let step = raw.json(&format!("{}?sequence=1;time=0.25;{INPUT}=-0.005", key(SessionVerb::Step)));
    assert_eq!((&step["status"], &step["time"]), (&"reached".into(), &0.25.into()));
    let get = raw.json(&format!("{}?names={INPUT}", key(SessionVerb::Get)));
    assert_eq!(get["inputs"][0]["value"], -0.005);
    assert_eq!(raw.json(&format!("{}?name=CPRESS", key(SessionVerb::Field)))["labels"].as_array().unwrap().len(), 4);
    assert_eq!(raw.json(&key(SessionVerb::Ports))["inputs"][0]["name"], INPUT);
}

#[test]
fn a_law_batch_agrees_with_its_formula() {
    let daemon = Daemon::start();
    let overclosure: Vec<f64> = (-500..500).map(|i| f64::from(i) / 100.0).collect();
    let parameters = vec![Parameter { name: "stiffness".into(), value: "3.5".into() }];
    let reply = daemon
        .client()
        .law(&LawRequest { kind: "linear".into(), parameters, overclosure: overclosure.clone() })
        .unwrap();
    let expected: Vec<f64> = overclosure.iter().map(|h| 3.5 * h.max(0.0)).collect();
    assert_eq!(reply.pressure, expected);
}
