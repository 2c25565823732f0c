//! `overclosure run`: solves a deck and writes results.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::Args;
use overclosure::diagnostic::Diagnostic;
use overclosure::model::Dialect;
use overclosure::output::{
    Finding, ModelSize, OutputError, RestartOrigin, ResultWriter, RunOutcome, RunReport, SnapshotSummary, WriteOptions,
    write_report,
};
use overclosure::port;
use overclosure::simulation::{AdvanceOutcome, Cache, PrepareOptions, PreparedModel, Simulation};

use super::clock::{Clock, Stage};
use super::monitor::{Followed, Monitor};
use super::open::{open_deck, read_ports, refuse, report};
use super::progress::Progress;
use super::restart::{self, Restart};
use super::{DialectArg, Exit, PathArg, complain, interrupt, memory, settings};

/// Arguments of `overclosure run`.
#[derive(Args)]
#[command(after_help = "\
Files in DIR, named after the deck: JOB.json (outcome, work, findings, times), JOB_history.csv (one row per increment),
JOB_contact.csv, JOB_nodes.csv (by the output requests of the deck), JOB.pvd with its .vtu (ParaView), JOB.dat (printed tables),
JOB_restart_STEP_INCREMENT.ovck (by *RESTART, WRITE of the deck, or by --snapshots).
Ctrl-C stops after the present increment and keeps what there is; a second one stops at once.")]
pub struct RunArgs {
    /// The deck; results are named after it.
    deck: PathBuf,
    /// Where results are written [default: beside the deck].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replaces the magnitude of an input of the last step and keeps its amplitude; may be repeated.
    #[arg(long = "set", value_name = "PORT=VALUE")]
    sets: Vec<String>,
    /// What keywords mean where codes disagree.
    #[arg(long, value_enum, default_value = "abaqus")]
    dialect: DialectArg,
    /// Solver path.
    #[arg(long, value_enum, default_value = "auto")]
    path: PathArg,
    /// Threads; the results do not depend on it.
    #[arg(long, value_name = "N", default_value_t = 1)]
    threads: usize,
    /// Most memory that the preparation may take, e.g. 4G or 800M [default: what the machine, or the control group, has left].
    #[arg(long, value_name = "SIZE", value_parser = memory::parse_size)]
    memory_limit: Option<u64>,
    /// Names and units of ports [default: DECKNAME.ports.toml or ports.toml beside the deck, if there is one].
    #[arg(long, value_name = "FILE")]
    ports: Option<PathBuf>,
    /// Takes the prepared model from this directory, or puts it there: the next run of the deck starts at once.
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// Goes on from a snapshot of the same deck. The results are those after it, with the bits of a run that never stopped.
    #[arg(long, value_name = "FILE")]
    restart: Option<PathBuf>,
    /// Writes a snapshot every N increments, whatever *RESTART, WRITE says, and at the end of each step.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    snapshots: Option<u32>,
    /// Nothing on the terminal but findings.
    #[arg(long)]
    quiet: bool,
}

/// Runs the verb.
pub fn run(arguments: RunArgs) -> Exit {
    match Job::read(arguments).and_then(Job::solve) {
        Ok(exit) | Err(exit) => exit,
    }
}

/// A deck that is ready to be solved.
struct Job {
    name: String,
    deck: PathBuf,
    directory: PathBuf,
    dialect: Dialect,
    prepared: Arc<PreparedModel>,
    simulation: Simulation,
    origin: Option<RestartOrigin>,
    files: WriteOptions,
    diagnostics: Vec<Diagnostic>,
    clock: Clock,
    progress: Progress,
    stop: Arc<AtomicBool>,
}

impl Job {
    /// Everything that can be wrong with the input is found here.
    fn read(arguments: RunArgs) -> Result<Self, Exit> {
        let RunArgs { deck, out, sets, dialect, path, threads, memory_limit, ports, cache, restart, snapshots, quiet } =
            arguments;
        let stop = interrupt::watch()?;
        let mut clock = Clock::start(Stage::Read);
        let progress = Progress::new(quiet);
        progress.stage(Stage::Read);
        let (name, directory) = destination(&deck, out);
        let restart = restart.map(|file| Restart::read(file, &directory, &name)).transpose()?;
        let dialect = dialect.into();
        let assignments = settings::parse(&sets);
        let ports_toml = read_ports(ports.as_deref(), &deck);
        let opened = open_deck(&deck, dialect)?;
        let ports_toml = ports_toml?;
        // A misspelt name need not wait for the factorisation.
        let ports =
            port::ports_of(&opened.model, ports_toml.as_deref()).map_err(|findings| refuse(&deck, &findings))?;
        let settings = settings::resolve(&assignments, &ports.inputs)?;
        if let Some(restart) = &restart {
            restart.check(&opened.model)?;
        }
        let memory_limit = memory_limit.or_else(memory::available);
        let cache = cache.map(Cache::Directory);
        let options = PrepareOptions { path: path.into(), threads, ports_toml, memory_limit, cache };
        let mut diagnostics = opened.diagnostics;
        let prepared = PreparedModel::prepare(opened.model, &options, &mut |phase| {
            let stage = Stage::Phase(phase);
            clock.enter(stage);
            progress.stage(stage);
        });
        let prepared = prepared.map_err(|findings| progress.hidden_while(|| refuse(&deck, &findings)));
        let prepared = Arc::new(prepared?);
        progress.hidden_while(|| report(prepared.warnings()));
        diagnostics.extend_from_slice(prepared.warnings());
        let mut simulation = Simulation::new(Arc::clone(&prepared));
        let origin =
            restart.map(|restart| progress.hidden_while(|| restart.apply(&mut simulation, quiet))).transpose()?;
        progress.hidden_while(|| settings::apply(settings, &mut simulation))?;
        let files = WriteOptions { snapshots: snapshots.map(restart::every), restarted: origin.is_some() };
        Ok(Self {
            name,
            deck,
            directory,
            dialect,
            prepared,
            simulation,
            origin,
            files,
            diagnostics,
            clock,
            progress,
            stop,
        })
    }

