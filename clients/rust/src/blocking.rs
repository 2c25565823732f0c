//! The same calls for programs without an async runtime. Not for use inside one.

use std::sync::Arc;

use overclosure_protocol::message::{
    Checkpoint, CloseReply, Field, Frame, GetReply, Health, Info, LawReply, LawRequest, Load, OpenReply, OpenRequest,
    Ports, Report, RestoreReply, StepReply, StepRequest,
};
use tokio::runtime::Runtime;

use crate::{CallError, Options};

/// A connection to one daemon. Cheap to clone.
#[derive(Clone)]
pub struct Client {
    runtime: Arc<Runtime>,
    inner: crate::Client,
}

impl Client {
    /// See [`crate::Client::connect`].
    pub fn connect(options: Options) -> Result<Self, CallError> {
        // One worker beside the caller: zenoh needs a multi-threaded runtime.
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(1)
            .enable_all()
            .build()
            .map_err(CallError::transport)?;
        let inner = runtime.block_on(crate::Client::connect(options))?;
        Ok(Self { runtime: Arc::new(runtime), inner })
    }

    /// See [`crate::Client::info`].
    pub fn info(&self) -> &Info {
        self.inner.info()
    }

    /// See [`crate::Client::health`].
    pub fn health(&self) -> Result<Health, CallError> {
        self.runtime.block_on(self.inner.health())
    }

    /// See [`crate::Client::load`].
    pub fn load(&self) -> Result<Load, CallError> {
        self.runtime.block_on(self.inner.load())
    }

    /// See [`crate::Client::law`].
    pub fn law(&self, request: &LawRequest) -> Result<LawReply, CallError> {
        self.runtime.block_on(self.inner.law(request))
    }

    /// See [`crate::Client::open`].
    pub fn open(&self, request: OpenRequest) -> Result<Session, CallError> {
        let inner = self.runtime.block_on(self.inner.open(request))?;
        Ok(Session { runtime: self.runtime.clone(), inner })
    }

    /// See [`crate::Client::attach`].
    pub fn attach(&self, session: &str) -> Result<Session, CallError> {
        let inner = self.runtime.block_on(self.inner.attach(session))?;
        Ok(Session { runtime: self.runtime.clone(), inner })
    }

    /// See [`crate::Client::close_session`].
    pub fn close_session(&self, session: &str) -> Result<CloseReply, CallError> {
        self.runtime.block_on(self.inner.close_session(session))
    }

    /// See [`crate::Client::disconnect`].
    pub fn disconnect(self) -> Result<(), CallError> {
        self.runtime.block_on(self.inner.disconnect())
    }
}

/// A session.
pub struct Session {
    runtime: Arc<Runtime>,
    inner: crate::Session,
}

impl Session {
    /// See [`crate::Session::id`].
    pub fn id(&self) -> &str {
        self.inner.id()
    }

    /// See [`crate::Session::opened`].
    pub fn opened(&self) -> &OpenReply {
        self.inner.opened()
    }

    /// See [`crate::Session::ports`].
    pub fn ports(&self) -> &Ports {
        self.inner.ports()
    }

    /// See [`crate::Session::sequence_next`].
    pub fn sequence_next(&self) -> u64 {
        self.inner.sequence_next()
    }

    /// See [`crate::Session::advance`].
    pub fn advance(&mut self, time: f64, inputs: &[(&str, f64)]) -> Result<StepReply, CallError> {
        self.runtime.block_on(self.inner.advance(time, inputs))
    }

    /// See [`crate::Session::step`].
    pub fn step(&mut self, request: StepRequest) -> Result<StepReply, CallError> {
        self.runtime.block_on(self.inner.step(request))
    }

    /// See [`crate::Session::get`].
    pub fn get(&self, names: &[&str]) -> Result<GetReply, CallError> {
        self.runtime.block_on(self.inner.get(names))
    }

    /// See [`crate::Session::synchronize`].
    pub fn synchronize(&mut self) -> Result<GetReply, CallError> {
        self.runtime.block_on(self.inner.synchronize())
    }

    /// See [`crate::Session::field`].
    pub fn field(&self, name: &str) -> Result<Field, CallError> {
        self.runtime.block_on(self.inner.field(name))
    }

    /// See [`crate::Session::checkpoint`].
    pub fn checkpoint(&self) -> Result<Checkpoint, CallError> {
        self.runtime.block_on(self.inner.checkpoint())
    }

    /// See [`crate::Session::restore`].
    pub fn restore(&mut self, state: &[u8]) -> Result<RestoreReply, CallError> {
        self.runtime.block_on(self.inner.restore(state))
    }

    /// See [`crate::Session::report`].
    pub fn report(&self) -> Result<Report, CallError> {
        self.runtime.block_on(self.inner.report())
    }

    /// See [`crate::Session::close`].
    pub fn close(self) -> Result<CloseReply, CallError> {
        self.runtime.block_on(self.inner.close())
    }

    /// See [`crate::Session::frames`].
    pub fn frames(&self) -> Result<Frames, CallError> {
        let inner = self.runtime.block_on(self.inner.frames())?;
        Ok(Frames { runtime: self.runtime.clone(), inner })
    }

    /// See [`crate::Session::frames_of`].
    pub fn frames_of(&self, field: &str) -> Result<Frames, CallError> {
        let inner = self.runtime.block_on(self.inner.frames_of(field))?;
        Ok(Frames { runtime: self.runtime.clone(), inner })
    }
}

/// Frames as they arrive.
pub struct Frames {
    runtime: Arc<Runtime>,
    inner: crate::Frames,
}

impl Iterator for Frames {
    type Item = Result<Frame, CallError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.runtime.block_on(self.inner.next()).transpose()
    }
}
