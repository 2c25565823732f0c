//! From a deck or a law to a tried FMU.

use std::fs;
use std::io;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use overclosure::deck;
use overclosure::diagnostic::Diagnostic;
use overclosure::law::{Linear, PressureLaw};
use overclosure::model::{Dialect, Model, Procedure};
use overclosure::simulation::{AdvanceOutcome, Cache, PathChoice, PrepareOptions, PreparedModel, Simulation};
use overclosure_fmu::backend::{deck as deck_backend, law};
use overclosure_fmu::fingerprint::Fingerprint;
use overclosure_fmu::resources::{
    Content, DECK_FILE, OPTIONS_FILE, OPTIONS_FORMAT, Options, PORTS_FILE, PREPARED_FILE,
};
use overclosure_fmu::variables::{Causality, Kind, Variable};

use crate::archive::Archive;
use crate::description::{self, Heading, Naming};
use crate::documentation::{self, DECK_BEHAVIOUR, LAW_BEHAVIOUR, Page};
use crate::inline::{self, InlineError};
use crate::picture;
use crate::trial::{self, Plan, TrialError};
use crate::units;

/// Folder of the library in the archive.
const PLATFORM: &str = "linux64";
/// Steps of a deck that are tried.
const TRIAL_STEPS: usize = 2;
/// Name of the law FMU: its default experiment has no time of its own.
const LAW_NAME: &str = "ContactLaw";

/// What to pack.
#[derive(Clone, Debug)]
pub struct DeckRequest {
    /// The deck.
    pub deck: PathBuf,
    /// The FMU to write.
    pub output: PathBuf,
    /// Text of a `ports.toml`, if any.
    pub ports: Option<String>,
    /// What keywords mean.
    pub dialect: Dialect,
    /// Solver path.
    pub path: PathChoice,
    /// What the FMU carries besides the deck.
    pub carried: Carried,
    /// The FMU library.
    pub library: PathBuf,
}

/// What a deck FMU carries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Carried {
    /// The deck: small; every first instance prepares the model.
    #[default]
    Deck,
    /// The prepared model too: large, and instances start at once.
    Prepared,
}

/// What was packed.
#[derive(Clone, Debug)]
pub struct PackReport {
    /// Inputs.
    pub inputs: usize,
    /// Outputs.
    pub outputs: usize,
    /// GUID.
    pub guid: String,
    /// What somebody should know, beyond the findings.
    pub notes: Vec<String>,
    /// Findings that do not stop the deck.
    pub warnings: Vec<Diagnostic>,
}

