//! Every message has a golden file in `vectors/` that this test and the Python tests read: its postcard bytes, its
//! JSON, and bytes that must be refused (cut short, too long, a length beyond the data).
//!
//! Bytes change only together with a version number. After such a change: `OVERCLOSURE_BLESS=1 cargo test -p overclosure-protocol`.

use std::path::PathBuf;

use overclosure_protocol::codec::{DecodeError, Format, decode, encode, from_hex, to_hex};
use overclosure_protocol::fault::{Fault, FaultCode, FaultDetails};
use overclosure_protocol::message::*;
use serde_json::{Value, json};

const LIMIT: usize = 1 << 20;

fn counts() -> Counts {
    Counts {
        increments: 20,
        equilibrium_iterations: 45,
        severe_discontinuity_iterations: 6,
        cutbacks: 1,
        factorizations: 0,
        augmentations: 9,
        impacts: 2,
    }
}

fn finding() -> Finding {
    Finding {
        severity: Severity::Error,
        line: 41,
        keyword: "*SURFACE BEHAVIOR".into(),
        message: "no surface interaction precedes it".into(),
        remedy: "write it after *SURFACE INTERACTION".into(),
    }
}

fn ports() -> Ports {
    Ports {
        inputs: vec![Port {
            name: "boundary.NTOP.3".into(),
            quantity: Quantity::Length,
            unit: Some("mm".into()),
            description: "Prescribed displacement".into(),
        }],
        outputs: vec![
            Port {
                name: "contact.SSL_SMA.CFN3".into(),
                quantity: Quantity::Force,
                unit: None,
                description: "Force on the secondary surface".into(),
            },
            Port { name: "increments".into(), quantity: Quantity::Count, unit: None, description: "Increments".into() },
        ],
    }
}

/// Calls `check` with one sample of every message that travels on its own.
fn each_sample(check: &mut dyn Check) {
    check.message(&Fault {
        code: FaultCode::DeckRefused,
        message: "the deck has 1 error".into(),
        retryable: false,
        details: FaultDetails { findings: vec![finding()], sequence_expected: Some(7), limit: None },
    });
    check.message(&Info {
        daemon: "d1".into(),
        product: "overclosure".into(),
        version: "0.1.0".into(),
        protocol: 1,
        encodings: vec!["application/postcard".into(), "application/json".into()],
        law_kinds: vec!["linear".into(), "tabular".into(), "exponential".into()],
        dialects: vec!["abaqus".into(), "calculix".into()],
        limits: Limits {
            sessions: 16,
            queue: 16,
            message_bytes: 67_108_864,
            increments_per_request: 10_000,
            law_points: 1_000_000,
            replies_kept: 16,
            threads: 8,
            idle_seconds: 3600.0,
        },
    });
    check.message(&Health {
        status: HealthStatus::Draining,
        uptime_seconds: 12.5,
        sessions_failed: 1,
        frames_dropped: 300,
    });
    check.message(&Load {
        sessions_free: 15,
        steps: 128,
        increments: 2560,
        models: 1,
        sessions: vec![SessionSummary {
            session: "1".into(),
            label: "punch".into(),
            working: true,
            waiting: 2,
            sequence_next: 129,
            time: 0.75,
            idle_seconds: 0.125,
        }],
    });
    check.message(&SchemaReply {
        messages: vec![MessageShape {
            name: "GetRequest/1".into(),
            purpose: "Request of `get`.".into(),
            fields: vec![FieldShape {
                name: "names".into(),
                kind: "Vec<String>".into(),
                meaning: "Ports to read.".into(),
            }],
        }],
    });
    check.message(&LawRequest {
        kind: "exponential".into(),
        parameters: vec![
            Parameter { name: "c0".into(), value: "0.01".into() },
            Parameter { name: "p0".into(), value: "5".into() },
        ],
        overclosure: vec![-0.005, 0.0, 0.01],
    });
    check.message(&LawReply {
        kind: "linear".into(),
        overclosure: vec![-1.0, 0.5],
        pressure: vec![0.0, 50.0],
        stiffness: vec![0.0, 100.0],
        energy: vec![0.0, 12.5],
        coefficient: vec![],
        coefficient_slope: vec![],
    });
    check.message(&OpenRequest {
        token: "5f1c".into(),
        label: "größe".into(),
        dialect: Dialect::Calculix,
        path: SolverPath::Sparse,
        threads: 2,
        ports_toml: Some("[inputs]\n".into()),
        magnitudes: vec![InputValue { name: "boundary.NTOP.3".into(), value: -0.01 }],
        deck: "*HEADING\nsmall\n".into(),
    });
    check.message(&OpenReply {
        session: "1".into(),
        sequence_next: 1,
        time: 1.0,
        time_end: 2.0,
        warnings: vec![Finding { severity: Severity::Warning, line: 0, ..finding() }],
        audit: vec!["2 secondary points never found a partner".into()],
        ports: ports(),
        outputs: vec![-464.474, 20.0],
    });
    check.message(&ports());
    check.message(&StepRequest {
        sequence: 300,
        time: 1.05,
        frames: vec!["CPRESS".into()],
        inputs: vec![InputValue { name: "boundary.NTOP.3".into(), value: -0.005 }],
        indices: vec![0, 200],
        values: vec![1e-300, f64::MAX],
    });
    check.message(&StepReply {
        sequence: 300,
        status: StepStatus::Stopped,
        reason: "point 17 chattered".into(),
        time: 1.05,
        counts: counts(),
        audit: vec!["point 17 slid beyond half a face".into()],
        outputs: vec![0.1, -0.0, f64::INFINITY],
    });
    check.message(&GetRequest { names: vec!["increments".into()] });
    check.message(&GetReply {
        sequence_next: 301,
        time: 1.05,
        time_end: 2.0,
        inputs: vec![NamedValue { name: "boundary.NTOP.3".into(), value: -0.005 }],
        outputs: vec![NamedValue { name: "increments".into(), value: 20.0 }],
    });
    check.message(&FieldRequest { name: "CPRESS".into() });
    check.message(&Field {
        name: "U".into(),
        time: 0.5,
        components: 3,
        labels: vec![1, 128, 4_000_000_000],
        values: (0..9).map(|i| f64::from(i) / 8.0).collect(),
    });
    check.message(&Checkpoint { time: 0.5, state: vec![0, 1, 127, 128, 255] });
    check.message(&RestoreRequest { sequence: 301, state: vec![0, 1, 127, 128, 255] });
    check.message(&RestoreReply { sequence: 301, time: 0.5, outputs: vec![1.0, 2.0] });
    check.message(&Report {
        session: "1".into(),
        sequence_next: 302,
        time: 0.5,
        steps: vec![StepSummary {
            name: "Step-1".into(),
            procedure: "*STATIC".into(),
            time_reached: 0.5,
            counts: counts(),
        }],
        audit: vec![],
        warnings: vec![],
    });
    check.message(&CloseReply { session: "1".into(), time: 0.5 });
    check.message(&Frame {
        number: 1,
        sequence: 300,
        step: 1,
        increment: 4,
        time: 0.2,
        field: "outputs".into(),
        components: 2,
        labels: vec![],
        values: vec![1.0, f64::NEG_INFINITY],
    });
}

