//! Tries an FMU before anybody else does: an importer of another house loads it, steps it, saves, restores, resets.
//! Every number is compared, bit for bit, with what the engine gives without an FMU around it.

use std::path::Path;
use std::ptr;
use std::sync::{Arc, Mutex, PoisonError};

use fmi_rs::fmi2::log::Logger;
use fmi_rs::fmi2::types::{fmi2FMUstate, fmi2False, fmi2Status};
use fmi_rs::fmi2::{CS, FMU2};
use fmi_rs::model_description::fmi2::ModelDescription;

/// What the FMU has to show.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// Names of all variables, in the order of their value references.
    pub names: Vec<String>,
    /// Value references of the Real outputs.
    pub outputs: Vec<u32>,
    /// Values to set after the initialisation.
    pub settings: Vec<(u32, f64)>,
    /// Communication step \[time\].
    pub step: f64,
    /// Outputs after the settings, then after each step.
    pub expected: Vec<Vec<f64>>,
}

/// What went wrong.
#[derive(Debug, thiserror::Error)]
pub enum TrialError {
    /// The importer cannot open the archive or load the library.
    #[error("an importer cannot load it: {0}")]
    Load(String),
    /// The importer finds faults in the description.
    #[error("an importer objects to modelDescription.xml:\n{0}")]
    Description(String),
    /// A call failed.
    #[error("{call} returned {status}\n{log}")]
    Call {
        /// Which.
        call: &'static str,
        /// What it returned.
        status: String,
        /// What the FMU logged.
        log: String,
    },
    /// A number differs.
    #[error("{name} is {found:?} {moment}, the engine gives {expected:?}")]
    Differs {
        /// Variable.
        name: String,
        /// When.
        moment: String,
        /// Without the FMU.
        expected: f64,
        /// From the FMU.
        found: f64,
    },
}

/// Tries the FMU in a file.
pub fn try_out(fmu: &Path, plan: &Plan) -> Result<(), TrialError> {
    let folder = tempfile::tempdir().map_err(load)?;
    fmi_rs::zip::extract_zip_archive(fmu, folder.path()).map_err(load)?;
    let description = ModelDescription::from_path(&folder.path().join("modelDescription.xml")).map_err(load)?;
    check_description(&description, plan)?;
    let identifier = description.coSimulation.as_ref().map(|cs| cs.modelIdentifier.clone()).unwrap_or_default();
    let record = Arc::new(Record::default());
    let logger: Arc<dyn Logger> = Arc::clone(&record) as Arc<dyn Logger>;
    let fmu = FMU2::<CS>::new(folder.path(), &identifier, "trial", &description.guid, false, true, false, logger, true)
        .map_err(|error| TrialError::Load(format!("{error}\n{}", record.text())))?;
    let trial = Trial { fmu: &fmu, plan, record: &record };
    trial.start()?;
    trial.run()?;
    trial.restore()?;
    trial.call("fmi2Reset", fmu.reset())?;
    trial.start()?;
    trial.run()?;
    trial.call("fmi2Terminate", fmu.terminate())
}

fn check_description(description: &ModelDescription, plan: &Plan) -> Result<(), TrialError> {
    let mut problems: Vec<String> = description.validate().into_iter().map(|problem| problem.message).collect();
    let names: Vec<&str> = description.modelVariables.iter().map(|variable| variable.name.as_str()).collect();
    if names != plan.names {
        problems.push("the variables are not those of the model".into());
    }
    if problems.is_empty() { Ok(()) } else { Err(TrialError::Description(problems.join("\n"))) }
}

fn load(error: impl std::fmt::Display) -> TrialError {
    TrialError::Load(error.to_string())
}

struct Trial<'a> {
    fmu: &'a FMU2<CS>,
    plan: &'a Plan,
    record: &'a Record,
}

