//! Key expressions: `overclosure/v1/{daemon}/...`, built and parsed.

use std::fmt;

/// Verbs of a daemon: `overclosure/v1/{daemon}/{verb}`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DaemonVerb {
    /// Who answers, in which version, with which limits.
    Info,
    /// Whether it is well.
    Health,
    /// How busy it is, and its sessions.
    Load,
    /// Fields of every message.
    Schema,
    /// Stateless law evaluation.
    Law,
    /// Opens a session.
    Open,
}

impl DaemonVerb {
    /// All of them, in the order of the documentation.
    pub const ALL: [Self; 6] = [Self::Info, Self::Health, Self::Load, Self::Schema, Self::Law, Self::Open];

    /// Last chunk of the key.
    pub fn name(self) -> &'static str {
        match self {
            Self::Info => "info",
            Self::Health => "health",
            Self::Load => "load",
            Self::Schema => "schema",
            Self::Law => "law",
            Self::Open => "open",
        }
    }
}

/// Verbs of a session: `overclosure/v1/{daemon}/s/{session}/{verb}`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SessionVerb {
    /// Inputs and outputs.
    Ports,
    /// Sets inputs and advances.
    Step,
    /// Present values by name.
    Get,
    /// A field.
    Field,
    /// The state as bytes.
    Checkpoint,
    /// Returns to a state.
    Restore,
    /// Steps so far, work and findings.
    Report,
    /// Ends the session.
    Close,
}

impl SessionVerb {
    /// All of them, in the order of the documentation.
    pub const ALL: [Self; 8] =
        [Self::Ports, Self::Step, Self::Get, Self::Field, Self::Checkpoint, Self::Restore, Self::Report, Self::Close];

    /// Last chunk of the key.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ports => "ports",
            Self::Step => "step",
            Self::Get => "get",
            Self::Field => "field",
            Self::Checkpoint => "checkpoint",
            Self::Restore => "restore",
            Self::Report => "report",
            Self::Close => "close",
        }
    }
}

/// What a query key asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// A verb of the daemon. The daemon chunk of the query may be a wildcard, except for `open`.
    Daemon(DaemonVerb),
    /// A verb of a session.
    Session {
        /// The session id.
        session: String,
        /// The verb.
        verb: SessionVerb,
    },
}

/// Why a query key is refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum KeyError {
    /// A wildcard where exactly one thing must be meant.
    #[error("the key {key} holds a wildcard where one daemon, one session and one verb must be named")]
    Wildcard {
        /// The key as received.
        key: String,
    },
    /// No such verb.
    #[error("no verb at {key}; a daemon answers {}, a session answers {}", names(DaemonVerb::ALL.map(DaemonVerb::name).as_slice()), names(SessionVerb::ALL.map(SessionVerb::name).as_slice()))]
    UnknownVerb {
        /// The key as received.
        key: String,
    },
}

fn names(list: &[&str]) -> String {
    list.join("|")
}

/// Reads the key of a query.
///
/// A wildcard is accepted only in the daemon chunk of a verb that changes nothing (`info`, `health`, `load`, `schema`, `law`).
pub fn parse(key: &str) -> Result<Target, KeyError> {
    let wild = |text: &str| text.contains('*');
    let chunks: Vec<&str> = key.split('/').collect();
    let unknown = || KeyError::UnknownVerb { key: key.to_owned() };
    let wildcard = || KeyError::Wildcard { key: key.to_owned() };
    match chunks.as_slice() {
        ["overclosure", "v1", daemon, verb] if !wild(verb) && *daemon != "**" => {
            let verb = DaemonVerb::ALL.into_iter().find(|v| v.name() == *verb).ok_or_else(unknown)?;
            if verb == DaemonVerb::Open && wild(daemon) {
                return Err(wildcard());
            }
            Ok(Target::Daemon(verb))
        }
        _ if wild(key) => Err(wildcard()),
        ["overclosure", "v1", _, "s", session, verb] => {
            let verb = SessionVerb::ALL.into_iter().find(|v| v.name() == *verb).ok_or_else(unknown)?;
            Ok(Target::Session { session: (*session).to_owned(), verb })
        }
        _ => Err(unknown()),
    }
}