/// A generic closure, in effect.
trait Check {
    fn message(&mut self, sample: &dyn Sample);
}

/// What a golden file needs of a message, whatever its type.
trait Sample {
    fn name(&self) -> String;
    fn encode(&self, format: Format) -> Vec<u8>;
    /// Decodes and compares; the error if it does not decode.
    fn decodes_to_itself(&self, bytes: &[u8], format: Format) -> Result<bool, DecodeError>;
}

impl<M: Message + PartialEq> Sample for M {
    fn name(&self) -> String {
        M::shape().name
    }

    fn encode(&self, format: Format) -> Vec<u8> {
        encode(self, format).expect("a sample encodes")
    }

    fn decodes_to_itself(&self, bytes: &[u8], format: Format) -> Result<bool, DecodeError> {
        decode::<M>(bytes, format, LIMIT).map(|m| m == *self)
    }
}

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("vectors")
}

fn golden_of(sample: &dyn Sample) -> Value {
    let bytes = sample.encode(Format::Postcard);
    let json: Value = serde_json::from_slice(&sample.encode(Format::Json)).expect("our own JSON");
    let mut oversized = bytes.clone();
    oversized.push(0);
    json!({
        "message": sample.name(),
        "json": json,
        "postcard": to_hex(&bytes),
        "truncated": to_hex(&bytes[..bytes.len() - 1]),
        "oversized": to_hex(&oversized),
    })
}

struct Golden {
    seen: Vec<String>,
}