impl Trial<'_> {
    fn call(&self, call: &'static str, status: fmi2Status) -> Result<(), TrialError> {
        match status {
            fmi2Status::Ok => Ok(()),
            status => Err(TrialError::Call { call, status: format!("{status:?}"), log: self.record.text() }),
        }
    }

    fn start(&self) -> Result<(), TrialError> {
        self.call("fmi2SetupExperiment", self.fmu.setupExperiment(None, 0.0, None))?;
        self.call("fmi2EnterInitializationMode", self.fmu.enterInitializationMode())?;
        self.call("fmi2ExitInitializationMode", self.fmu.exitInitializationMode())
    }

    fn run(&self) -> Result<(), TrialError> {
        let (references, values): (Vec<u32>, Vec<f64>) = self.plan.settings.iter().copied().unzip();
        self.call("fmi2SetReal", self.fmu.setReal(&references, &values))?;
        self.compare(0, "after the initialisation")?;
        for number in 1..self.plan.expected.len() {
            self.step(number)?;
            self.compare(number, &format!("after step {number}"))?;
        }
        Ok(())
    }

    /// From where `run` ended: back to the state before the last step, that step again, also from bytes.
    fn restore(&self) -> Result<(), TrialError> {
        self.call("fmi2Reset", self.fmu.reset())?;
        self.start()?;
        let (references, values): (Vec<u32>, Vec<f64>) = self.plan.settings.iter().copied().unzip();
        self.call("fmi2SetReal", self.fmu.setReal(&references, &values))?;
        let last = self.plan.expected.len() - 1;
        for number in 1..last {
            self.step(number)?;
        }
        let mut state: fmi2FMUstate = ptr::null_mut();
        self.call("fmi2GetFMUstate", self.fmu.getFMUstate(&mut state))?;
        self.finish(last)?;
        self.call("fmi2SetFMUstate", self.fmu.setFMUstate(state))?;
        self.finish(last)?;
        let mut size = 0;
        self.call("fmi2SerializedFMUstateSize", self.fmu.serializedFMUstateSize(state, &mut size))?;
        let mut bytes = vec![0; size];
        self.call("fmi2SerializeFMUstate", self.fmu.serializeFMUstate(state, &mut bytes))?;
        self.call("fmi2FreeFMUstate", self.fmu.freeFMUstate(&mut state))?;
        self.call("fmi2DeSerializeFMUstate", self.fmu.deSerializeFMUstate(&bytes, &mut state))?;
        self.call("fmi2SetFMUstate", self.fmu.setFMUstate(state))?;
        self.finish(last)?;
        self.call("fmi2FreeFMUstate", self.fmu.freeFMUstate(&mut state))
    }

    fn finish(&self, last: usize) -> Result<(), TrialError> {
        if last > 0 {
            self.step(last)?;
        }
        self.compare(last, "after a saved state was set")
    }

    fn step(&self, number: usize) -> Result<(), TrialError> {
        let point = (number - 1) as f64 * self.plan.step;
        self.call("fmi2DoStep", self.fmu.doStep(point, self.plan.step, fmi2False))
    }

    fn compare(&self, row: usize, moment: &str) -> Result<(), TrialError> {
        let mut found = vec![0.0; self.plan.outputs.len()];
        self.call("fmi2GetReal", self.fmu.getReal(&self.plan.outputs, &mut found))?;
        for ((&reference, found), &expected) in self.plan.outputs.iter().zip(found).zip(&self.plan.expected[row]) {
            if found.to_bits() != expected.to_bits() {
                let name = self.plan.names[reference as usize].clone();
                return Err(TrialError::Differs { name, moment: moment.into(), expected, found });
            }
        }
        Ok(())
    }
}

/// Keeps what the FMU says.
#[derive(Default)]
struct Record {
    messages: Mutex<Vec<String>>,
}

impl Record {
    fn text(&self) -> String {
        self.messages.lock().unwrap_or_else(PoisonError::into_inner).join("\n")
    }
}

impl Logger for Record {
    fn log_call(&self, _: fmi2Status, _: &str) {}

    fn log_message(&self, status: fmi2Status, _: &str, message: &str) {
        if status > fmi2Status::Ok {
            self.messages.lock().unwrap_or_else(PoisonError::into_inner).push(message.to_owned());
        }
    }
}
