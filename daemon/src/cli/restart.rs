//! `--restart FILE` and `--snapshots N`.

use std::path::{Path, PathBuf};

use overclosure::model::{RestartFrequency, RestartRequest};
use overclosure::output::{RestartOrigin, Standing, holds_results};
use overclosure::simulation::Simulation;

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

    /// Brings a new simulation to where the snapshot stands, and tells unless it shall be quiet.
    pub fn apply(self, simulation: &mut Simulation, quiet: bool) -> Result<RestartOrigin, Exit> {
        let Self { file, bytes } = self;
        let file = file.display().to_string();
        if let Err(error) = simulation.restore(&bytes) {
            complain(&format!("error: --restart {file}: {error}"));
            return Err(Exit::InputWrong);
        }
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
