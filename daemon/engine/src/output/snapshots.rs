//! `JOB_restart_STEP_INCREMENT.ovck`: states from which a run can go on, by `*RESTART, WRITE` or as the caller asks.
//!
//! A snapshot is complete or not there: it is written beside its name, handed to the disk, and then given its name. It comes after
//! the rows of its increment, so that whoever finds it finds them too.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::due::{Moment, Span};
use super::file::OutputError;
use crate::model::{RestartRequest, Step};
use crate::restart::Standing;
use crate::simulation::{IncrementReport, Simulation};

/// A snapshot that a run has left behind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SnapshotSummary {
    /// Name of the file, beside the other results.
    pub file: String,
    /// Where the run stood.
    #[serde(flatten)]
    pub standing: Standing,
}

/// Writes snapshots.
pub(super) struct Snapshots {
    directory: PathBuf,
    job: String,
    /// Replaces the requests of the deck.
    request: Option<RestartRequest>,
    written: Vec<SnapshotSummary>,
}

impl Snapshots {
    /// `request` goes before those of the deck. Snapshots of an earlier run go away, unless they may be where this one comes from.
    pub(super) fn create(
        directory: &Path,
        job: &str,
        request: Option<RestartRequest>,
        keep_earlier: bool,
    ) -> Result<Self, OutputError> {
        if !keep_earlier {
            remove_snapshots(directory, job)?;
        }
        Ok(Self { directory: directory.to_owned(), job: job.to_owned(), request, written: Vec::new() })
    }

    /// Writes one if it is due at an increment.
    pub(super) fn write(
        &mut self,
        step: &Step,
        increment: &IncrementReport,
        moment: Moment,
        simulation: &Simulation,
    ) -> Result<(), OutputError> {
        let Some(request) = self.request.or(step.output.restart) else { return Ok(()) };
        if !Span::of(step, increment).snapshot_is_due(request.frequency, moment) {
            return Ok(());
        }
        let standing = simulation.standing();
        let file = match request.overlay {
            true => format!("{}_restart.ovck", self.job),
            false => format!("{}_restart_{}_{}.ovck", self.job, standing.step, standing.increment),
        };
        let path = self.directory.join(&file);
        replace(&self.directory, &path, &simulation.checkpoint()).map_err(OutputError::at(&path))?;
        self.written.retain(|earlier| earlier.file != file);
        self.written.push(SnapshotSummary { file, standing });
        Ok(())
    }

    /// What is there now, in the order of the increments.
    pub(super) fn written(self) -> Vec<SnapshotSummary> {
        self.written
    }
}

/// Puts a file in the place of another one, or of none, in one piece; it survives a crash of the machine once this has returned.
fn replace(directory: &Path, path: &Path, bytes: &[u8]) -> io::Result<()> {
    let temporary = path.with_extension("ovck.part");
    let mut file = File::create(&temporary)?;
    file.write_all(bytes)?;
    file.sync_all()?;
    fs::rename(&temporary, path)?;
    match File::open(directory)?.sync_all() {
        // Some network file systems keep names safe by themselves and do not take the question.
        Err(error) if matches!(error.kind(), io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported) => Ok(()),
        synchronised => synchronised,
    }
}

/// Snapshots of an earlier run, and what a killed one left of the next.
fn remove_snapshots(directory: &Path, job: &str) -> Result<(), OutputError> {
    for entry in fs::read_dir(directory).map_err(OutputError::at(directory))? {
        let path = entry.map_err(OutputError::at(directory))?.path();
        if path.file_name().and_then(|name| name.to_str()).is_some_and(|name| is_snapshot(name, job)) {
            fs::remove_file(&path).map_err(OutputError::at(&path))?;
        }
    }
    Ok(())
}

/// Whether a file has the name that a snapshot of the job has.
fn is_snapshot(name: &str, job: &str) -> bool {
    let Some(rest) = name.strip_prefix(job).and_then(|rest| rest.strip_prefix("_restart")) else { return false };
    let Some(numbers) = rest.strip_suffix(".part").unwrap_or(rest).strip_suffix(".ovck") else { return false };
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let parts: Vec<&str> = numbers.split('_').collect();
    numbers.is_empty() || (parts.len() == 3 && parts[0].is_empty() && parts[1..].iter().all(|part| digits(part)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_snapshots_of_the_job_are_removed() {
        let directory = tempfile::tempdir().unwrap();
        let ours = ["job_restart.ovck", "job_restart_1_12.ovck", "job_restart_2_1.ovck.part"];
        let foreign = ["job_restart_mine.ovck", "job_restart_1.ovck", "job2_restart_1_1.ovck", "job_history.csv"];
        for name in ours.iter().chain(&foreign) {
            fs::write(directory.path().join(name), "").unwrap();
        }
        remove_snapshots(directory.path(), "job").unwrap();
        assert!(ours.iter().all(|name| !directory.path().join(name).exists()));
        assert!(foreign.iter().all(|name| directory.path().join(name).exists()));
    }

    #[test]
    fn a_file_is_replaced_in_one_piece() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("job_restart.ovck");
        for text in ["first", "the second one"] {
            replace(directory.path(), &path, text.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
        }
        assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
    }
}
