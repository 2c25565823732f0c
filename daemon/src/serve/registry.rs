//! The sessions that are open, and how requests reach them.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use overclosure_protocol::fault::{Fault, FaultCode};
use overclosure_protocol::key::SessionVerb;
use overclosure_protocol::message::SessionSummary;
use tokio::sync::mpsc;
use tokio::sync::mpsc::error::TrySendError;

use super::reply::Call;

/// What waits in the queue of a session.
pub enum Command {
    /// A verb.
    Verb(SessionVerb, Call),
    /// A repeated `open` with the token of this session.
    OpenedAgain(Call),
}

impl Command {
    /// The query, to refuse it.
    pub fn into_call(self) -> Call {
        match self {
            Self::Verb(_, call) | Self::OpenedAgain(call) => call,
        }
    }
}

/// A request given back, with the reason.
pub struct Refused {
    /// The reason.
    pub fault: Fault,
    /// The request.
    pub command: Command,
}

/// What others may know about a session without asking its thread.
pub struct Status {
    /// Set to stop a running advance before its next increment.
    pub cancelled: AtomicBool,
    working: AtomicBool,
    sequence_next: AtomicU64,
    time_bits: AtomicU64,
    opened: Instant,
    /// Milliseconds from `opened` to the end of the last request.
    answered_ms: AtomicU64,
}

impl Default for Status {
    fn default() -> Self {
        Self {
            cancelled: AtomicBool::new(false),
            working: AtomicBool::new(false),
            sequence_next: AtomicU64::new(0),
            time_bits: AtomicU64::new(0),
            opened: Instant::now(),
            answered_ms: AtomicU64::new(0),
        }
    }
}

impl Status {
    /// Tells what the session is at.
    pub fn update(&self, working: bool, sequence_next: u64, time: f64) {
        self.working.store(working, Ordering::Relaxed);
        self.sequence_next.store(sequence_next, Ordering::Relaxed);
        self.time_bits.store(time.to_bits(), Ordering::Relaxed);
        self.answered_ms.store(self.age_ms(), Ordering::Relaxed);
    }

    /// Marks the begin of work on a request.
    pub fn begin(&self) {
        self.working.store(true, Ordering::Relaxed);
    }

    /// How long nothing has been asked of the session.
    pub fn idle(&self) -> Duration {
        if self.working.load(Ordering::Relaxed) {
            return Duration::ZERO;
        }
        Duration::from_millis(self.age_ms().saturating_sub(self.answered_ms.load(Ordering::Relaxed)))
    }

    fn age_ms(&self) -> u64 {
        u64::try_from(self.opened.elapsed().as_millis()).unwrap_or(u64::MAX)
    }
}

struct Entry {
    queue: mpsc::Sender<Command>,
    status: Arc<Status>,
    label: String,
    token: String,
    /// Fingerprint of the request that made the session.
    print: u64,
}

#[derive(Default)]
struct Sessions {
    /// By number, so that lists are in the order of opening.
    open: BTreeMap<u64, Entry>,
    last: u64,
    draining: bool,
}

/// All open sessions.
pub struct Registry {
    sessions: Mutex<Sessions>,
    /// Distinguishes the ids of this run from those of an earlier one under the same daemon id.
    prefix: String,
    sessions_max: u32,
    queue: u32,
}

/// A new session, for its thread.
pub struct Registered {
    /// Its number in the registry.
    pub number: u64,
    /// Its id on the wire.
    pub id: String,
    /// Requests for it.
    pub queue: mpsc::Receiver<Command>,
    /// To be kept up to date.
    pub status: Arc<Status>,
}

/// How an `open` goes on.
pub enum Opening {
    /// A new session.
    New(Registered),
    /// The token is known: the query went to its session.
    Forwarded,
}

impl Registry {
    /// Ids are `{prefix}-{number}`.
    pub fn new(prefix: String, sessions_max: u32, queue: u32) -> Self {
        Self { sessions: Mutex::default(), prefix, sessions_max, queue }
    }

