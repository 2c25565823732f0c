//! The thread of one session: opens it, then works on its queue until it is closed.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::Ordering;

use overclosure_protocol::arguments;
use overclosure_protocol::fault::{Fault, FaultCode};
use overclosure_protocol::key::SessionVerb;
use overclosure_protocol::message::{OpenRequest, Severity};

use super::Shared;
use super::convert;
use super::registry::{Command, Opening, Registered, shutting_down, unknown_session};
use super::reply::Call;
use super::work::{Surroundings, Work, fingerprint};

/// Stack of a session thread; factorisations of large models recurse.
const STACK_BYTES: usize = 16 << 20;

/// Starts the thread that opens a session. When the system gives no thread the query is dropped: its client sees that nobody
/// answers and tries again.
pub fn spawn(shared: &Arc<Shared>, call: Call) {
    let shared = shared.clone();
    let thread = std::thread::Builder::new().name("session".to_owned()).stack_size(STACK_BYTES).spawn(move || {
        let _alive = shared.threads.clone();
        open(&shared, call);
    });
    if let Err(error) = thread {
        tracing::error!(%error, "no thread for another session");
    }
}

fn open(shared: &Arc<Shared>, call: Call) {
    let limits = shared.config.limits.to_message();
    let request = guarded(|| {
        let request = call.request(limits.message_bytes, |_| Err(no_deck()))?;
        check_request(&request, limits.threads)?;
        Ok::<OpenRequest, Fault>(request)
    });
    let request = match request.unwrap_or_else(Err) {
        Ok(request) => request,
        Err(fault) => return call.fail(&fault),
    };
    let mut waiting = Some(call);
    let opening = fingerprint(&request)
        .and_then(|print| shared.registry.open(&request.label, &request.token, print, &mut waiting));
    let registered = match opening {
        Ok(Opening::New(registered)) => registered,
        Ok(Opening::Forwarded) => return,
        Err(fault) => return waiting.into_iter().for_each(|call| call.fail(&fault)),
    };
    let Some(call) = waiting else { return };
    let span = tracing::info_span!("session", id = %registered.id, label = %request.label);
    let _entered = span.enter();
    let started = std::time::Instant::now();
    match start(shared, &request, &registered) {
        Ok(work) => {
            drop(request);
            tracing::info!(seconds = started.elapsed().as_secs_f64(), "open");
            work.tell(false);
            call.answer(Ok(work.opened()));
            serve(shared, work, registered);
        }
        Err(fault) => {
            let finding = fault.details.findings.iter().find(|f| f.severity == Severity::Error);
            let finding = finding.map(tracing::field::display);
            tracing::info!(code = %fault.code, message = %fault.message, finding, "not opened");
            shared.registry.remove(registered.number);
            call.fail(&fault);
            drain(registered, &fault);
        }
    }
}

fn start(shared: &Arc<Shared>, request: &OpenRequest, registered: &Registered) -> Result<Work, Fault> {
    let around = Surroundings {
        daemon: shared.id.clone(),
        session: registered.id.clone(),
        limits: shared.config.limits.to_message(),
        frames: shared.frames.clone(),
        status: registered.status.clone(),
        increments: shared.increments.clone(),
        steps: shared.steps.clone(),
    };
    let outcome = guarded(|| {
        let model = shared.models.obtain(request).map_err(|findings| convert::deck_refused(&findings))?;
        let work = Work::start(model, request, around)?;
        // A session that would end at once is not worth an answer that says otherwise.
        if shared.registry.draining() { Err(shutting_down()) } else { Ok(work) }
    });
    outcome.unwrap_or_else(|fault| {
        shared.sessions_failed.fetch_add(1, Ordering::Relaxed);
        Err(fault)
    })
}

fn no_deck() -> Fault {
    Fault::new(
        FaultCode::BadRequest,
        "open needs a payload with the text of a deck, e.g. {\"deck\": \"*HEADING\\n...\"}",
    )
}

fn check_request(request: &OpenRequest, threads_max: u32) -> Result<(), Fault> {
    if request.threads > threads_max {
        let text = format!("{} threads are more than the {threads_max} that one session may ask for", request.threads);
        let mut fault = Fault::new(FaultCode::LimitExceeded, text);
        fault.details.limit = Some(threads_max.into());
        return Err(fault);
    }
    if let Some(bad) = request.magnitudes.iter().find(|m| !m.value.is_finite()) {
        return Err(Fault::new(
            FaultCode::NotFinite,
            format!("input {}: {} is not a finite number", bad.name, bad.value),
        ));
    }
    Ok(())
}

