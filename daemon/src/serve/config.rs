//! Configuration of the daemon: a TOML file, overridden by the command line, validated as a whole.

use std::path::{Path, PathBuf};
use std::time::Duration;

use overclosure_client::network::check_locator;
use overclosure_protocol::DEFAULT_ENDPOINT;
use overclosure_protocol::key::check_id;
use overclosure_protocol::message::Limits;
use serde::Deserialize;

/// A year.
const IDLE_SECONDS_MAX: f64 = 31_536_000.0;

/// What a configuration file may say. Every field has a default; unknown fields are refused.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// Locators to bind. Default `["tcp/127.0.0.1:7447"]`: this machine only. There is no authentication, so bind other
    /// addresses only in a network that you trust.
    pub listen: Vec<String>,
    /// Id of the daemon in its keys, 1 to 64 letters, digits, `-`, `_`. Default: random, new at every start.
    pub daemon: Option<String>,
    /// Directory in which prepared models are kept, so that a deck that was open before opens at once. Nothing is ever
    /// removed from it. Default: none.
    pub cache: Option<PathBuf>,
    /// Limits.
    pub limits: LimitsConfig,
    /// Shutdown.
    pub shutdown: ShutdownConfig,
}

/// `[limits]`.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct LimitsConfig {
    /// Sessions open at the same time; each has a thread. Default 16, range 1 to 1024.
    pub sessions: u32,
    /// Requests that may wait for one session. Default 16, range 1 to 1024.
    pub queue: u32,
    /// Bytes of one request, so also of a deck. Default 64 MiB, range 64 KiB to 1 GiB.
    pub message_bytes: u64,
    /// Increments that one step request may take. Default 1 000 000, at least 1.
    pub increments_per_request: u32,
    /// Overclosures in one law request. Default 1 000 000, range 1 to 10 000 000.
    pub law_points: u32,
    /// Replies to step and restore kept per session for repeated requests. Default 16, range 1 to 1024.
    pub replies_kept: u32,
    /// Threads that one session may ask for. Default: those of the machine; range 1 to 1024.
    pub threads: u32,
    /// Bytes that the preparation of one model may take. Default: what is left on the machine, or in the control group, when it
    /// begins; at least 1.
    pub memory_bytes: Option<u64>,
    /// Seconds without a request after which a session is closed; 0: never. Default 3600, otherwise 0.1 to 31 536 000
    /// (a year).
    pub idle_seconds: f64,
}

/// `[shutdown]`.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct ShutdownConfig {
    /// Seconds that running requests may take to end after SIGTERM or SIGINT. Default 10, range 0 to 3600.
    pub drain_seconds: f64,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            listen: vec![DEFAULT_ENDPOINT.to_owned()],
            daemon: None,
            cache: None,
            limits: LimitsConfig::default(),
            shutdown: ShutdownConfig::default(),
        }
    }
}

impl Default for LimitsConfig {
    fn default() -> Self {
        let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
        Self {
            sessions: 16,
            queue: 16,
            message_bytes: 64 << 20,
            increments_per_request: 1_000_000,
            law_points: 1_000_000,
            replies_kept: 16,
            threads: u32::try_from(threads).unwrap_or(1).min(1024),
            memory_bytes: None,
            idle_seconds: 3600.0,
        }
    }
}

impl Default for ShutdownConfig {
    fn default() -> Self {
        Self { drain_seconds: 10.0 }
    }
}

/// Why a configuration is refused.
#[derive(Debug, thiserror::Error)]
pub enum ConfigError {
    /// The file cannot be read.
    #[error("cannot read the configuration {path}: {source}")]
    Read {
        /// The file.
        path: String,
        /// Why.
        source: std::io::Error,
    },
    /// It is not TOML, or has fields that do not exist.
    #[error("the configuration {path} is wrong: {source}")]
    Parse {
        /// The file.
        path: String,
        /// Where and why.
        source: Box<toml::de::Error>,
    },
    /// Values that do not fit; all of them.
    #[error("the configuration is wrong:\n{}", findings.iter().map(|f| format!("  {f}")).collect::<Vec<_>>().join("\n"))]
    Values {
        /// One line each.
        findings: Vec<String>,
    },
}

impl Config {
    /// Reads a file.
    pub fn read(path: &Path) -> Result<Self, ConfigError> {
        let name = path.display().to_string();
        let text = std::fs::read_to_string(path).map_err(|source| ConfigError::Read { path: name.clone(), source })?;
        toml::from_str(&text).map_err(|source| ConfigError::Parse { path: name, source: Box::new(source) })
    }

