//! A query that waits for its answer, and the answer.

use overclosure_protocol::arguments;
use overclosure_protocol::codec::{self, Format, Stated};
use overclosure_protocol::fault::{Fault, FaultCode};
use overclosure_protocol::message::Message;
use zenoh::Wait;
use zenoh::query::Query;

/// A query with its negotiated format. The query ends when this is dropped; without an answer the client sees zero replies.
pub struct Call {
    query: Query,
    /// Concrete key of the reply: the key of the query may hold a wildcard.
    key: String,
    stated: Stated,
}

impl Call {
    /// Takes a query whose encoding is understood; otherwise answers it with the fault.
    pub fn accept(query: Query, key: String) -> Result<Self, Box<Refusal>> {
        let encoding = query.encoding().map(ToString::to_string);
        match codec::negotiate(encoding.as_deref()) {
            Ok(stated) => Ok(Self { query, key, stated }),
            Err(fault) => Err(Box::new(Refusal { query, fault, format: Format::Json })),
        }
    }

    /// The request of a verb that has one: the payload, or else the selector parameters.
    pub fn request<M: Message>(
        &self,
        bytes_max: u64,
        from_parameters: impl FnOnce(&str) -> Result<M, Fault>,
    ) -> Result<M, Fault> {
        let parameters = self.query.parameters().as_str();
        match self.query.payload() {
            Some(payload) if !payload.is_empty() => {
                arguments::none(parameters, "a request with a payload")?;
                self.check_size(bytes_max)?;
                Ok(codec::decode_stated(
                    &payload.to_bytes(),
                    &self.stated,
                    usize::try_from(bytes_max).unwrap_or(usize::MAX),
                )?)
            }
            _ => from_parameters(parameters),
        }
    }

    /// Checks that a verb without a request message got none.
    pub fn no_request(&self, verb: &str) -> Result<(), Fault> {
        arguments::none(self.query.parameters().as_str(), verb)?;
        let Some(payload) = self.query.payload() else { return Ok(()) };
        let empty_object =
            || payload.len() <= 16 && payload.to_bytes().iter().filter(|b| !b.is_ascii_whitespace()).eq(b"{}");
        if payload.is_empty() || (self.stated.format == Format::Json && empty_object()) {
            Ok(())
        } else {
            Err(Fault::new(FaultCode::BadRequest, format!("{verb} takes no payload")))
        }
    }

    /// Refuses a payload larger than the limit without touching it.
    pub fn check_size(&self, bytes_max: u64) -> Result<(), Fault> {
        let length = self.query.payload().map_or(0, |p| p.len()) as u64;
        if length <= bytes_max {
            return Ok(());
        }
        let mut fault =
            Fault::new(FaultCode::TooLarge, format!("the request has {length} bytes, this daemon accepts {bytes_max}"));
        fault.details.limit = Some(bytes_max);
        Err(fault)
    }

    /// Answers and ends the query. May block for a while behind a slow client: not for callbacks or dispatchers.
    pub fn answer<M: Message>(self, outcome: Result<M, Fault>) {
        let format = self.stated.format;
        match outcome.and_then(|message| codec::encode(&message, format)) {
            Ok(bytes) => {
                let reply = self.query.reply(self.key, bytes).encoding(codec::encoding_of::<M>(format)).express(true);
                if let Err(error) = reply.wait() {
                    tracing::warn!(%error, "a reply could not be sent");
                }
            }
            Err(fault) => refuse(&self.query, &fault, format),
        }
    }

    /// Answers with a fault and ends the query.
    pub fn fail(self, fault: &Fault) {
        refuse(&self.query, fault, self.stated.format);
    }
}

/// A query that is to be answered with a fault.
pub struct Refusal {
    query: Query,
    fault: Fault,
    format: Format,
}

impl Refusal {
    /// A refusal in the format of the query, as far as that is understood.
    pub fn new(query: Query, fault: Fault) -> Self {
        let encoding = query.encoding().map(ToString::to_string);
        let format = codec::negotiate(encoding.as_deref()).map_or(Format::Json, |stated| stated.format);
        Self { query, fault, format }
    }

    /// Answers and ends the query.
    pub fn send(self) {
        refuse(&self.query, &self.fault, self.format);
    }
}

fn refuse(query: &Query, fault: &Fault, format: Format) {
    tracing::debug!(key = %query.key_expr(), code = %fault.code, message = %fault.message, "refused");
    let Ok(bytes) = codec::encode(fault, format) else { return };
    if let Err(error) = query.reply_err(bytes).encoding(codec::encoding_of::<Fault>(format)).wait() {
        tracing::warn!(%error, "a fault could not be sent");
    }
}