/// Works on the queue until the session is closed, idle for too long, lost to a panic, or the daemon drains.
fn serve(shared: &Arc<Shared>, mut work: Work, mut registered: Registered) {
    let mut last = unknown_session(&registered.id);
    while let Some(command) = next(shared, &mut registered) {
        if shared.registry.draining() {
            command.into_call().fail(&shutting_down());
            continue;
        }
        registered.status.begin();
        let outcome = match command {
            Command::OpenedAgain(call) => answer(call, |_| Ok(work.opened())),
            Command::Verb(SessionVerb::Close, call) => {
                if let Err(fault) = call.no_request("close") {
                    call.fail(&fault);
                    work.tell(false);
                    continue;
                }
                shared.registry.remove(registered.number);
                call.answer(Ok(work.close()));
                break;
            }
            Command::Verb(verb, call) => perform(&mut work, verb, call, shared.config.limits.message_bytes),
        };
        if let Err(fault) = outcome {
            shared.sessions_failed.fetch_add(1, Ordering::Relaxed);
            shared.registry.remove(registered.number);
            last = fault;
            break;
        }
        work.tell(false);
    }
    tracing::info!("closed");
    drain(registered, &last);
    work.end();
}

/// The next request. `None` when the session is to end: the daemon drains, or nothing was asked for too long.
fn next(shared: &Shared, registered: &mut Registered) -> Option<Command> {
    let Some(idle_max) = shared.config.limits.idle_max() else { return registered.queue.blocking_recv() };
    loop {
        // After the end of the runtime there are no timers, but then the queue has ended, too.
        if shared.registry.draining() {
            return registered.queue.blocking_recv();
        }
        let waited = shared.runtime.block_on(async { tokio::time::timeout(idle_max, registered.queue.recv()).await });
        match waited {
            Ok(command) => return command,
            Err(_) if shared.registry.remove_idle(registered.number) => {
                tracing::info!(
                    idle_seconds = idle_max.as_secs_f64(),
                    "no request came for limits.idle_seconds: ending the session"
                );
                return None;
            }
            // A request came at the last moment.
            Err(_) => {}
        }
    }
}

/// Refuses what is still waiting.
fn drain(mut registered: Registered, fault: &Fault) {
    registered.queue.close();
    while let Ok(command) = registered.queue.try_recv() {
        command.into_call().fail(fault);
    }
}

/// Performs one verb. The error is the fault of a panic, already sent; the session cannot go on.
fn perform(work: &mut Work, verb: SessionVerb, call: Call, bytes_max: u64) -> Result<(), Fault> {
    let span = tracing::debug_span!("request", verb = verb.name());
    let _entered = span.enter();
    let nothing = |call: &Call| call.no_request(verb.name());
    match verb {
        SessionVerb::Step => answer(call, |call| work.step(&call.request(bytes_max, arguments::step)?)),
        SessionVerb::Get => answer(call, |call| work.get(&call.request(bytes_max, arguments::get)?)),
        SessionVerb::Field => answer(call, |call| work.field(&call.request(bytes_max, arguments::field)?)),
        SessionVerb::Restore => answer(call, |call| {
            work.restore(&call.request(bytes_max, |_| {
                Err(Fault::new(FaultCode::BadRequest, "restore needs a payload with sequence and state"))
            })?)
        }),
        SessionVerb::Ports => answer(call, |call| nothing(call).map(|()| work.ports())),
        SessionVerb::Checkpoint => answer(call, |call| nothing(call).map(|()| work.checkpoint())),
        SessionVerb::Report => answer(call, |call| nothing(call).map(|()| work.report())),
        SessionVerb::Close => answer(call, |call| nothing(call).map(|()| work.close())),
    }
}

fn answer<M: overclosure_protocol::message::Message>(
    call: Call,
    work: impl FnOnce(&Call) -> Result<M, Fault>,
) -> Result<(), Fault> {
    match guarded(|| work(&call)) {
        Ok(outcome) => {
            call.answer(outcome);
            Ok(())
        }
        Err(fault) => {
            call.fail(&fault);
            Err(fault)
        }
    }
}

/// Runs work that may panic. Whatever it touched must not be used again when it did.
pub fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, Fault> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| {
        let text = panic_text(panic.as_ref());
        tracing::error!(%text, "a defect of the solver ended a session");
        Fault::new(
            FaultCode::SessionFailed,
            format!("a defect of the solver ended this session: {text}; please report it with the deck"),
        )
    })
}

fn panic_text(panic: &(dyn Any + Send)) -> &str {
    panic
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no message")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_fault_with_its_text() {
        let fault = guarded(|| -> u32 { panic!("pivot {} vanished", 7) }).expect_err("it panicked");
        assert_eq!(fault.code, FaultCode::SessionFailed);
        assert!(fault.message.contains("pivot 7 vanished"), "{fault}");
        assert_eq!(guarded(|| 5), Ok(5));
    }
}
