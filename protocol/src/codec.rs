//! Encodings, their negotiation, and bounded encoding and decoding.
//!
//! The text of an encoding is `{media type};{message}/{version}`, e.g. `application/postcard;StepRequest/1`.
//! A reply has the format of its request. Nothing stated, or one of the encodings that stock tools put on a plain
//! text, means JSON.

use crate::fault::{Fault, FaultCode};
use crate::message::Message;

/// How a message is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Format {
    /// `application/json`, indented, for people and stock tools.
    #[default]
    Json,
    /// `application/postcard`: positional, little-endian; what our clients use.
    Postcard,
}

impl Format {
    /// All formats that are understood.
    pub const ALL: [Self; 2] = [Self::Postcard, Self::Json];

    /// Media type.
    pub fn media_type(self) -> &'static str {
        match self {
            Self::Json => "application/json",
            Self::Postcard => "application/postcard",
        }
    }
}

/// Media types of requests that state nothing about their content; they are read as JSON.
const UNSTATED: [&str; 6] = ["", "zenoh/bytes", "zenoh/string", "text/plain", "text/json", "application/json"];

/// A stated encoding: its format and, if given, the message it claims to be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stated {
    /// Format of request and reply.
    pub format: Format,
    /// `StepRequest/1`; empty when not stated.
    pub schema: String,
}

/// Reads the encoding of a request. `None` means that the request carries none.
pub fn negotiate(encoding: Option<&str>) -> Result<Stated, Fault> {
    let text = encoding.unwrap_or("");
    let (media, schema) = text.split_once(';').unwrap_or((text, ""));
    let media = media.trim();
    let format = if UNSTATED.contains(&media) {
        Format::Json
    } else if media == Format::Postcard.media_type() {
        Format::Postcard
    } else {
        let message = format!(
            "the encoding {text} is not understood; this daemon speaks {}, {} and, when nothing is stated, JSON",
            Format::Postcard.media_type(),
            Format::Json.media_type()
        );
        return Err(Fault::new(FaultCode::UnsupportedEncoding, message));
    };
    // Stock tools may append parameters such as `charset=utf-8`; only `Name/version` names a message.
    let schema = if schema.contains('/') { schema.trim() } else { "" };
    Ok(Stated { format, schema: schema.to_owned() })
}

/// `application/postcard;StepRequest/1`.
pub fn encoding_of<M: Message>(format: Format) -> String {
    format!("{};{}", format.media_type(), schema_of::<M>())
}

/// `StepRequest/1`.
pub fn schema_of<M: Message>() -> String {
    format!("{}/{}", M::NAME, M::VERSION)
}

/// Why bytes cannot be read as a message.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DecodeError {
    /// More bytes than allowed.
    #[error("{length} bytes are more than the {limit} that a {message} may have")]
    TooLarge {
        /// Message expected.
        message: &'static str,
        /// Bytes received.
        length: usize,
        /// Bytes allowed.
        limit: usize,
    },
    /// The bytes do not form the message.
    #[error("not a {message}: {detail}")]
    Malformed {
        /// Message expected.
        message: &'static str,
        /// What does not fit.
        detail: String,
    },
    /// The sender says that it is another message.
    #[error("a {expected} is expected here, this is a {found}")]
    OtherMessage {
        /// `Name/version` expected.
        expected: String,
        /// `Name/version` stated.
        found: String,
    },
}

impl From<DecodeError> for Fault {
    fn from(error: DecodeError) -> Self {
        let code = match &error {
            DecodeError::TooLarge { .. } => FaultCode::TooLarge,
            DecodeError::Malformed { .. } => FaultCode::BadRequest,
            DecodeError::OtherMessage { .. } => FaultCode::UnsupportedEncoding,
        };
        let mut fault = Self::new(code, error.to_string());
        if let DecodeError::TooLarge { limit, .. } = error {
            fault.details.limit = Some(limit as u64);
        }
        fault
    }
}

/// Writes a message. JSON is indented and ends with a line break.
pub fn encode<M: Message>(message: &M, format: Format) -> Result<Vec<u8>, Fault> {
    let internal = |detail: String| Fault::new(FaultCode::Internal, format!("cannot write a {}: {detail}", M::NAME));
    match format {
        Format::Postcard => postcard::to_stdvec(message).map_err(|e| internal(e.to_string())),
        Format::Json => {
            let mut bytes = serde_json::to_vec_pretty(message).map_err(|e| internal(e.to_string()))?;
            bytes.push(b'\n');
            Ok(bytes)
        }
    }
}

