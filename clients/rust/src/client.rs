//! The connection to one daemon.

use std::sync::Arc;
use std::time::Duration;

use overclosure_protocol::DEFAULT_ENDPOINT;
use overclosure_protocol::fault::{Fault, FaultCode};
use overclosure_protocol::key::{self, DaemonVerb, SessionVerb};
use overclosure_protocol::message::{
    CloseReply, GetReply, Health, Info, LawReply, LawRequest, Load, Message, OpenReply, OpenRequest, Ports,
};

use crate::call::{Patience, REPLY_BYTES_MAX, Request, call};
use crate::network::{Side, zenoh_config, zenoh_text};
use crate::{CallError, Session};

/// How to reach a daemon.
#[derive(Clone, Debug)]
pub struct Options {
    /// Where it listens; `tcp/127.0.0.1:7447` unless given.
    pub endpoint: String,
    /// Its id; the one that answers unless given.
    pub daemon: Option<String>,
    /// How long to keep trying to connect; 2 s unless given.
    pub timeout_connect: Duration,
    /// How long to wait for verbs that do no solving; 10 s unless given.
    pub timeout: Duration,
    /// How long to wait for `open`, `step`, `restore`, `field`; an hour unless given. A daemon that dies is noticed at once.
    pub timeout_work: Duration,
    /// How often to ask before an unanswered or busy call fails; 5 unless given.
    pub attempts: u32,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            endpoint: DEFAULT_ENDPOINT.to_owned(),
            daemon: None,
            timeout_connect: Duration::from_secs(2),
            timeout: Duration::from_secs(10),
            timeout_work: Duration::from_secs(3600),
            attempts: 5,
        }
    }
}

/// A connection to one daemon. Cheap to clone.
#[derive(Clone)]
pub struct Client {
    shared: Arc<Shared>,
}

struct Shared {
    zenoh: zenoh::Session,
    info: Info,
    options: Options,
}

impl Client {
    /// Connects and asks who is there.
    pub async fn connect(options: Options) -> Result<Self, CallError> {
        let timeout_ms = u64::try_from(options.timeout_connect.as_millis()).unwrap_or(u64::MAX).min(i64::MAX as u64);
        let side = Side::Client { connect: vec![options.endpoint.clone()], timeout_ms };
        let config = zenoh_config(&side, REPLY_BYTES_MAX as u64).map_err(CallError::transport)?;
        let zenoh = zenoh::open(config)
            .await
            .map_err(|e| CallError::NotReached { endpoint: options.endpoint.clone(), detail: zenoh_text(&e) })?;
        let request = Request::bare(key::daemon(options.daemon.as_deref().unwrap_or("*"), DaemonVerb::Info));
        let patience = Patience { timeout: options.timeout, attempts: options.attempts };
        let info = call(&zenoh, &request, patience).await?;
        Ok(Self { shared: Arc::new(Shared { zenoh, info, options }) })
    }

    /// What the daemon said about itself when the connection was made.
    pub fn info(&self) -> &Info {
        &self.shared.info
    }

    /// Whether the daemon is well.
    pub async fn health(&self) -> Result<Health, CallError> {
        self.ask(DaemonVerb::Health).await
    }

    /// How busy the daemon is, and its sessions.
    pub async fn load(&self) -> Result<Load, CallError> {
        self.ask(DaemonVerb::Load).await
    }

    /// Evaluates a law, or contact damping, at many overclosures; `Info::law_kinds` names the kinds. Arrays that the kind does not
    /// have are empty.
    pub async fn law(&self, request: &LawRequest) -> Result<LawReply, CallError> {
        self.request(key::daemon(self.daemon(), DaemonVerb::Law), request, self.quick()).await
    }

    /// Opens a session. An empty token is replaced, so that a repeated call cannot open two.
    pub async fn open(&self, mut request: OpenRequest) -> Result<Session, CallError> {
        if request.token.is_empty() {
            request.token = token(&self.shared.zenoh);
        }
        let reply: OpenReply =
            self.request(key::daemon(self.daemon(), DaemonVerb::Open), &request, self.work()).await?;
        Ok(Session::new(self.clone(), reply))
    }

    /// Takes up a session that is already open, by its id.
    pub async fn attach(&self, session: &str) -> Result<Session, CallError> {
        if let Err(error) = key::check_id(session) {
            return Err(Fault::new(FaultCode::UnknownSession, error.to_string()).into());
        }
        let ports: Ports = self.ask_session(session, SessionVerb::Ports, self.quick()).await?;
        let values: GetReply = self.ask_session(session, SessionVerb::Get, self.quick()).await?;
        let reply = OpenReply {
            session: session.to_owned(),
            sequence_next: values.sequence_next,
            time: values.time,
            time_end: values.time_end,
            warnings: Vec::new(),
            audit: Vec::new(),
            ports,
            outputs: values.outputs.iter().map(|v| v.value).collect(),
        };
        Ok(Session::new(self.clone(), reply))
    }

    /// Ends a session by its id.
    pub async fn close_session(&self, session: &str) -> Result<CloseReply, CallError> {
        if let Err(error) = key::check_id(session) {
            return Err(Fault::new(FaultCode::UnknownSession, error.to_string()).into());
        }
        self.ask_session(session, SessionVerb::Close, self.work()).await
    }

    /// Closes the connection; sessions stay open in the daemon.
    pub async fn disconnect(self) -> Result<(), CallError> {
        self.shared.zenoh.close().await.map_err(CallError::transport)
    }

    pub(crate) fn daemon(&self) -> &str {
        &self.shared.info.daemon
    }

    pub(crate) fn zenoh(&self) -> &zenoh::Session {
        &self.shared.zenoh
    }

    pub(crate) fn quick(&self) -> Patience {
        Patience { timeout: self.shared.options.timeout, attempts: self.shared.options.attempts }
    }

    pub(crate) fn work(&self) -> Patience {
        Patience { timeout: self.shared.options.timeout_work, attempts: self.shared.options.attempts }
    }

    pub(crate) async fn request<Q: Message, R: Message>(
        &self,
        key: String,
        request: &Q,
        patience: Patience,
    ) -> Result<R, CallError> {
        let request = Request::new(key, request, self.shared.info.limits.message_bytes)?;
        call(&self.shared.zenoh, &request, patience).await
    }

    pub(crate) async fn ask_session<R: Message>(
        &self,
        session: &str,
        verb: SessionVerb,
        patience: Patience,
    ) -> Result<R, CallError> {
        let request = Request::bare(key::session(self.daemon(), session, verb));
        call(&self.shared.zenoh, &request, patience).await
    }

    async fn ask<R: Message>(&self, verb: DaemonVerb) -> Result<R, CallError> {
        let request = Request::bare(key::daemon(self.daemon(), verb));
        call(&self.shared.zenoh, &request, self.quick()).await
    }
}

/// Unique among clients by zenoh's random id, within a client by a counter.
fn token(zenoh: &zenoh::Session) -> String {
    use std::sync::atomic::{AtomicU64, Ordering};
    static COUNTER: AtomicU64 = AtomicU64::new(0);
    format!("{}-{}", zenoh.zid(), COUNTER.fetch_add(1, Ordering::Relaxed))
}
