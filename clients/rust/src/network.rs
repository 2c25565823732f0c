//! All configuration of zenoh: the daemon and the clients of this product use nothing else.

use zenoh::Config;
use zenoh::config::EndPoint;

/// Which side of a connection to configure.
#[derive(Clone, Debug)]
pub enum Side {
    /// Listens; answers queries.
    Daemon {
        /// Locators to bind.
        listen: Vec<String>,
    },
    /// Connects; asks.
    Client {
        /// Locators to try.
        connect: Vec<String>,
        /// Milliseconds to keep trying before giving up.
        timeout_ms: u64,
    },
}

/// Why a configuration is refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NetworkError {
    /// Not a locator.
    #[error(
        "{locator:?} is not a locator such as tcp/127.0.0.1:7447 or unixsock-stream//run/overclosure.sock: {detail}"
    )]
    Locator {
        /// The text.
        locator: String,
        /// What does not fit.
        detail: String,
    },
    /// A setting that this version of zenoh does not take: a defect of this product.
    #[error("zenoh does not take the setting {key} = {value}: {detail}")]
    Setting {
        /// Name.
        key: &'static str,
        /// Value.
        value: String,
        /// What zenoh says.
        detail: String,
    },
}

/// What zenoh says, without the places in its source code that it adds (` at /…/tcp.rs:61.`).
pub fn zenoh_text(error: &zenoh::Error) -> String {
    let text = error.to_string();
    let mut plain = String::new();
    let mut rest = text.as_str();
    while let Some(at) = rest.find(" at /") {
        plain += &rest[..at];
        let place = &rest[at + 4..];
        // The place ends with `.rs:LINE.`; anything else is text of its own and stays.
        match place.find(".rs:").map(|rs| (rs, place[rs + 4..].find('.'))) {
            Some((rs, Some(dot))) if !place[..rs].contains(' ') => rest = &place[rs + 4 + dot + 1..],
            _ => {
                plain += " at ";
                rest = place;
            }
        }
    }
    plain + rest
}

/// Checks that a text is a locator of a transport that is compiled in.
pub fn check_locator(locator: &str) -> Result<(), NetworkError> {
    let refuse = |detail: String| NetworkError::Locator { locator: locator.to_owned(), detail };
    let endpoint: EndPoint = locator.parse().map_err(|e: zenoh::Error| refuse(zenoh_text(&e)))?;
    match endpoint.protocol().as_str() {
        "tcp" | "unixsock-stream" => Ok(()),
        other => Err(refuse(format!("the transport {other} is not available; tcp and unixsock-stream are"))),
    }
}

/// The configuration of one side. Messages above `message_bytes_max` are dropped unseen by the receiving side.
///
/// No scouting, no gossip: endpoints are explicit, and nothing is sent to the local network.
pub fn zenoh_config(side: &Side, message_bytes_max: u64) -> Result<Config, NetworkError> {
    let (mode, listen, connect): (&str, &[String], &[String]) = match side {
        Side::Daemon { listen } => ("peer", listen, &[]),
        Side::Client { connect, .. } => ("client", &[], connect),
    };
    for locator in listen.iter().chain(connect) {
        check_locator(locator)?;
    }
    let mut config = Config::default();
    let mut set = |key: &'static str, value: String| {
        config.insert_json5(key, &value).map_err(|e| NetworkError::Setting {
            key,
            value: value.clone(),
            detail: zenoh_text(&e),
        })
    };
    set("mode", format!("{mode:?}"))?;
    set("scouting/multicast/enabled", "false".into())?;
    set("scouting/gossip/enabled", "false".into())?;
    set("listen/endpoints", format!("{listen:?}"))?;
    set("connect/endpoints", format!("{connect:?}"))?;
    if let Side::Client { timeout_ms, .. } = side {
        set("connect/timeout_ms", timeout_ms.to_string())?;
    }
    // How soon a client finds a restarted daemon. Only the whole object is accepted.
    set("connect/retry", "{ period_init_ms: 200, period_max_ms: 2000, period_increase_factor: 2 }".into())?;
    // A frozen peer is noticed after this; a killed one at once. Long enough for a machine busy with solving.
    set("transport/link/tx/lease", "5000".into())?;
    set("transport/link/rx/max_message_size", message_bytes_max.to_string())?;
    Ok(config)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_sides_are_taken_by_this_version_of_zenoh() {
        let client = Side::Client { connect: vec!["tcp/127.0.0.1:7447".into()], timeout_ms: 100 };
        let daemon = Side::Daemon { listen: vec!["tcp/127.0.0.1:0".into(), "unixsock-stream//tmp/o.sock".into()] };
        for side in [client, daemon] {
            assert!(zenoh_config(&side, 1 << 20).is_ok(), "{side:?}");
        }
    }

    #[test]
    fn places_in_source_code_are_left_out() {
        let text = "no [in use (error 98) at /x/link-1.1/src/tcp.rs:61.] at /y/uni.rs:338.; look at /tmp/a b.rs";
        let error: zenoh::Error = text.into();
        assert_eq!(zenoh_text(&error), "no [in use (error 98)]; look at /tmp/a b.rs");
    }

    #[test]
    fn texts_that_are_no_locators_are_refused() {
        for text in ["", "127.0.0.1:7447", "udp/127.0.0.1:7447", "tcp/"] {
            assert!(matches!(check_locator(text), Err(NetworkError::Locator { .. })), "{text}");
        }
    }
}