/// `overclosure/live/v1/{daemon}`: the liveliness token.
pub fn live(daemon: &str) -> String {
    format!("overclosure/live/v1/{daemon}")
}

/// `overclosure/v1/{daemon}/**`: everything that a daemon answers.
pub fn everything(daemon: &str) -> String {
    format!("overclosure/v1/{daemon}/**")
}

/// `overclosure/v1/{daemon}/{verb}`. `*` as the daemon asks whichever answers.
pub fn daemon(daemon: &str, verb: DaemonVerb) -> String {
    format!("overclosure/v1/{daemon}/{}", verb.name())
}

/// `overclosure/v1/{daemon}/s/{session}/{verb}`.
pub fn session(daemon: &str, session: &str, verb: SessionVerb) -> String {
    format!("overclosure/v1/{daemon}/s/{session}/{}", verb.name())
}

/// `overclosure/v1/{daemon}/s/{session}/frame/{field}`: results published per increment.
pub fn frame(daemon: &str, session: &str, field: &str) -> String {
    format!("overclosure/v1/{daemon}/s/{session}/frame/{field}")
}

/// Field name of the frames that hold the output vector.
pub const OUTPUTS_FRAME: &str = "outputs";

/// Longest daemon id.
pub const ID_LENGTH_MAX: usize = 64;

/// Why a text cannot be an id.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IdError {
    /// The text.
    pub text: String,
}

impl fmt::Display for IdError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} cannot be an id: 1 to {ID_LENGTH_MAX} letters, digits, '-' and '_' are allowed", self.text)
    }
}

impl std::error::Error for IdError {}

/// Checks that a text can stand as one chunk of a key: 1 to 64 ASCII letters, digits, `-` and `_`.
pub fn check_id(text: &str) -> Result<(), IdError> {
    let fits = (1..=ID_LENGTH_MAX).contains(&text.len());
    if fits && text.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'-' || b == b'_') {
        Ok(())
    } else {
        Err(IdError { text: text.to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_key_parses_back() {
        for verb in DaemonVerb::ALL {
            assert_eq!(parse(&daemon("d1", verb)), Ok(Target::Daemon(verb)));
        }
        for verb in SessionVerb::ALL {
            assert_eq!(parse(&session("d1", "7", verb)), Ok(Target::Session { session: "7".into(), verb }));
        }
    }

    #[test]
    fn a_wildcard_daemon_is_accepted_where_nothing_changes() {
        for verb in DaemonVerb::ALL {
            let parsed = parse(&daemon("*", verb));
            assert_eq!(parsed.is_ok(), verb != DaemonVerb::Open, "{verb:?}");
        }
    }

    #[test]
    fn wildcards_that_could_mean_several_sessions_are_refused() {
        for key in [
            "overclosure/v1/*/s/*/step",
            "overclosure/v1/d1/s/*/close",
            "overclosure/v1/*/s/7/step",
            "overclosure/v1/d1/s/7/*",
            "overclosure/**",
            "overclosure/v1/**",
            "overclosure/v1/**/info",
            "overclosure/v1/d1/s/a$*/step",
        ] {
            assert!(matches!(parse(key), Err(KeyError::Wildcard { .. })), "{key}");
        }
    }

    #[test]
    fn keys_without_a_verb_are_unknown() {
        for key in [
            "overclosure/v1/d1/fly",
            "overclosure/v1/d1/s/7",
            "overclosure/v1/d1/s/7/frame/U",
            "overclosure/v2/d1/info",
        ] {
            assert!(matches!(parse(key), Err(KeyError::UnknownVerb { .. })), "{key}");
        }
    }

    #[test]
    fn ids_are_single_chunks() {
        assert!(check_id("press-7_a").is_ok());
        for text in ["", "a/b", "*", "a b", "é", &"x".repeat(65)] {
            assert!(check_id(text).is_err(), "{text}");
        }
    }
}