    /// Makes a session, or hands the query to the one that its token made. A refused query comes back with the fault; so does one
    /// whose token made a session of another request.
    pub fn open(&self, label: &str, token: &str, print: u64, call: &mut Option<Call>) -> Result<Opening, Fault> {
        let mut sessions = self.lock();
        if sessions.draining {
            return Err(shutting_down());
        }
        if let Some(entry) = sessions.open.values().find(|e| !token.is_empty() && e.token == token) {
            if entry.print != print {
                let text = format!("the token {token:?} has opened a session from another request; choose a new one");
                return Err(Fault::new(FaultCode::BadRequest, text));
            }
            let Some(query) = call.take() else { return Ok(Opening::Forwarded) };
            return match entry.queue.try_send(Command::OpenedAgain(query)) {
                Ok(()) => Ok(Opening::Forwarded),
                Err(error) => {
                    let Refused { fault, command } = refused(error, self.queue);
                    *call = Some(command.into_call());
                    Err(fault)
                }
            };
        }
        if sessions.open.len() >= self.sessions_max as usize {
            let mut fault = Fault::new(
                FaultCode::LimitExceeded,
                format!("{} sessions are open, no more are allowed; close one", self.sessions_max),
            );
            fault.details.limit = Some(self.sessions_max.into());
            return Err(fault);
        }
        sessions.last += 1;
        let number = sessions.last;
        let (sender, queue) = mpsc::channel(self.queue as usize);
        let status = Arc::new(Status::default());
        status.update(true, 1, 0.0);
        let entry =
            Entry { queue: sender, status: status.clone(), label: label.to_owned(), token: token.to_owned(), print };
        sessions.open.insert(number, entry);
        Ok(Opening::New(Registered { number, id: format!("{}-{number}", self.prefix), queue, status }))
    }

    /// Puts a request into the queue of its session, or gives it back with the reason. Never blocks.
    pub fn dispatch(&self, session: &str, command: Command) -> Result<(), Box<Refused>> {
        let sessions = self.lock();
        if sessions.draining {
            return Err(Box::new(Refused { fault: shutting_down(), command }));
        }
        let number =
            session.strip_prefix(&self.prefix).and_then(|rest| rest.strip_prefix('-')).and_then(|n| n.parse().ok());
        match number.and_then(|n: u64| sessions.open.get(&n)) {
            Some(entry) => entry.queue.try_send(command).map_err(|error| Box::new(refused(error, self.queue))),
            None => Err(Box::new(Refused { fault: unknown_session(session), command })),
        }
    }

    /// Forgets a session; requests that arrive from now on find it unknown.
    pub fn remove(&self, number: u64) {
        self.lock().open.remove(&number);
    }

    /// Forgets a session unless a request waits for it. Requests are put into queues under the same lock, so none is lost.
    pub fn remove_idle(&self, number: u64) -> bool {
        let mut sessions = self.lock();
        match sessions.open.get(&number) {
            Some(entry) if entry.queue.capacity() < entry.queue.max_capacity() => false,
            _ => {
                sessions.open.remove(&number);
                true
            }
        }
    }

    /// Refuses everything new, stops running advances at their next increment, and lets the threads end when their queues are
    /// empty.
    pub fn drain(&self) {
        let mut sessions = self.lock();
        sessions.draining = true;
        for entry in sessions.open.values() {
            entry.status.cancelled.store(true, Ordering::Relaxed);
        }
        sessions.open.clear();
    }

    /// Whether [`Registry::drain`] was called.
    pub fn draining(&self) -> bool {
        self.lock().draining
    }

    /// Sessions that may still be opened.
    pub fn free(&self) -> u32 {
        self.sessions_max.saturating_sub(u32::try_from(self.lock().open.len()).unwrap_or(u32::MAX))
    }

