//! One exchange: a query, its reply, and when to ask again.

use std::time::Duration;

use overclosure_protocol::codec::{self, Format};
use overclosure_protocol::fault::{Fault, FaultCode};
use overclosure_protocol::message::Message;
use zenoh::bytes::Encoding;
use zenoh::qos::{CongestionControl, Priority};
use zenoh::query::{ConsolidationMode, QueryTarget};

use crate::CallError;

/// Replies are not bounded by the daemon's limit for requests; this only guards against nonsense.
pub(crate) const REPLY_BYTES_MAX: usize = 1 << 30;

/// How long to wait, and how often to ask.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patience {
    pub timeout: Duration,
    pub attempts: u32,
}

/// Pause before the second attempt; doubled for each further one up to `PAUSE_MAX`.
const PAUSE: Duration = Duration::from_millis(100);
const PAUSE_MAX: Duration = Duration::from_secs(2);

/// A request ready to be sent any number of times.
pub(crate) struct Request {
    pub key: String,
    pub encoding: String,
    pub payload: Option<Vec<u8>>,
}

impl Request {
    /// A verb without a request message.
    pub fn bare(key: String) -> Self {
        Self { key, encoding: Format::Postcard.media_type().to_owned(), payload: None }
    }

    /// A verb with one; refused here when it is larger than the daemon accepts.
    pub fn new<M: Message>(key: String, message: &M, bytes_max: u64) -> Result<Self, CallError> {
        let payload = codec::encode(message, Format::Postcard)?;
        if payload.len() as u64 > bytes_max {
            let text = format!("this {} has {} bytes, the daemon accepts {bytes_max}", M::NAME, payload.len());
            let mut fault = Fault::new(FaultCode::TooLarge, text);
            fault.details.limit = Some(bytes_max);
            return Err(fault.into());
        }
        Ok(Self { key, encoding: codec::encoding_of::<M>(Format::Postcard), payload: Some(payload) })
    }
}

/// Sends a request until it is answered or patience ends. The same bytes each time, so that the daemon can tell a
/// repetition from a new request.
pub(crate) async fn call<R: Message>(
    session: &zenoh::Session,
    request: &Request,
    patience: Patience,
) -> Result<R, CallError> {
    let mut pause = PAUSE;
    let mut attempt = 1;
    loop {
        match once(session, request, patience.timeout).await {
            Err(error) if error.retryable() && attempt < patience.attempts => {
                tokio::time::sleep(pause).await;
                pause = (pause * 2).min(PAUSE_MAX);
                attempt += 1;
            }
            outcome => return outcome,
        }
    }
}

async fn once<R: Message>(session: &zenoh::Session, request: &Request, timeout: Duration) -> Result<R, CallError> {
    let mut get = session
        .get(request.key.as_str())
        .encoding(request.encoding.as_str())
        .target(QueryTarget::BestMatching)
        .consolidation(ConsolidationMode::None)
        .congestion_control(CongestionControl::Block)
        .priority(Priority::InteractiveHigh)
        .express(true)
        .timeout(timeout);
    if let Some(payload) = &request.payload {
        get = get.payload(payload.as_slice());
    }
    let replies = get.await.map_err(CallError::transport)?;
    let Ok(reply) = replies.recv_async().await else {
        return Err(CallError::Unavailable { key: request.key.clone() });
    };
    match reply.into_result() {
        Ok(sample) => {
            let bytes = sample.payload().to_bytes();
            let stated = codec::negotiate(Some(&sample.encoding().to_string()))?;
            codec::decode_stated(&bytes, &stated, REPLY_BYTES_MAX)
                .map_err(|e| CallError::transport(format!("{}: {e}", request.key)))
        }
        Err(error) => Err(match fault(error.encoding(), &error.payload().to_bytes()) {
            Some(fault) => CallError::Fault(fault),
            None => CallError::Timeout { key: request.key.clone(), seconds: timeout.as_secs_f64() },
        }),
    }
}

/// A fault of ours is told from zenoh's own errors by its encoding, never by its text.
fn fault(encoding: &Encoding, bytes: &[u8]) -> Option<Fault> {
    let text = encoding.to_string();
    let ours = Format::ALL.into_iter().find(|f| text == codec::encoding_of::<Fault>(*f))?;
    codec::decode(bytes, ours, REPLY_BYTES_MAX).ok()
}
