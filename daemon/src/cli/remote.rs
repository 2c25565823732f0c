//! Client verbs against a daemon: `sessions`, `step`, `get`, `watch`.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use overclosure_client::blocking::{Client, Session};
use overclosure_client::{
    CallError, Dialect, FaultCode, Frame, InputValue, OpenRequest, Options, SolverPath, StepRequest, StepStatus,
};
use overclosure_packer::inline;
use overclosure_protocol::DEFAULT_ENDPOINT;

use super::open::read_ports;
use super::{DialectArg, Exit, PathArg, complain, print};

/// Verbs that talk to a daemon.
#[derive(Subcommand)]
pub enum RemoteCommand {
    /// Lists, opens and closes the sessions of a daemon.
    Sessions(SessionsArgs),
    /// Sets inputs and advances a session.
    Step(StepArgs),
    /// Reads ports or a field of a session.
    Get(GetArgs),
    /// Follows the results of a session until it ends.
    Watch(WatchArgs),
}

/// Which daemon.
#[derive(Args)]
pub struct ConnectArgs {
    /// Where the daemon listens.
    #[arg(long, value_name = "LOCATOR", default_value = DEFAULT_ENDPOINT)]
    connect: String,
    /// Id of the daemon; the one that answers unless given.
    #[arg(long, value_name = "ID")]
    daemon: Option<String>,
}

/// Arguments of `overclosure sessions`.
#[derive(Args)]
pub struct SessionsArgs {
    #[command(flatten)]
    connect: ConnectArgs,
    /// Opens a session of this deck, with the files that it includes, and prints its id.
    #[arg(long, value_name = "DECK", conflicts_with_all = ["close", "close_all"])]
    open: Option<PathBuf>,
    /// What keywords mean where codes disagree, for --open.
    #[arg(long, requires = "open")]
    dialect: Option<DialectArg>,
    /// Solver path, for --open.
    #[arg(long, requires = "open")]
    path: Option<PathArg>,
    /// Names and units of ports, for --open [default: DECKNAME.ports.toml or ports.toml beside the deck, if there is one].
    #[arg(long, requires = "open", value_name = "FILE")]
    ports: Option<PathBuf>,
    /// Ends these sessions.
    #[arg(long, value_name = "SESSION", num_args = 1.., conflicts_with = "close_all")]
    close: Vec<String>,
    /// Ends all sessions of the daemon.
    #[arg(long)]
    close_all: bool,
}

/// Arguments of `overclosure step`.
#[derive(Args)]
pub struct StepArgs {
    #[command(flatten)]
    connect: ConnectArgs,
    /// Id of the session.
    session: String,
    /// Total time to reach.
    #[arg(long)]
    time: f64,
    /// Actual value of an input at that time. May be repeated.
    #[arg(long = "set", value_name = "PORT=VALUE")]
    inputs: Vec<String>,
    /// Fields to publish at each increment for `watch --field`: CPRESS, U, ...; several with commas. The outputs always are.
    #[arg(long, value_name = "FIELD", value_delimiter = ',')]
    frames: Vec<String>,
}

/// Arguments of `overclosure get`.
#[derive(Args)]
pub struct GetArgs {
    #[command(flatten)]
    connect: ConnectArgs,
    /// Id of the session.
    session: String,
    /// Ports to read; all unless given.
    ports: Vec<String>,
    /// A field instead: U, RF, S, CPRESS, COPEN, ...
    #[arg(long, conflicts_with = "ports")]
    field: Option<String>,
}

/// Arguments of `overclosure watch`.
#[derive(Args)]
pub struct WatchArgs {
    #[command(flatten)]
    connect: ConnectArgs,
    /// Id of the session.
    session: String,
    /// A field instead of the outputs; published for steps that ask for it with --frames.
    #[arg(long)]
    field: Option<String>,
    /// Ends after so many frames.
    #[arg(long)]
    count: Option<u64>,
}

/// Why a verb ends early: told, or to be told.
enum Failure {
    Call(CallError),
    Told(Exit),
}

impl From<CallError> for Failure {
    fn from(error: CallError) -> Self {
        Self::Call(error)
    }
}

impl From<Exit> for Failure {
    fn from(exit: Exit) -> Self {
        Self::Told(exit)
    }
}