    /// One line per session.
    pub fn summaries(&self) -> Vec<SessionSummary> {
        let sessions = self.lock();
        let summary = |(number, entry): (&u64, &Entry)| SessionSummary {
            session: format!("{}-{number}", self.prefix),
            label: entry.label.clone(),
            working: entry.status.working.load(Ordering::Relaxed),
            waiting: u32::try_from(entry.queue.max_capacity() - entry.queue.capacity()).unwrap_or(u32::MAX),
            sequence_next: entry.status.sequence_next.load(Ordering::Relaxed),
            time: f64::from_bits(entry.status.time_bits.load(Ordering::Relaxed)),
            idle_seconds: entry.status.idle().as_secs_f64(),
        };
        sessions.open.iter().map(summary).collect()
    }

    /// Held for a few instructions only; a panic under it is not possible, and would not leave it inconsistent.
    fn lock(&self) -> MutexGuard<'_, Sessions> {
        self.sessions.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The session does not exist.
pub fn unknown_session(session: &str) -> Fault {
    Fault::new(
        FaultCode::UnknownSession,
        format!(
            "no session {session:?} is open here; it was never opened, or it ended: closed, lost, or idle for too long"
        ),
    )
}

/// The daemon takes no more work.
pub fn shutting_down() -> Fault {
    Fault::new(FaultCode::ShuttingDown, "the daemon is shutting down")
}

fn refused(error: TrySendError<Command>, queue: u32) -> Refused {
    match error {
        TrySendError::Full(command) => {
            let mut fault =
                Fault::new(FaultCode::Busy, format!("{queue} requests are waiting for this session; try again later"));
            fault.details.limit = Some(queue.into());
            Refused { fault, command }
        }
        TrySendError::Closed(command) => {
            Refused { fault: Fault::new(FaultCode::UnknownSession, "the session has just ended"), command }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn open(registry: &Registry, token: &str) -> Result<Opening, Fault> {
        registry.open("label", token, 1, &mut None)
    }

    fn registered(opening: Result<Opening, Fault>) -> Registered {
        match opening {
            Ok(Opening::New(registered)) => registered,
            Ok(Opening::Forwarded) => panic!("forwarded"),
            Err(fault) => panic!("{fault}"),
        }
    }

    #[test]
    fn a_limit_of_sessions_is_kept_and_freed() {
        let registry = Registry::new("ab".into(), 2, 4);
        let first = registered(open(&registry, ""));
        let _second = registered(open(&registry, ""));
        assert_eq!(registry.free(), 0);
        let fault = open(&registry, "").err().expect("full");
        assert_eq!((fault.code, fault.details.limit), (FaultCode::LimitExceeded, Some(2)));
        registry.remove(first.number);
        assert_eq!(registered(open(&registry, "")).id, "ab-3", "numbers are not used again");
    }

    #[test]
    fn a_known_token_makes_no_second_session() {
        let registry = Registry::new("ab".into(), 2, 4);
        let _first = registered(open(&registry, "t"));
        assert!(matches!(open(&registry, "t"), Ok(Opening::Forwarded)));
        let other = registry.open("label", "t", 2, &mut None);
        assert_eq!(other.err().map(|f| f.code), Some(FaultCode::BadRequest), "another request under the same token");
        assert_eq!(registry.summaries().len(), 1);
    }

    #[test]
    fn an_idle_session_is_forgotten_and_one_at_work_is_not_idle() {
        let registry = Registry::new("ab".into(), 2, 4);
        let session = registered(open(&registry, ""));
        assert_eq!(session.status.idle(), Duration::ZERO, "still being opened");
        session.status.update(false, 1, 0.0);
        std::thread::sleep(Duration::from_millis(5));
        assert!(registry.summaries()[0].idle_seconds > 0.0);
        session.status.begin();
        assert_eq!(registry.summaries()[0].idle_seconds, 0.0);
        assert!(registry.remove_idle(session.number));
        assert!(registry.summaries().is_empty());
    }

    #[test]
    fn draining_ends_queues_and_refuses_new_sessions() {
        let registry = Registry::new("ab".into(), 2, 4);
        let mut session = registered(open(&registry, ""));
        registry.drain();
        assert!(session.status.cancelled.load(Ordering::Relaxed));
        assert!(session.queue.blocking_recv().is_none());
        assert_eq!(open(&registry, "").err().map(|f| f.code), Some(FaultCode::ShuttingDown));
    }
}
