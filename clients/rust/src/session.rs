//! One session in the daemon.

use overclosure_protocol::codec;
use overclosure_protocol::fault::FaultCode;
use overclosure_protocol::key::{self, OUTPUTS_FRAME, SessionVerb};
use overclosure_protocol::message::{
    Checkpoint, CloseReply, Field, FieldRequest, Frame, GetReply, GetRequest, InputValue, OpenReply, Ports, Report,
    RestoreReply, RestoreRequest, StepReply, StepRequest,
};
use zenoh::handlers::{RingChannel, RingChannelHandler};
use zenoh::sample::{Sample, SampleKind};

use crate::call::REPLY_BYTES_MAX;
use crate::{CallError, Client};

/// Frames that wait for a slow reader; the oldest is dropped first and the numbers show the gap.
const FRAMES_WAITING: usize = 1024;

/// A session. Dropping it leaves the session open in the daemon; [`Session::close`] ends it.
pub struct Session {
    client: Client,
    opened: OpenReply,
    sequence_next: u64,
}

impl Session {
    pub(crate) fn new(client: Client, opened: OpenReply) -> Self {
        let sequence_next = opened.sequence_next;
        Self { client, opened, sequence_next }
    }

    /// Its id.
    pub fn id(&self) -> &str {
        &self.opened.session
    }

    /// What the daemon answered when the session was opened.
    pub fn opened(&self) -> &OpenReply {
        &self.opened
    }

    /// Inputs and outputs.
    pub fn ports(&self) -> &Ports {
        &self.opened.ports
    }

    /// The sequence number that the next step or restore will carry.
    pub fn sequence_next(&self) -> u64 {
        self.sequence_next
    }

    /// Sets inputs by name and advances to a total time.
    pub async fn advance(&mut self, time: f64, inputs: &[(&str, f64)]) -> Result<StepReply, CallError> {
        let inputs = inputs.iter().map(|&(name, value)| InputValue { name: name.to_owned(), value }).collect();
        self.step(StepRequest { time, inputs, ..Default::default() }).await
    }

    /// Performs a step. The sequence number of the request is filled in.
    ///
    /// After [`CallError::Timeout`] or [`CallError::Unavailable`] the step may or may not have been done: repeat the same call, or
    /// take up the present state with [`Session::synchronize`].
    pub async fn step(&mut self, mut request: StepRequest) -> Result<StepReply, CallError> {
        request.sequence = self.sequence_next;
        let reply: StepReply = self.client.request(self.key(SessionVerb::Step), &request, self.client.work()).await?;
        self.sequence_next = reply.sequence + 1;
        Ok(reply)
    }

    /// Present values; all when no name is given.
    pub async fn get(&self, names: &[&str]) -> Result<GetReply, CallError> {
        let request = GetRequest { names: names.iter().map(|&n| n.to_owned()).collect() };
        self.client.request(self.key(SessionVerb::Get), &request, self.client.quick()).await
    }

    /// Asks the daemon for the sequence number it expects.
    pub async fn synchronize(&mut self) -> Result<GetReply, CallError> {
        let reply = self.get(&[]).await?;
        self.sequence_next = reply.sequence_next;
        Ok(reply)
    }

    /// A field by name.
    pub async fn field(&self, name: &str) -> Result<Field, CallError> {
        let request = FieldRequest { name: name.to_owned() };
        self.client.request(self.key(SessionVerb::Field), &request, self.client.work()).await
    }

    /// The state, to go back to.
    pub async fn checkpoint(&self) -> Result<Checkpoint, CallError> {
        self.client.ask_session(self.id(), SessionVerb::Checkpoint, self.client.work()).await
    }

    /// Returns to a state.
    pub async fn restore(&mut self, state: &[u8]) -> Result<RestoreReply, CallError> {
        let request = RestoreRequest { sequence: self.sequence_next, state: state.to_vec() };
        let reply: RestoreReply =
            self.client.request(self.key(SessionVerb::Restore), &request, self.client.work()).await?;
        self.sequence_next = reply.sequence + 1;
        Ok(reply)
    }

    /// Steps so far, work and findings.
    pub async fn report(&self) -> Result<Report, CallError> {
        self.client.ask_session(self.id(), SessionVerb::Report, self.client.quick()).await
    }

    /// Ends the session. A session that is already gone counts as closed.
    pub async fn close(self) -> Result<CloseReply, CallError> {
        let session = self.id().to_owned();
        match self.client.ask_session(&session, SessionVerb::Close, self.client.work()).await {
            Err(CallError::Fault(fault)) if fault.code == FaultCode::UnknownSession => {
                Ok(CloseReply { session, time: f64::NAN })
            }
            outcome => outcome,
        }
    }

    /// Subscribes to the output vector of each increment.
    pub async fn frames(&self) -> Result<Frames, CallError> {
        self.frames_of(OUTPUTS_FRAME).await
    }

    /// Subscribes to a field; it is published for steps whose request names it in `frames`.
    pub async fn frames_of(&self, field: &str) -> Result<Frames, CallError> {
        let key = |field: &str| key::frame(self.client.daemon(), self.id(), field);
        let declare = async |key: String| {
            let subscriber = self.client.zenoh().declare_subscriber(key);
            subscriber.with(RingChannel::new(FRAMES_WAITING)).await.map_err(CallError::transport)
        };
        let subscriber = declare(key(field)).await?;
        // One exchange on the same link: once it is answered, the daemon knows of the subscription.
        self.client.ask_session::<Ports>(self.id(), SessionVerb::Ports, self.client.quick()).await?;
        Ok(Frames { subscriber })
    }

    fn key(&self, verb: SessionVerb) -> String {
        key::session(self.client.daemon(), self.id(), verb)
    }
}

/// Frames as they arrive.
pub struct Frames {
    subscriber: zenoh::pubsub::Subscriber<RingChannelHandler<Sample>>,
}

impl Frames {
    /// The next frame; `None` when the session has ended.
    pub async fn next(&mut self) -> Result<Option<Frame>, CallError> {
        let Ok(sample) = self.subscriber.recv_async().await else {
            return Ok(None);
        };
        if sample.kind() == SampleKind::Delete {
            return Ok(None);
        }
        let stated = codec::negotiate(Some(&sample.encoding().to_string()))?;
        codec::decode_stated(&sample.payload().to_bytes(), &stated, REPLY_BYTES_MAX)
            .map(Some)
            .map_err(CallError::transport)
    }
}