/// Why there is no FMU. Nothing was left behind.
#[derive(Debug, thiserror::Error)]
pub enum PackError {
    /// The deck cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Input {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The deck is wrong; warnings are among the findings.
    #[error("the deck cannot be packed")]
    Deck(Vec<Diagnostic>),
    /// Included files cannot be put together.
    #[error(transparent)]
    Inline(#[from] InlineError),
    /// The steps before the last one do not converge.
    #[error("the steps before the last one stop at time {time}: {reason}")]
    Preload {
        /// Last good time.
        time: f64,
        /// Why.
        reason: String,
    },
    /// The library cannot be read.
    #[error("cannot read the FMU library {}: {source}", path.display())]
    Library {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The FMU cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The FMU does not do what it should.
    #[error("the FMU failed its trial and was removed: {0}")]
    Trial(#[from] TrialError),
}

/// Packs a deck.
pub fn pack_deck(request: &DeckRequest) -> Result<PackReport, PackError> {
    let unreadable = |source| PackError::Input { path: request.deck.clone(), source };
    let reading = deck::read_file(&request.deck, request.dialect).map_err(unreadable)?;
    let mut findings = reading.diagnostics;
    let Some(model) = reading.model else {
        return Err(PackError::Deck(findings));
    };
    let text = inline::inline(&request.deck)?;
    let ports = request.ports.clone();
    let experiment = Experiment::of(&model);
    let heading_text = model.heading.clone();
    let unwritable = |source| PackError::Write { path: request.output.clone(), source };
    let kept = match request.carried {
        Carried::Deck => None,
        Carried::Prepared => {
            let draft = tempfile::Builder::new().prefix(".packing-").tempdir_in(folder_of(&request.output));
            Some(draft.map_err(unwritable)?)
        }
    };
    let options = PrepareOptions {
        path: request.path,
        threads: 1,
        ports_toml: ports.clone(),
        cache: kept.as_ref().map(|folder| Cache::Directory(folder.path().to_owned())),
        ..PrepareOptions::default()
    };
    let prepared = match PreparedModel::prepare(model, &options, &mut |_| {}) {
        Ok(prepared) => Arc::new(prepared),
        Err(errors) => {
            findings.extend(errors);
            return Err(PackError::Deck(findings));
        }
    };
    findings.extend_from_slice(prepared.warnings());
    let mut simulation = Simulation::new(Arc::clone(&prepared));
    if let AdvanceOutcome::Stopped { reason } = simulation.initialize(&mut ()) {
        return Err(PackError::Preload { time: simulation.time(), reason });
    }
    let starts: Vec<f64> = (0..prepared.ports().inputs.len()).map(|at| simulation.input(at).unwrap_or(0.0)).collect();
    let variables = deck_backend::variables(prepared.ports(), &starts);
    let mut notes = unit_notes(&variables);
    let stop = simulation.time_end() - simulation.time();
    let plan = deck_plan(&mut simulation, &variables, experiment.step, &mut notes);
    let name = stem(&request.deck);
    let content = Content::Deck { dialect: request.dialect, path: request.path, ports: ports.is_some() };
    let mut resources = vec![(DECK_FILE, text)];
    resources.extend(ports.map(|ports| (PORTS_FILE, ports)));
    let page = Page {
        name: &name,
        about: vec![
            heading_text,
            format!(
                "A deck of finite elements in contact, solved inside this FMU. Packed from {}, read as {}.",
                request.deck.file_name().unwrap_or_default().to_string_lossy(),
                match request.dialect {
                    Dialect::Abaqus => "Abaqus reads it",
                    Dialect::Calculix => "CalculiX reads it",
                }
            ),
        ],
        behaviour: DECK_BEHAVIOUR.to_vec(),
        variables: &variables,
    };
    let heading = Heading {
        name: name.clone(),
        identifier: identifier(&name),
        description: "Contact of elastic bodies".into(),
        naming: Naming::Flat,
        stop,
        step: experiment.step,
    };
    let prepared = kept.as_ref().map(|folder| prepared.file_in(folder.path()));
    if prepared.as_ref().is_some_and(|file| !file.exists()) {
        notes.push("the prepared model is not kept on this solver path; the FMU carries the deck alone".into());
    }
    let prepared = prepared.filter(|file| file.exists());
    let product = Product { heading, page, content, resources, prepared, plan };
    let guid = product.build(&request.library, &request.output)?;
    Ok(report(&variables, guid, notes, findings))
}

/// Packs the law FMU.
pub fn pack_law(library: &Path, output: &Path) -> Result<PackReport, PackError> {
    let variables = law::variables();
    let page = Page {
        name: LAW_NAME,
        about: vec!["A pressure-overclosure relationship: what pressure a given overclosure transmits.".into()],
        behaviour: LAW_BEHAVIOUR.to_vec(),
        variables: &variables,
    };
    let heading = Heading {
        name: LAW_NAME.into(),
        identifier: LAW_NAME.into(),
        description: "Contact pressure-overclosure relationship".into(),
        naming: Naming::Structured,
        stop: 1.0,
        step: 0.01,
    };
    let plan = law_plan(&variables);
    let product = Product { heading, page, content: Content::Law, resources: Vec::new(), prepared: None, plan };
    let guid = product.build(library, output)?;
    Ok(report(&variables, guid, Vec::new(), Vec::new()))
}

fn report(variables: &[Variable], guid: String, notes: Vec<String>, warnings: Vec<Diagnostic>) -> PackReport {
    let count = |causality| variables.iter().filter(|variable| variable.causality == causality).count();
    PackReport { inputs: count(Causality::Input), outputs: count(Causality::Output), guid, notes, warnings }
}

/// Communication steps of an explicit step unless a master chooses others.
const EXPLICIT_STEPS: f64 = 100.0;

/// What the deck itself would do in its last step.
struct Experiment {
    step: f64,
}

impl Experiment {
    fn of(model: &Model) -> Self {
        let step = model.steps.last().map_or(1.0, |step| match &step.procedure {
            Procedure::Static(_) | Procedure::Dynamic(_) => step.procedure.increment_first(),
            // Stable increments are too many to be asked for one by one.
            Procedure::Explicit(control) => control.period / EXPLICIT_STEPS,
        });
        Self { step }
    }
}

/// Everything that goes into the archive.
struct Product<'a> {
    heading: Heading,
    page: Page<'a>,
    content: Content,
    resources: Vec<(&'static str, String)>,
    /// File of the prepared model, if it goes in.
    prepared: Option<PathBuf>,
    plan: Plan,
}

impl Product<'_> {
    /// Writes the FMU beside its destination, tries it, and gives it its name. Returns the GUID.
    fn build(self, library: &Path, output: &Path) -> Result<String, PackError> {
        let code = fs::read(library).map_err(|source| PackError::Library { path: library.into(), source })?;
        let unwritable = |source| PackError::Write { path: output.into(), source };
        let guid = self.guid(&code).map_err(unwritable)?;
        let archive = self.archive(&guid, code).map_err(unwritable)?;
        let folder = folder_of(output);
        let mut draft = tempfile::Builder::new()
            .prefix(".packing-")
            .suffix(".fmu")
            // Opened here, because the error of tempfile_in names the draft: a name that means nothing to anybody.
            .make_in(folder, |path| fs::OpenOptions::new().read(true).write(true).create_new(true).open(path))
            .map_err(unwritable)?;
        archive.write(io::BufWriter::new(draft.as_file_mut())).map_err(unwritable)?;
        trial::try_out(draft.path(), &self.plan)?;
        fs::set_permissions(draft.path(), fs::Permissions::from_mode(0o644)).map_err(unwritable)?;
        draft.persist(output).map_err(|error| unwritable(error.error))?;
        Ok(guid)
    }

    /// Of everything that decides what the FMU computes and how it is described. A prepared model decides neither.
    fn guid(&self, code: &[u8]) -> io::Result<String> {
        let description = description::write(&self.heading, "", self.page.variables)?;
        let mut fingerprint = Fingerprint::default().with(description.as_bytes()).with(&self.options("")?).with(code);
        for (name, text) in &self.resources {
            fingerprint = fingerprint.with(name.as_bytes()).with(text.as_bytes());
        }
        Ok(fingerprint.guid())
    }

    fn options(&self, guid: &str) -> io::Result<Vec<u8>> {
        let options = Options { format: OPTIONS_FORMAT, guid: guid.into(), content: self.content.clone() };
        serde_json::to_vec_pretty(&options).map_err(io::Error::other)
    }

    fn archive(&self, guid: &str, code: Vec<u8>) -> io::Result<Archive> {
        let mut archive = Archive::default();
        archive.file("modelDescription.xml", description::write(&self.heading, guid, self.page.variables)?);
        archive.file("model.png", picture::png()?);
        archive.file(format!("resources/{OPTIONS_FILE}"), self.options(guid)?);
        for (name, text) in &self.resources {
            archive.file(format!("resources/{name}"), text.as_str());
        }
        if let Some(file) = &self.prepared {
            archive.numbers(format!("resources/{PREPARED_FILE}"), file.clone());
        }
        documentation::add(&mut archive, &self.page);
        archive.executable(format!("binaries/{PLATFORM}/{}.so", self.heading.identifier), code);
        Ok(archive)
    }
}

/// Where the FMU is written, and what is needed on the way.
fn folder_of(output: &Path) -> &Path {
    output.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn empty_plan(variables: &[Variable]) -> Plan {
    let real_output =
        |variable: &Variable| variable.causality == Causality::Output && matches!(variable.kind, Kind::Real { .. });
    Plan {
        names: variables.iter().map(|variable| variable.name.clone()).collect(),
        outputs: (0..).zip(variables).filter(|(_, variable)| real_output(variable)).map(|(at, _)| at).collect(),
        ..Plan::default()
    }
}

/// The first steps of the deck, without the FMU.
fn deck_plan(simulation: &mut Simulation, variables: &[Variable], step: f64, notes: &mut Vec<String>) -> Plan {
    let mut plan = Plan { step, ..empty_plan(variables) };
    let mut outputs = vec![0.0; plan.outputs.len()];
    simulation.observe(&mut outputs);
    plan.expected.push(outputs.clone());
    let origin = simulation.time();
    for number in 1..=TRIAL_STEPS {
        let target = origin + ((number - 1) as f64 * step + step);
        match simulation.advance(target, &mut ()) {
            Ok(AdvanceOutcome::Reached) => {
                simulation.observe(&mut outputs);
                plan.expected.push(outputs.clone());
            }
            Ok(AdvanceOutcome::Stopped { reason }) => {
                notes.push(format!("without inputs the deck stops at time {}: {reason}", simulation.time() - origin));
                break;
            }
            Ok(AdvanceOutcome::Cancelled) | Err(_) => break,
        }
    }
    plan
}

/// The linear law of the start values, without the FMU.
fn law_plan(variables: &[Variable]) -> Plan {
    let (overclosure, velocity) = (5e-5, 0.1);
    let start = |name: &str| {
        variables
            .iter()
            .find_map(|variable| match variable.kind {
                Kind::Real { start, .. } if variable.name == name => Some(start),
                _ => None,
            })
            .expect("the law FMU has this variable")
    };
    let law = Linear::new(start("law.stiffness")).expect("the start value is a stiffness");
    let point = law.evaluate(overclosure);
    let area = start("area");
    let force = area * point.pressure;
    let row = vec![
        point.pressure,
        force,
        point.stiffness,
        area * point.stiffness,
        point.energy,
        area * point.energy,
        force * velocity,
        // Without damping, as the start values have it.
        0.0,
        0.0,
        0.0,
        0.0,
    ];
    let position = |name: &str| variables.iter().position(|variable| variable.name == name).unwrap_or_default() as u32;
    Plan {
        settings: vec![(position("overclosure"), overclosure), (position("closing_velocity"), velocity)],
        step: 0.01,
        expected: vec![row; TRIAL_STEPS + 1],
        ..empty_plan(variables)
    }
}

fn unit_notes(variables: &[Variable]) -> Vec<String> {
    let unknown = variables.iter().filter_map(|variable| match &variable.kind {
        Kind::Real { unit: Some(unit), .. } if units::parse(unit).is_none() => {
            Some(format!("{}: unit {unit} has no known definition in SI; importers cannot convert it", variable.name))
        }
        _ => None,
    });
    unknown.collect()
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// A C identifier like the name.
fn identifier(name: &str) -> String {
    let plain: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if plain.starts_with(|c: char| c.is_ascii_alphabetic()) { plain } else { format!("deck_{plain}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_are_legal_in_c() {
        for (name, expected) in [("punch", "punch"), ("16 x 16%", "deck_16_x_16_"), ("ä", "deck__"), ("", "deck_")] {
            assert_eq!(identifier(name), expected);
        }
    }

    #[test]
    fn the_law_is_what_the_law_backend_computes() {
        // The trial itself is run by the tests that have the shared library; this one guards the layout of the row.
        let plan = law_plan(&law::variables());
        assert!(plan.expected.iter().all(|row| row.len() == plan.outputs.len()));
    }
}
