//! From the transport to the threads that work. Nothing here blocks: the transport's queue is always drained.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use overclosure_protocol::fault::{Fault, FaultCode};
use overclosure_protocol::key::{self, DaemonVerb, KeyError, Target};
use zenoh::handlers::FifoChannelHandler;
use zenoh::query::{Query, Queryable};

use super::Shared;
use super::registry::{Command, shutting_down};
use super::reply::{Call, Refusal};
use super::session;

/// Takes queries until the queryable is undeclared.
pub async fn run(queryable: Queryable<FifoChannelHandler<Query>>, shared: Arc<Shared>) {
    while let Ok(query) = queryable.recv_async().await {
        let routed = catch_unwind(AssertUnwindSafe(|| route(&shared, query)));
        if routed.is_err() {
            tracing::error!("a query could not be routed: a defect of this program");
        }
    }
}

fn route(shared: &Arc<Shared>, query: Query) {
    let target = match key::parse(query.key_expr().as_str()) {
        Ok(target) => target,
        Err(error) => {
            let code = match &error {
                KeyError::Wildcard { .. } => FaultCode::WildcardKey,
                KeyError::UnknownVerb { .. } => FaultCode::UnknownVerb,
            };
            return shared.desk.refuse(Refusal::new(query, Fault::new(code, error.to_string())));
        }
    };
    let key = match &target {
        Target::Daemon(verb) => key::daemon(&shared.id, *verb),
        Target::Session { session, verb } => key::session(&shared.id, session, *verb),
    };
    let call = match Call::accept(query, key) {
        Ok(call) => call,
        Err(refusal) => return shared.desk.refuse(*refusal),
    };
    if let Err(fault) = call.check_size(shared.config.limits.message_bytes) {
        return shared.desk.fail(call, fault);
    }
    match target {
        Target::Daemon(DaemonVerb::Open) if shared.registry.draining() => shared.desk.fail(call, shutting_down()),
        Target::Daemon(DaemonVerb::Open) => open(shared, call),
        Target::Daemon(verb) => shared.desk.verb(verb, call),
        Target::Session { session, verb } => {
            if let Err(refused) = shared.registry.dispatch(&session, Command::Verb(verb, call)) {
                shared.desk.fail(refused.command.into_call(), refused.fault);
            }
        }
    }
}

/// Every session has a thread, and so has every open that is still being read; their number is bounded.
fn open(shared: &Arc<Shared>, call: Call) {
    let limit = shared.config.limits.sessions as usize * 2 + OPENING_SPARE;
    // One count is the daemon's own.
    if Arc::strong_count(&shared.threads) > limit {
        let text = "too many sessions are being opened; try again later";
        return shared.desk.fail(call, Fault::new(FaultCode::Busy, text));
    }
    session::spawn(shared, call);
}

/// Opens beyond twice the number of sessions that are still read, so that a repeated open finds its session even when all are taken.
const OPENING_SPARE: usize = 8;