/// Runs the verb.
pub fn run(command: RemoteCommand) -> Exit {
    let outcome = match command {
        RemoteCommand::Sessions(arguments) => sessions(arguments),
        RemoteCommand::Step(arguments) => step(&arguments),
        RemoteCommand::Get(arguments) => get(&arguments),
        RemoteCommand::Watch(arguments) => watch(&arguments),
    };
    match outcome {
        Ok(exit) | Err(Failure::Told(exit)) => exit,
        Err(Failure::Call(error)) => report(&error),
    }
}

/// A refusal of what the user asked exits 2; everything else is ours.
fn report(error: &CallError) -> Exit {
    complain(&format!("error: {error}"));
    let CallError::Fault(fault) = error else { return Exit::OurFailure };
    match fault.code {
        FaultCode::BadRequest
        | FaultCode::TooLarge
        | FaultCode::UnknownSession
        | FaultCode::UnknownPort
        | FaultCode::UnknownField
        | FaultCode::NotFinite
        | FaultCode::TimeInPast
        | FaultCode::DeckRefused
        | FaultCode::LawRefused
        | FaultCode::CheckpointRefused => Exit::InputWrong,
        FaultCode::PreloadStopped => Exit::NotConverged,
        FaultCode::UnsupportedEncoding
        | FaultCode::UnknownVerb
        | FaultCode::WildcardKey
        | FaultCode::SequenceGap
        | FaultCode::SequenceExpired
        | FaultCode::SequenceConflict
        | FaultCode::Busy
        | FaultCode::LimitExceeded
        | FaultCode::SessionFailed
        | FaultCode::ShuttingDown
        | FaultCode::Internal => Exit::OurFailure,
    }
}

fn connect(arguments: &ConnectArgs) -> Result<Client, CallError> {
    let options =
        Options { endpoint: arguments.connect.clone(), daemon: arguments.daemon.clone(), ..Options::default() };
    Client::connect(options)
}

fn sessions(arguments: SessionsArgs) -> Result<Exit, Failure> {
    if let Some(path) = &arguments.open {
        return open(path, &arguments);
    }
    let client = connect(&arguments.connect)?;
    if !arguments.close.is_empty() {
        return Ok(close(&client, &arguments.close));
    }
    let load = client.load()?;
    if arguments.close_all {
        let ids: Vec<String> = load.sessions.into_iter().map(|s| s.session).collect();
        return Ok(close(&client, &ids));
    }
    let mut text = format!(
        "{:<12} {:>10} {:>8} {:>8} {:>10} {:>24}  {}\n",
        "session", "sequence", "working", "waiting", "idle [s]", "time", "label"
    );
    for s in &load.sessions {
        let working = if s.working { "yes" } else { "no" };
        text += &format!(
            "{:<12} {:>10} {working:>8} {:>8} {:>10.1} {:>24}  {}\n",
            s.session, s.sequence_next, s.waiting, s.idle_seconds, s.time, s.label
        );
    }
    text += &format!("{} open, {} free, {} models in memory\n", load.sessions.len(), load.sessions_free, load.models);
    let idle_max = client.info().limits.idle_seconds;
    if idle_max > 0.0 {
        text += &format!("a session without a request for {idle_max} s is closed\n");
    }
    print(&text)?;
    Ok(Exit::Done)
}

/// Ends each session that can be ended, and complains about the others.
fn close(client: &Client, sessions: &[String]) -> Exit {
    let failures = sessions.iter().filter_map(|session| client.close_session(session).err());
    // The last one decides, unless an earlier one was ours.
    failures.map(|error| report(&error)).fold(Exit::Done, |all, one| if all == Exit::OurFailure { all } else { one })
}

fn open(path: &std::path::Path, arguments: &SessionsArgs) -> Result<Exit, Failure> {
    // The text goes over a wire, where it has no folder.
    let deck = match inline::inline(path) {
        Ok(deck) => deck,
        Err(error) => {
            complain(&format!("error: {error}"));
            return Ok(Exit::InputWrong);
        }
    };
    let ports_toml = read_ports(arguments.ports.as_deref(), path)?;
    let request = OpenRequest {
        ports_toml,
        label: path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned()),
        dialect: match arguments.dialect {
            None | Some(DialectArg::Abaqus) => Dialect::Abaqus,
            Some(DialectArg::Calculix) => Dialect::Calculix,
        },
        path: match arguments.path {
            None | Some(PathArg::Auto) => SolverPath::Auto,
            Some(PathArg::Dense) => SolverPath::Dense,
            Some(PathArg::Sparse) => SolverPath::Sparse,
        },
        deck,
        ..OpenRequest::default()
    };
    let client = connect(&arguments.connect)?;
    let session = client.open(request)?;
    for warning in &session.opened().warnings {
        complain(&warning.to_string());
    }
    print(&format!("{}\n", session.id()))?;
    Ok(Exit::Done)
}