/// Reads a message of at most `limit` bytes. Never panics; allocates at most in proportion to the bytes received;
/// bytes left over are an error.
pub fn decode<M: Message>(bytes: &[u8], format: Format, limit: usize) -> Result<M, DecodeError> {
    if bytes.len() > limit {
        return Err(DecodeError::TooLarge { message: M::NAME, length: bytes.len(), limit });
    }
    let malformed = |detail: String| DecodeError::Malformed { message: M::NAME, detail };
    match format {
        Format::Postcard => match postcard::take_from_bytes::<M>(bytes) {
            Ok((message, [])) => Ok(message),
            Ok((_, rest)) => Err(malformed(format!("{} bytes too many", rest.len()))),
            Err(error) => Err(malformed(error.to_string())),
        },
        Format::Json => serde_json::from_slice(bytes).map_err(|e| malformed(e.to_string())),
    }
}

/// As [`decode`], after checking the schema that the sender states, if any.
pub fn decode_stated<M: Message>(bytes: &[u8], stated: &Stated, limit: usize) -> Result<M, DecodeError> {
    let expected = schema_of::<M>();
    if !stated.schema.is_empty() && stated.schema != expected {
        return Err(DecodeError::OtherMessage { expected, found: stated.schema.clone() });
    }
    decode(bytes, stated.format, limit)
}

/// Lower-case hexadecimal digits of bytes, as JSON holds binary fields.
pub fn to_hex(bytes: &[u8]) -> String {
    crate::text::hex_bytes::to_hex(bytes)
}

/// Reads hexadecimal digits; `None` when there is anything else, or an odd number of them.
pub fn from_hex(text: &str) -> Option<Vec<u8>> {
    crate::text::hex_bytes::from_hex(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::message::{LawReply, StepRequest};

    #[test]
    fn nothing_stated_means_json() {
        for text in [
            None,
            Some(""),
            Some("zenoh/bytes"),
            Some("zenoh/string"),
            Some("application/json"),
            Some("text/plain;charset=utf-8"),
        ] {
            assert_eq!(negotiate(text), Ok(Stated { format: Format::Json, schema: String::new() }), "{text:?}");
        }
    }

    #[test]
    fn postcard_names_its_message() {
        let stated = negotiate(Some("application/postcard;StepRequest/1")).expect("our own encoding");
        assert_eq!(stated, Stated { format: Format::Postcard, schema: "StepRequest/1".into() });
        assert_eq!(encoding_of::<StepRequest>(Format::Postcard), "application/postcard;StepRequest/1");
    }

    #[test]
    fn an_encoding_that_nobody_speaks_is_a_fault() {
        for text in ["application/cbor", "image/png", "application/postcardx"] {
            assert_eq!(negotiate(Some(text)).expect_err("refused").code, FaultCode::UnsupportedEncoding, "{text}");
        }
    }

    #[test]
    fn another_message_or_version_is_refused_before_reading() {
        let stated = Stated { format: Format::Postcard, schema: "StepRequest/2".into() };
        assert!(matches!(decode_stated::<StepRequest>(&[], &stated, 10), Err(DecodeError::OtherMessage { .. })));
    }

    #[test]
    fn numbers_that_json_lacks_survive_it() {
        let reply = LawReply {
            kind: "x".into(),
            overclosure: vec![f64::NEG_INFINITY, 1.5],
            pressure: vec![f64::NAN],
            ..Default::default()
        };
        let bytes = encode(&reply, Format::Json).expect("encodes");
        let back: LawReply = decode(&bytes, Format::Json, 1000).expect("decodes");
        assert_eq!(back.overclosure, reply.overclosure);
        assert!(back.pressure[0].is_nan());
    }

    #[test]
    fn arbitrary_bytes_are_an_error_and_not_a_panic() {
        // A fixed linear congruential sequence: the same bytes in every run.
        let mut seed = 0x2545_f491_4f6c_dd1d_u64;
        for length in 0..400 {
            let bytes: Vec<u8> = (0..length)
                .map(|_| {
                    seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                    (seed >> 56) as u8
                })
                .collect();
            for format in Format::ALL {
                let _ = decode::<StepRequest>(&bytes, format, 1 << 20);
                let _ = decode::<Fault>(&bytes, format, 1 << 20);
                let _ = decode::<crate::message::OpenReply>(&bytes, format, 1 << 20);
            }
        }
    }

    #[test]
    fn a_length_beyond_the_data_allocates_nothing_and_fails() {
        // kind "", then 2^62 overclosures that are not there.
        let bytes = [0, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x40];
        assert!(matches!(decode::<LawReply>(&bytes, Format::Postcard, 100), Err(DecodeError::Malformed { .. })));
        assert!(matches!(
            decode::<LawReply>(&[0; 101], Format::Postcard, 100),
            Err(DecodeError::TooLarge { limit: 100, .. })
        ));
    }
}
