//! Follows a run: writes results, shows progress, carries the wish to stop.

use std::sync::atomic::{AtomicBool, Ordering};

use overclosure::output::ResultWriter;
use overclosure::simulation::{IncrementReport, Simulation, Watch};

use super::clock::{Clock, Stage};
use super::progress::Progress;

/// The watch of `overclosure run`.
pub struct Monitor<'a> {
    writer: ResultWriter,
    progress: &'a Progress,
    clock: &'a mut Clock,
    stop: &'a AtomicBool,
    time_end: f64,
    audit: Audit,
}

impl<'a> Monitor<'a> {
    /// `time_end` is the total time at which the last step ends.
    pub fn new(
        writer: ResultWriter,
        progress: &'a Progress,
        clock: &'a mut Clock,
        stop: &'a AtomicBool,
        time_end: f64,
    ) -> Self {
        progress.stage(Stage::SOLVE);
        Self { writer, progress, clock, stop, time_end, audit: Audit::default() }
    }

    /// The writer, to be finished, and every finding of the audit.
    pub fn finish(mut self, simulation: &Simulation) -> (ResultWriter, Vec<String>) {
        self.audit.take(simulation, "at the end");
        (self.writer, self.audit.findings())
    }
}

impl Watch for Monitor<'_> {
    fn increment(&mut self, simulation: &Simulation, report: &IncrementReport) {
        self.audit.take(simulation, &format!("in step {}, increment {}", report.step, report.increment));
        let solving = self.clock.enter(Stage::WRITE);
        self.writer.increment(simulation, report);
        self.clock.enter(solving);
        self.progress.increment(report, report.time / self.time_end);
    }

    fn cancelled(&self) -> bool {
        self.stop.load(Ordering::SeqCst) || self.writer.cancelled()
    }
}

/// Findings of the audit in the order in which they first appeared.
#[derive(Default)]
struct Audit {
    /// What, where first, and in how many increments.
    findings: Vec<(String, String, u32)>,
}

impl Audit {
    fn take(&mut self, simulation: &Simulation, place: &str) {
        for finding in simulation.audit() {
            match self.findings.iter_mut().find(|(known, _, _)| *known == finding) {
                Some((_, _, count)) => *count += 1,
                None => self.findings.push((finding, place.to_owned(), 1)),
            }
        }
    }

    fn findings(self) -> Vec<String> {
        self.findings.into_iter().map(|(finding, place, _)| format!("{finding} ({place})")).collect()
    }
}