    /// Checks all values together.
    pub fn validate(&self) -> Result<(), ConfigError> {
        let mut findings = Vec::new();
        let mut range = |name: &str, value: u64, low: u64, high: u64| {
            if !(low..=high).contains(&value) {
                findings.push(format!("limits.{name} = {value}: must lie between {low} and {high}"));
            }
        };
        let limits = &self.limits;
        range("sessions", limits.sessions.into(), 1, 1024);
        range("queue", limits.queue.into(), 1, 1024);
        range("message_bytes", limits.message_bytes, 64 << 10, 1 << 30);
        range("increments_per_request", limits.increments_per_request.into(), 1, u32::MAX.into());
        range("law_points", limits.law_points.into(), 1, 10_000_000);
        range("replies_kept", limits.replies_kept.into(), 1, 1024);
        range("threads", limits.threads.into(), 1, 1024);
        if limits.memory_bytes == Some(0) {
            findings.push("limits.memory_bytes = 0: must be at least 1".to_owned());
        }
        if limits.idle_seconds != 0.0 && !(0.1..=IDLE_SECONDS_MAX).contains(&limits.idle_seconds) {
            findings.push(format!(
                "limits.idle_seconds = {}: must be 0 (never) or lie between 0.1 and {IDLE_SECONDS_MAX}",
                limits.idle_seconds
            ));
        }
        if !(0.0..=3600.0).contains(&self.shutdown.drain_seconds) {
            findings
                .push(format!("shutdown.drain_seconds = {}: must lie between 0 and 3600", self.shutdown.drain_seconds));
        }
        if self.listen.is_empty() {
            findings.push("listen is empty: nobody could reach the daemon".to_owned());
        }
        findings.extend(self.listen.iter().filter_map(|l| check_locator(l).err()).map(|e| format!("listen: {e}")));
        if let Some(Err(error)) = self.daemon.as_deref().map(check_id) {
            findings.push(format!("daemon: {error}"));
        }
        if findings.is_empty() { Ok(()) } else { Err(ConfigError::Values { findings }) }
    }

    /// Largest message that the transport lets through. Twice the limit, so that a request somewhat too large is answered
    /// with a fault and not dropped unseen.
    pub fn transport_bytes_max(&self) -> u64 {
        2 * self.limits.message_bytes + (1 << 20)
    }
}

impl LimitsConfig {
    /// As clients see them.
    pub fn to_message(&self) -> Limits {
        let Self {
            sessions,
            queue,
            message_bytes,
            increments_per_request,
            law_points,
            replies_kept,
            threads,
            // What a client asks for decides; the refusal names it.
            memory_bytes: _,
            idle_seconds,
        } = *self;
        Limits {
            sessions,
            queue,
            message_bytes,
            increments_per_request,
            law_points,
            replies_kept,
            threads,
            idle_seconds,
        }
    }

    /// How long a session may go without a request; `None`: for ever.
    pub fn idle_max(&self) -> Option<Duration> {
        (self.idle_seconds > 0.0).then(|| Duration::from_secs_f64(self.idle_seconds))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_valid_and_local() {
        let config = Config::default();
        assert!(config.validate().is_ok());
        assert_eq!(config.listen, ["tcp/127.0.0.1:7447"]);
        assert_eq!(toml::from_str::<Config>("").expect("an empty file"), config);
    }

    #[test]
    fn all_findings_come_at_once() {
        let text = "listen = [\"nowhere\"]\ndaemon = \"a/b\"\n[limits]\nqueue = 0\nmessage_bytes = 1\nidle_seconds = nan\n[shutdown]\ndrain_seconds = -1.0";
        let config: Config = toml::from_str(text).expect("well-formed");
        match config.validate() {
            Err(ConfigError::Values { findings }) => assert_eq!(findings.len(), 6, "{findings:?}"),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn an_idle_limit_of_zero_means_never() {
        let limits = |text: &str| toml::from_str::<Config>(text).expect("well-formed");
        assert_eq!(limits("").limits.idle_max(), Some(Duration::from_secs(3600)));
        let never = limits("[limits]\nidle_seconds = 0.0");
        assert!(never.validate().is_ok());
        assert_eq!(never.limits.idle_max(), None);
        for bad in ["-1.0", "0.01", "inf", "1e9"] {
            assert!(limits(&format!("[limits]\nidle_seconds = {bad}")).validate().is_err(), "{bad}");
        }
    }

    #[test]
    fn a_misspelt_field_is_refused() {
        assert!(toml::from_str::<Config>("[limits]\nsesions = 3").is_err());
    }
}