    /// Runs every step and writes the results.
    fn solve(mut self) -> Result<Exit, Exit> {
        let writer = self.create_files().map_err(|error| failed(&error))?;
        self.clock.enter(Stage::SOLVE);
        interrupt::solving();
        let end = self.simulation.time_end();
        let mut monitor = Monitor::new(writer, &self.progress, &mut self.clock, &self.stop, end);
        let outcome = match self.simulation.advance(end, &mut monitor) {
            Ok(outcome) => outcome,
            Err(error) => {
                complain(&format!("error: the end of the last step cannot be taken as a target: {error}"));
                return Err(Exit::OurFailure);
            }
        };
        let (writer, followed) = monitor.finish(&self.simulation);
        self.clock.enter(Stage::WRITE);
        self.progress.stage(Stage::WRITE);
        let written = writer.finish(&self.simulation);
        self.progress.clear();
        let ended = Ended::new(&outcome, written.is_err(), self.simulation.time());
        let (snapshots, written) = match written {
            Ok(snapshots) => (snapshots, Ok(())),
            Err(error) => (Vec::new(), Err(error)),
        };
        let report = self.report(&ended, followed, snapshots);
        let written = written.and_then(|()| write_report(&self.directory, &self.name, &report));
        ended.tell(&report, self.progress.quiet());
        match written {
            Ok(()) => Ok(ended.exit),
            Err(error) => Err(failed(&error)),
        }
    }

    fn create_files(&self) -> Result<ResultWriter, OutputError> {
        std::fs::create_dir_all(&self.directory)
            .map_err(|source| OutputError { path: self.directory.clone(), source })?;
        ResultWriter::create(&self.directory, &self.name, Arc::clone(&self.prepared), self.files)
    }

    fn report(&self, ended: &Ended, followed: Followed, snapshots: Vec<SnapshotSummary>) -> RunReport {
        let Followed { audit, sizes, cutbacks, status_changes, status_changes_omitted } = followed;
        let simulation = &self.simulation;
        let mesh = &self.prepared.model().mesh;
        RunReport {
            job: self.name.clone(),
            deck: self.deck.display().to_string(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            dialect: self.dialect,
            outcome: ended.outcome,
            reason: ended.reason.clone(),
            time_reached: simulation.time(),
            size: ModelSize {
                nodes: mesh.node_count(),
                elements: mesh.elements.len(),
                contact_points: self.prepared.contact_points().len(),
            },
            restarted_from: self.origin.clone(),
            inputs_set: self.inputs_set(),
            steps: sizes.enter(simulation.step_reports().into_iter().map(Into::into).collect()),
            cutbacks,
            status_changes,
            status_changes_omitted,
            snapshots,
            diagnostics: self.diagnostics.iter().map(Finding::from).collect(),
            audit,
            wall_seconds: self.clock.seconds(),
        }
    }

    /// Those set before the snapshot, if there is one, are still in force.
    fn inputs_set(&self) -> BTreeMap<String, f64> {
        let inputs = self.prepared.ports().inputs.iter().enumerate();
        inputs.filter_map(|(i, port)| Some((port.name.clone(), self.simulation.magnitude(i)?))).collect()
    }
}

/// Name of the job and folder of its results.
fn destination(deck: &Path, out: Option<PathBuf>) -> (String, PathBuf) {
    let name = deck.file_stem().map_or_else(|| String::from("job"), |stem| stem.to_string_lossy().into_owned());
    let folder = out.unwrap_or_else(|| deck.parent().map(Path::to_owned).unwrap_or_default());
    (name, if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder })
}

fn failed(error: &OutputError) -> Exit {
    complain(&format!("error: {error}"));
    Exit::OurFailure
}

/// How the run ended.
struct Ended {
    outcome: RunOutcome,
    reason: Option<String>,
    exit: Exit,
}

impl Ended {
    fn new(outcome: &AdvanceOutcome, unwritable: bool, time: f64) -> Self {
        match outcome {
            AdvanceOutcome::Reached => Self { outcome: RunOutcome::Completed, reason: None, exit: Exit::Done },
            AdvanceOutcome::Cancelled => {
                let why = if unwritable { "the results could not be written" } else { "told to stop" };
                let reason = format!("{why}; the results end at total time {time}");
                Self { outcome: RunOutcome::Stopped, reason: Some(reason), exit: Exit::NotConverged }
            }
            AdvanceOutcome::Stopped { reason } => {
                Self { outcome: RunOutcome::Stopped, reason: Some(reason.clone()), exit: Exit::NotConverged }
            }
        }
    }

    /// Findings and a stop on stderr always; the rest unless it is unwanted.
    fn tell(&self, report: &RunReport, quiet: bool) {
        for finding in &report.audit {
            complain(&format!("audit: {finding}"));
        }
        if let Some(reason) = &self.reason {
            complain(&format!("stopped: {reason}"));
        }
        if !quiet {
            let total: f64 = report.wall_seconds.values().sum();
            let phases: Vec<String> =
                report.wall_seconds.iter().map(|(phase, seconds)| format!("{phase} {seconds:.3}")).collect();
            complain(&format!("{}: {:.3} s ({})", report.job, total, phases.join(", ")));
        }
    }
}
