//! `overclosure serve`: the daemon.
//!
//! Who runs where: zenoh hands queries to a bounded queue that [`dispatch`] always drains; [`desk`] answers the verbs of the
//! daemon on two threads; each session has a thread ([`session`]) that owns its simulation ([`work`]) and takes its requests
//! from a bounded queue ([`registry`]); [`frames`] publishes results from a task of its own. Nothing blocks or computes on a
//! thread of the transport.

mod config;
mod convert;
mod desk;
mod dispatch;
mod frames;
mod models;
mod registry;
mod reply;
mod sequence;
mod session;
mod work;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::time::{Duration, Instant};

use clap::Args;
use overclosure_client::network::{NetworkError, Side, zenoh_config, zenoh_text};
use overclosure_protocol::key;
use tokio::signal::unix::{SignalKind, signal};
use zenoh::handlers::FifoChannel;

use crate::cli::{Exit, complain, memory, print};
use config::Config;

/// Queries that may wait between the transport and the dispatcher, which only routes.
const DISPATCH_WAITING: usize = 1024;
/// How long the transport may take to close.
const CLOSE_SECONDS_MAX: u64 = 3;

/// Arguments of `overclosure serve`.
#[derive(Args)]
#[command(after_help = "\
Configuration file, with the defaults:
  listen = [\"tcp/127.0.0.1:7447\"]   # locators: tcp/HOST:PORT, unixsock-stream/PATH
  daemon = \"press-7\"                # id in the keys; random unless given
  cache = \"/var/cache/overclosure\"  # folder for prepared models; none unless given
  [limits]
  sessions = 16
  queue = 16                        # requests waiting per session; one more is refused as busy
  message_bytes = 67108864          # of one request, so also of a deck
  increments_per_request = 1000000
  law_points = 1000000
  replies_kept = 16                 # per session, for repeated requests
  threads = 2                       # that one session may ask for; those of the machine unless given
  memory_bytes = 4000000000         # of one preparation; what is left when it begins unless given
  idle_seconds = 3600.0             # a session without a request for so long is closed; 0: never
  [shutdown]
  drain_seconds = 10.0

The daemon has no authentication: it listens on this machine only unless told otherwise.")]
pub struct ServeArgs {
    /// Configuration file (TOML).
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Where to listen; replaces those of the configuration. May be repeated.
    #[arg(long, value_name = "LOCATOR")]
    listen: Vec<String>,
    /// Id of the daemon in its keys; replaces the one of the configuration.
    #[arg(long, value_name = "ID")]
    daemon: Option<String>,
    /// Most memory that one preparation may take, e.g. 4G; replaces the one of the configuration [default: what is left then].
    #[arg(long, value_name = "SIZE", value_parser = memory::parse_size)]
    memory_limit: Option<u64>,
    /// Directory in which prepared models are kept; replaces the one of the configuration.
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// Folder for session journals. Not available in this version.
    #[arg(long, value_name = "DIR")]
    state_dir: Option<PathBuf>,
}

/// Why the daemon could not run.
#[derive(Debug, thiserror::Error)]
enum ServeError {
    #[error("cannot start: {source}")]
    System {
        #[from]
        source: std::io::Error,
    },
    #[error(transparent)]
    Network(#[from] NetworkError),
    #[error(
        "cannot listen on {endpoints}: {}; is another daemon running there? --listen chooses another endpoint",
        zenoh_text(source)
    )]
    Listen { endpoints: String, source: zenoh::Error },
    #[error("cannot declare {key}: {}", zenoh_text(source))]
    Declare { key: String, source: zenoh::Error },
}

/// What all parts of the daemon share.
struct Shared {
    id: String,
    config: Config,
    registry: registry::Registry,
    models: models::Models,
    frames: frames::FrameSender,
    desk: desk::Desk,
    /// Held by every session thread: the count tells how many live.
    threads: Arc<()>,
    started: Instant,
    increments: Arc<AtomicU64>,
    steps: Arc<AtomicU64>,
    sessions_failed: AtomicU64,
    /// Timers for session threads.
    runtime: tokio::runtime::Handle,
}

/// Runs the verb.
pub fn run(arguments: ServeArgs) -> Exit {
    if let Some(folder) = &arguments.state_dir {
        complain(&format!(
            "error: --state-dir {}: this version keeps no journal, so sessions would not survive a restart; leave the option out, and use \
             checkpoint and restore from the client",
            folder.display()
        ));
        return Exit::InputWrong;
    }
    let config = match configuration(arguments) {
        Ok(config) => config,
        Err(error) => {
            complain(&format!("error: {error}"));
            return Exit::InputWrong;
        }
    };
    let runtime = match tokio::runtime::Builder::new_multi_thread().worker_threads(2).enable_all().build() {
        Ok(runtime) => runtime,
        Err(error) => {
            complain(&format!("error: cannot start: {error}"));
            return Exit::OurFailure;
        }
    };
    let outcome = runtime.block_on(serve(config));
    runtime.shutdown_timeout(Duration::from_secs(1));
    match outcome {
        Ok(()) => Exit::Done,
        Err(error) => {
            complain(&format!("error: {error}"));
            Exit::OurFailure
        }
    }
}