impl Check for Golden {
    fn message(&mut self, sample: &dyn Sample) {
        let name = sample.name();
        let path = folder().join(format!("{}.json", name.replace('/', "-")));
        let expected = golden_of(sample);
        if std::env::var_os("OVERCLOSURE_BLESS").is_some() {
            let text = serde_json::to_string_pretty(&expected).expect("plain JSON");
            std::fs::write(&path, text + "\n").expect("the folder is writable");
        }
        let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let golden: Value = serde_json::from_str(&text).expect("a golden file is JSON");
        assert_eq!(golden, expected, "{name}: the bytes changed; a changed message needs a new version");

        let bytes_of = |key: &str| from_hex(golden[key].as_str().expect("a text")).expect("hexadecimal");
        assert_eq!(sample.decodes_to_itself(&bytes_of("postcard"), Format::Postcard), Ok(true), "{name}");
        let json = serde_json::to_vec(&golden["json"]).expect("plain JSON");
        assert_eq!(sample.decodes_to_itself(&json, Format::Json), Ok(true), "{name}");
        for key in ["truncated", "oversized"] {
            let outcome = sample.decodes_to_itself(&bytes_of(key), Format::Postcard);
            assert!(matches!(outcome, Err(DecodeError::Malformed { .. })), "{name}, {key}: {outcome:?}");
        }
        self.seen.push(name);
    }
}

#[test]
fn every_message_has_its_golden_bytes() {
    let mut golden = Golden { seen: Vec::new() };
    each_sample(&mut golden);
    // Messages come first in the shapes, up to `Frame`; structs inside them and enums follow.
    let shapes = shapes();
    let last = shapes.iter().position(|s| s.name == "Frame/1").expect("Frame is a message");
    let messages: Vec<&str> = shapes[..=last].iter().map(|s| s.name.as_str()).collect();
    assert_eq!(golden.seen, messages, "a message without a sample");
}

struct Damage;

impl Check for Damage {
    fn message(&mut self, sample: &dyn Sample) {
        let bytes = sample.encode(Format::Postcard);
        for cut in 0..bytes.len() {
            assert!(
                sample.decodes_to_itself(&bytes[..cut], Format::Postcard).is_err(),
                "{} cut at {cut}",
                sample.name()
            );
        }
        for at in 0..bytes.len() {
            for bit in 0..8 {
                let mut damaged = bytes.clone();
                damaged[at] ^= 1 << bit;
                // Another value or an error; never a panic.
                let _ = sample.decodes_to_itself(&damaged, Format::Postcard);
            }
        }
    }
}

#[test]
fn damaged_bytes_never_panic() {
    each_sample(&mut Damage);
}

#[test]
fn json_requests_may_leave_out_defaults_but_not_invent_fields() {
    let step: StepRequest = decode(br#"{"sequence": 1, "time": 0.5}"#, Format::Json, LIMIT).expect("defaults");
    assert_eq!(step, StepRequest { sequence: 1, time: 0.5, ..Default::default() });
    let open: OpenRequest = decode(br#"{"deck": "*HEADING"}"#, Format::Json, LIMIT).expect("defaults");
    assert_eq!(open, OpenRequest { deck: "*HEADING".into(), ..Default::default() });
    for text in [r#"{"time": 0.5}"#, r#"{"sequence": 1, "time": 0.5, "tmie": 1}"#, r#"{"sequence": -1, "time": 0.5}"#] {
        assert!(decode::<StepRequest>(text.as_bytes(), Format::Json, LIMIT).is_err(), "{text}");
    }
}

#[test]
fn the_document_holds_every_field_in_wire_order() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("PROTOCOL.md");
    let mut text = std::fs::read_to_string(&path).expect("PROTOCOL.md stands beside the crate");
    let tables = tables();
    let (begin, end) = ("<!-- shapes: begin -->\n", "<!-- shapes: end -->");
    let (from, to) = (text.find(begin).expect("begin marker") + begin.len(), text.find(end).expect("end marker"));
    if std::env::var_os("OVERCLOSURE_BLESS").is_some() {
        text.replace_range(from..to, &tables);
        std::fs::write(&path, &text).expect("PROTOCOL.md is writable");
        return;
    }
    assert_eq!(&text[from..to], tables, "PROTOCOL.md is out of date; run once with OVERCLOSURE_BLESS=1");
}

/// The reference part of PROTOCOL.md.
fn tables() -> String {
    use std::fmt::Write;
    let mut out = String::new();
    for shape in shapes() {
        let _ = writeln!(out, "\n### {}\n\n{}\n", shape.name, shape.purpose);
        let is_enum = !shape.name.contains('/');
        if is_enum {
            out.push_str("| tag | JSON | meaning |\n|---|---|---|\n");
        } else {
            out.push_str("| field | type | meaning |\n|---|---|---|\n");
        }
        for (tag, field) in shape.fields.iter().enumerate() {
            let meaning = field.meaning.replace('|', "\\|");
            let _ = match is_enum {
                true => writeln!(out, "| {tag} | `{}` | {meaning} |", field.name),
                false => writeln!(out, "| `{}` | `{}` | {meaning} |", field.name, field.kind),
            };
        }
    }
    out.push('\n');
    out
}
