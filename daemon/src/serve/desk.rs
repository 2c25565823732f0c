//! Verbs of the daemon itself, answered by two threads of their own so that neither the dispatcher nor each other waits:
//! one for short answers and refusals, one for laws.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};

use overclosure::law::{self, LawPoint, Relationship};
use overclosure_protocol::PROTOCOL_VERSION;
use overclosure_protocol::arguments;
use overclosure_protocol::codec::Format;
use overclosure_protocol::fault::{Fault, FaultCode};
use overclosure_protocol::key::DaemonVerb;
use overclosure_protocol::message::{
    Dialect, Health, HealthStatus, Info, LawReply, LawRequest, Limits, Load, SchemaReply, shapes,
};

use super::Shared;
use super::reply::{Call, Refusal};
use super::session::guarded;

/// Requests that may wait for each thread.
const WAITING: usize = 256;

/// A short answer.
enum Short {
    Verb(DaemonVerb, Call),
    Refuse(Refusal),
    Fail(Call, Fault),
}

/// The way to both threads.
pub struct Desk {
    short: SyncSender<Short>,
    law: SyncSender<Call>,
    /// Queries that got no answer, since the start.
    dropped: AtomicU64,
}

impl Desk {
    /// The sending and the receiving ends.
    pub fn new() -> (Self, DeskThreads) {
        let (short, short_receiver) = sync_channel(WAITING);
        let (law, law_receiver) = sync_channel(WAITING);
        (Self { short, law, dropped: AtomicU64::new(0) }, DeskThreads { short: short_receiver, law: law_receiver })
    }

    /// Hands over a verb of the daemon other than `open`. Never blocks.
    pub fn verb(&self, verb: DaemonVerb, call: Call) {
        if verb != DaemonVerb::Law {
            return self.give(Short::Verb(verb, call));
        }
        match self.law.try_send(call) {
            Ok(()) => {}
            Err(TrySendError::Full(call)) => {
                self.fail(
                    call,
                    Fault::new(FaultCode::Busy, format!("{WAITING} law requests are waiting; try again later")),
                );
            }
            Err(TrySendError::Disconnected(_)) => tracing::error!("the law thread is gone"),
        }
    }

    /// Hands over a fault to be sent. Never blocks.
    pub fn fail(&self, call: Call, fault: Fault) {
        self.give(Short::Fail(call, fault));
    }

    /// Hands over a refusal to be sent. Never blocks.
    pub fn refuse(&self, refusal: Refusal) {
        self.give(Short::Refuse(refusal));
    }

    fn give(&self, short: Short) {
        // When even refusals pile up, dropping the query tells the client "zero replies", upon which it tries again.
        if let Err(TrySendError::Full(_)) = self.short.try_send(short) {
            let dropped = self.dropped.fetch_add(1, Ordering::Relaxed) + 1;
            // At 1, 2, 4, 8, ...: a flood of queries must not become a flood of lines.
            if dropped.is_power_of_two() {
                tracing::warn!(dropped, "overloaded: queries were dropped without an answer");
            }
        }
    }
}

/// The receiving ends, to be started once the shared state exists.
pub struct DeskThreads {
    short: Receiver<Short>,
    law: Receiver<Call>,
}

impl DeskThreads {
    /// Starts both threads; they end when the [`Desk`] is dropped.
    pub fn spawn(self, shared: &Arc<Shared>) -> std::io::Result<()> {
        let Self { short, law } = self;
        let bytes_max = shared.config.limits.message_bytes;
        let points_max = shared.config.limits.law_points;
        // Not an owner of the desk, or the threads would never end.
        let weak = Arc::downgrade(shared);
        std::thread::Builder::new().name("desk".to_owned()).spawn(move || {
            while let Ok(request) = short.recv() {
                let Some(shared) = weak.upgrade() else { break };
                // A panic here would be a defect of ours; it costs this one reply.
                let _ = guarded(|| answer(&shared, request));
            }
        })?;
        std::thread::Builder::new().name("law".to_owned()).spawn(move || {
            while let Ok(call) = law.recv() {
                let outcome = guarded(|| {
                    evaluate(&call.request(bytes_max, |p| arguments::law(p, points_max as usize))?, points_max)
                });
                call.answer(outcome.unwrap_or_else(Err));
            }
        })?;
        Ok(())
    }
}

fn answer(shared: &Shared, request: Short) {
    match request {
        Short::Refuse(refusal) => refusal.send(),
        Short::Fail(call, fault) => call.fail(&fault),
        Short::Verb(verb, call) => match call.no_request(verb.name()) {
            Err(fault) => call.fail(&fault),
            Ok(()) => match verb {
                DaemonVerb::Info => call.answer(Ok(info(&shared.id, shared.config.limits.to_message()))),
                DaemonVerb::Health => call.answer(Ok(health(shared))),
                DaemonVerb::Load => call.answer(Ok(load(shared))),
                DaemonVerb::Schema => call.answer(Ok(SchemaReply { messages: shapes() })),
                // These two never come here.
                DaemonVerb::Law | DaemonVerb::Open => call.fail(&Fault::new(FaultCode::Internal, "misrouted request")),
            },
        },
    }
}