fn configuration(arguments: ServeArgs) -> Result<Config, config::ConfigError> {
    let ServeArgs { config, listen, daemon, memory_limit, cache, state_dir: _ } = arguments;
    let mut config = config.as_deref().map_or_else(|| Ok(Config::default()), Config::read)?;
    if !listen.is_empty() {
        config.listen = listen;
    }
    config.daemon = daemon.or(config.daemon);
    config.cache = cache.or(config.cache);
    config.limits.memory_bytes = memory_limit.or(config.limits.memory_bytes);
    config.validate()?;
    Ok(config)
}

async fn serve(config: Config) -> Result<(), ServeError> {
    let (mut terminate, mut interrupt) = (signal(SignalKind::terminate())?, signal(SignalKind::interrupt())?);
    let settings = zenoh_config(&Side::Daemon { listen: config.listen.clone() }, config.transport_bytes_max())?;
    let session = zenoh::open(settings)
        .await
        .map_err(|source| ServeError::Listen { endpoints: config.listen.join(", "), source })?;

    let random = session.zid().to_string();
    let (frames, frame_receiver) = frames::channel();
    let (desk, desk_threads) = desk::Desk::new();
    let shared = Arc::new(Shared {
        id: config.daemon.clone().unwrap_or_else(|| chunk(&random, 0, 8)),
        registry: registry::Registry::new(chunk(&random, 8, 4), config.limits.sessions, config.limits.queue),
        models: models::Models::new(config.limits.memory_bytes, config.cache.clone()),
        frames,
        desk,
        threads: Arc::new(()),
        started: Instant::now(),
        increments: Arc::default(),
        steps: Arc::default(),
        sessions_failed: AtomicU64::new(0),
        runtime: tokio::runtime::Handle::current(),
        config,
    });
    desk_threads.spawn(&shared)?;
    tokio::spawn(frames::publish(session.clone(), frame_receiver));

    let key = key::everything(&shared.id);
    let queryable = session.declare_queryable(&key).complete(true).with(FifoChannel::new(DISPATCH_WAITING)).await;
    let queryable = queryable.map_err(|source| ServeError::Declare { key, source })?;
    tokio::spawn(dispatch::run(queryable, shared.clone()));
    // Last: who sees the token may ask.
    let key = key::live(&shared.id);
    let token = session.liveliness().declare_token(&key).await.map_err(|source| ServeError::Declare { key, source })?;

    let bound = bound(&session).await;
    // Nobody has to read it. The log does not say it again.
    let _ =
        print(&format!("overclosure {} ready: daemon {} listens on {bound}\n", env!("CARGO_PKG_VERSION"), shared.id));

    let signal = tokio::select! { _ = terminate.recv() => "SIGTERM", _ = interrupt.recv() => "SIGINT" };
    tracing::info!(signal, "shutting down");
    drop(token);
    drain(&shared).await;
    if tokio::time::timeout(Duration::from_secs(CLOSE_SECONDS_MAX), session.close()).await.is_err() {
        tracing::warn!("the transport did not close in time");
    }
    tracing::info!("stopped");
    Ok(())
}

/// Locators with the ports actually bound.
async fn bound(session: &zenoh::Session) -> String {
    session.info().locators().await.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

/// A piece of a random hexadecimal id.
fn chunk(random: &str, from: usize, length: usize) -> String {
    let digits: String = random.chars().skip(from).take(length).collect();
    // zenoh leaves out leading zeros, so that a short id is possible, if unlikely.
    format!("{digits:0>length$}")
}

/// Lets running requests finish, for a bounded time.
async fn drain(shared: &Shared) {
    const PAUSE: Duration = Duration::from_millis(10);
    shared.registry.drain();
    let deadline = Instant::now() + Duration::from_secs_f64(shared.config.shutdown.drain_seconds);
    while Arc::strong_count(&shared.threads) > 1 || !shared.frames.is_empty() {
        if Instant::now() >= deadline {
            let sessions = Arc::strong_count(&shared.threads) - 1;
            tracing::warn!(sessions, "sessions did not finish in time; their requests stay unanswered");
            return;
        }
        tokio::time::sleep(PAUSE).await;
    }
}
