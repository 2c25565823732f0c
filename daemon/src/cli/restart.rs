//! `--restart FILE` and `--snapshots N`.

use std::path::{Path, PathBuf};

use overclosure::model::{Model, RestartFrequency, RestartRequest};
use overclosure::output::{RestartOrigin, Standing, holds_results};
use overclosure::simulation::{RestoreError, Simulation, check_checkpoint};

use super::{Exit, complain};

/// A snapshot to go on from.
pub struct Restart {
    file: PathBuf,
    bytes: Vec<u8>,
}

impl Restart {
    /// Reads the file. A run that goes on writes only what follows: results that are there already would be lost to it.
    pub fn read(file: PathBuf, directory: &Path, job: &str) -> Result<Self, Exit> {
        let bytes = std::fs::read(&file).map_err(|error| {
            complain(&format!("error: cannot read {}: {error}", file.display()));
            Exit::InputWrong
        })?;
        if holds_results(directory, job) {
            complain(&format!(
                "error: --restart: {} holds results of {job}, which this run would replace by those after the snapshot alone; \
                 name another folder with --out",
                directory.display()
            ));
            return Err(Exit::InputWrong);
        }
        Ok(Self { file, bytes })
    }

    /// Refuses a snapshot of another deck, a damaged one and one of another version, before anything is factored.
    pub fn check(&self, model: &Model) -> Result<(), Exit> {
        check_checkpoint(model, &self.bytes).map_err(|error| self.refused(&error))
    }

    fn refused(&self, error: &RestoreError) -> Exit {
        complain(&format!("error: --restart {}: {error}", self.file.display()));
        Exit::InputWrong
    }

    /// Brings a new simulation to where the snapshot stands, and tells unless it shall be quiet.
    pub fn apply(self, simulation: &mut Simulation, quiet: bool) -> Result<RestartOrigin, Exit> {
        simulation.restore(&self.bytes).map_err(|error| self.refused(&error))?;
        let file = self.file.display().to_string();
        let end = simulation.time_end();
        if simulation.check_target(end).is_err() {
            complain(&format!(
                "error: --restart {file}: it stands at total time {}, beyond the end of the deck at {end}",
                simulation.time()
            ));
            return Err(Exit::InputWrong);
        }
        let standing = simulation.standing();
        let Standing { step, increment, time } = standing;
        if !quiet {
            complain(&format!("goes on from {file}: step {step}, increment {increment}, total time {time}"));
        }
        Ok(RestartOrigin { file, standing })
    }
}

/// A snapshot every so many increments, whatever the deck asks for.
pub fn every(increments: u32) -> RestartRequest {
    RestartRequest { frequency: RestartFrequency::Increments(increments), overlay: false }
}