fn info(daemon: &str, limits: Limits) -> Info {
    Info {
        daemon: daemon.to_owned(),
        product: "overclosure".to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        protocol: PROTOCOL_VERSION,
        encodings: Format::ALL.iter().map(|f| f.media_type().to_owned()).collect(),
        law_kinds: law::KINDS.iter().map(|&k| k.to_owned()).collect(),
        dialects: Dialect::ALL.iter().map(ToString::to_string).collect(),
        limits,
    }
}

fn health(shared: &Shared) -> Health {
    Health {
        status: if shared.registry.draining() { HealthStatus::Draining } else { HealthStatus::Ready },
        uptime_seconds: shared.started.elapsed().as_secs_f64(),
        sessions_failed: shared.sessions_failed.load(Ordering::Relaxed),
        frames_dropped: shared.frames.dropped(),
    }
}

fn load(shared: &Shared) -> Load {
    Load {
        sessions_free: shared.registry.free(),
        steps: shared.steps.load(Ordering::Relaxed),
        increments: shared.increments.load(Ordering::Relaxed),
        models: u32::try_from(shared.models.count()).unwrap_or(u32::MAX),
        sessions: shared.registry.summaries(),
    }
}

fn evaluate(request: &LawRequest, points_max: u32) -> Result<LawReply, Fault> {
    let overclosure = &request.overclosure;
    if overclosure.len() > points_max as usize {
        let text = format!("{} overclosures are more than the {points_max} allowed in one request", overclosure.len());
        let mut fault = Fault::new(FaultCode::LimitExceeded, text);
        fault.details.limit = Some(points_max.into());
        return Err(fault);
    }
    if let Some(bad) = overclosure.iter().find(|h| !h.is_finite()) {
        return Err(Fault::new(FaultCode::NotFinite, format!("overclosure {bad} is not a finite number")));
    }
    let pairs: Vec<(&str, &str)> = request.parameters.iter().map(|p| (p.name.as_str(), p.value.as_str())).collect();
    let refused = |errors: law::LawSpecErrors| Fault::new(FaultCode::LawRefused, errors.to_string());
    let mut reply = LawReply { kind: request.kind.clone(), overclosure: overclosure.clone(), ..LawReply::default() };
    match law::read(&request.kind, &pairs).map_err(refused)? {
        Relationship::Pressure(spec) => {
            let law = spec.resolve().map_err(refused)?;
            let mut points = vec![LawPoint::default(); overclosure.len()];
            law.evaluate_into(overclosure, &mut points);
            reply.pressure = points.iter().map(|p| p.pressure).collect();
            reply.stiffness = points.iter().map(|p| p.stiffness).collect();
            reply.energy = points.iter().map(|p| p.energy).collect();
        }
        Relationship::Damping(spec) => {
            let damping = spec.resolve().map_err(refused)?;
            (reply.coefficient, reply.coefficient_slope) = overclosure.iter().map(|&h| damping.at(h)).unzip();
        }
    }
    Ok(reply)
}

#[cfg(test)]
mod tests {
    use super::*;
    use overclosure::law::LawSpecError;
    use overclosure_protocol::message::Parameter;

    #[test]
    fn every_kind_announced_is_known() {
        for kind in law::KINDS {
            let errors = law::read::<&str, &str>(kind, &[]).expect_err("parameters are missing");
            assert!(!errors.0.iter().any(|e| matches!(e, LawSpecError::UnknownKind { .. })), "{kind}");
        }
    }

    #[test]
    fn a_law_is_evaluated_or_refused_with_the_reason() {
        let mut request = LawRequest {
            kind: "linear".into(),
            parameters: vec![Parameter { name: "stiffness".into(), value: "100".into() }],
            overclosure: vec![-1.0, 0.5],
        };
        let reply = evaluate(&request, 10).expect("a good law");
        assert_eq!(
            (reply.pressure, reply.stiffness, reply.energy),
            (vec![0.0, 50.0], vec![0.0, 100.0], vec![0.0, 12.5])
        );
        assert_eq!(evaluate(&request, 1).expect_err("too many").code, FaultCode::LimitExceeded);
        request.overclosure[0] = f64::NAN;
        assert_eq!(evaluate(&request, 10).expect_err("NaN").code, FaultCode::NotFinite);
        request.overclosure[0] = 0.0;
        request.kind = "hard".into();
        assert_eq!(evaluate(&request, 10).expect_err("no curve").code, FaultCode::LawRefused);
    }

    #[test]
    fn damping_answers_with_its_coefficient_alone() {
        let parameter = |name: &str, value: &str| Parameter { name: name.into(), value: value.into() };
        let request = LawRequest {
            kind: "damping".into(),
            parameters: vec![parameter("mu0", "8"), parameter("c0", "0.5"), parameter("eta", "0.5")],
            overclosure: vec![0.1, -0.375, -1.0],
        };
        let reply = evaluate(&request, 10).expect("a good damping");
        assert_eq!((reply.coefficient, reply.coefficient_slope), (vec![8.0, 4.0, 0.0], vec![0.0, 32.0, 0.0]));
        assert!(reply.pressure.is_empty() && reply.stiffness.is_empty() && reply.energy.is_empty());
    }
}