fn step(arguments: &StepArgs) -> Result<Exit, Failure> {
    let mut inputs = Vec::new();
    for text in &arguments.inputs {
        let parsed = text
            .split_once('=')
            .and_then(|(name, value)| Some(InputValue { name: name.to_owned(), value: value.trim().parse().ok()? }));
        let Some(input) = parsed else {
            complain(&format!("error: --set {text}: not of the form PORT=VALUE with a number"));
            return Ok(Exit::InputWrong);
        };
        inputs.push(input);
    }
    let client = connect(&arguments.connect)?;
    let mut session = client.attach(&arguments.session)?;
    let reply = session.step(StepRequest {
        time: arguments.time,
        inputs,
        frames: arguments.frames.clone(),
        ..StepRequest::default()
    })?;
    let counts = &reply.counts;
    let mut text = format!(
        "time {}\nincrements {}\nsevere_discontinuity_iterations {}\nequilibrium_iterations {}\n\
         cutbacks {}\naugmentations {}\nimpacts {}\n",
        reply.time,
        counts.increments,
        counts.severe_discontinuity_iterations,
        counts.equilibrium_iterations,
        counts.cutbacks,
        counts.augmentations,
        counts.impacts
    );
    for (port, value) in session.ports().outputs.iter().zip(&reply.outputs) {
        text += &format!("{} {value:?}\n", port.name);
    }
    print(&text)?;
    for finding in &reply.audit {
        complain(&format!("audit: {finding}"));
    }
    match reply.status {
        StepStatus::Reached => Ok(Exit::Done),
        StepStatus::Stopped | StepStatus::IncrementLimit | StepStatus::Cancelled => {
            complain(&format!("{}: {}", reply.status, reply.reason));
            Ok(Exit::NotConverged)
        }
    }
}

fn get(arguments: &GetArgs) -> Result<Exit, Failure> {
    let client = connect(&arguments.connect)?;
    let session = client.attach(&arguments.session)?;
    let mut text = String::new();
    if let Some(name) = &arguments.field {
        let field = session.field(name)?;
        text += "node";
        for c in 1..=field.components {
            text += &format!(",{}{}", field.name, if field.components > 1 { c.to_string() } else { String::new() });
        }
        text += "\n";
        for (label, row) in field.labels.iter().zip(field.values.chunks(field.components.max(1) as usize)) {
            text += &format!("{label}{}\n", row.iter().map(|v| format!(",{v:.16e}")).collect::<String>());
        }
    } else {
        let names: Vec<&str> = arguments.ports.iter().map(String::as_str).collect();
        let reply = session.get(&names)?;
        for value in reply.inputs.iter().chain(&reply.outputs) {
            text += &format!("{} {:?}\n", value.name, value.value);
        }
    }
    print(&text)?;
    Ok(Exit::Done)
}

fn watch(arguments: &WatchArgs) -> Result<Exit, Failure> {
    let client = connect(&arguments.connect)?;
    let session = client.attach(&arguments.session)?;
    let frames = match &arguments.field {
        Some(field) => session.frames_of(field)?,
        None => session.frames()?,
    };
    print(&header(&session, arguments.field.as_deref()))?;
    for (number, frame) in (1..).zip(frames) {
        print(&lines(&frame?))?;
        if Some(number) == arguments.count {
            break;
        }
    }
    Ok(Exit::Done)
}

fn header(session: &Session, field: Option<&str>) -> String {
    match field {
        Some(field) => format!("time,node,{field}...\n"),
        None => {
            let names: String = session.ports().outputs.iter().map(|p| format!(",{}", p.name)).collect();
            format!("number,step,increment,time{names}\n")
        }
    }
}

fn lines(frame: &Frame) -> String {
    let row = |values: &[f64]| values.iter().map(|v| format!(",{v:.16e}")).collect::<String>();
    if frame.labels.is_empty() {
        return format!(
            "{},{},{},{:.16e}{}\n",
            frame.number,
            frame.step,
            frame.increment,
            frame.time,
            row(&frame.values)
        );
    }
    let rows = frame.values.chunks(frame.components.max(1) as usize);
    frame
        .labels
        .iter()
        .zip(rows)
        .map(|(label, values)| format!("{:.16e},{label}{}\n", frame.time, row(values)))
        .collect()
}
