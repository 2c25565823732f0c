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
    pub fn finish(self) -> (ResultWriter, Vec<String>) {
        (self.writer, self.audit.findings())
    }
}

impl Watch for Monitor<'_> {
    fn increment(&mut self, simulation: &Simulation, report: &IncrementReport) {
        self.audit.take(simulation.audit(), &format!("step {}, increment {}", report.step, report.increment));
        let solving = self.clock.enter(Stage::WRITE);
        self.writer.increment(simulation, report);
        self.clock.enter(solving);
        self.progress.increment(report, report.time / self.time_end);
    }

    fn cancelled(&self) -> bool {
        self.stop.load(Ordering::SeqCst) || self.writer.cancelled()
    }
}

/// Findings of the audit, each kind once, in the order in which they first appeared.
#[derive(Default)]
struct Audit {
    kinds: Vec<Kind>,
}

/// Findings that differ only in their numbers.
struct Kind {
    first: String,
    place: String,
    increments: u32,
}

impl Audit {
    fn take(&mut self, findings: Vec<String>, place: &str) {
        for finding in findings {
            match self.kinds.iter_mut().find(|kind| wording(&kind.first) == wording(&finding)) {
                Some(kind) => kind.increments += 1,
                None => self.kinds.push(Kind { first: finding, place: place.to_owned(), increments: 1 }),
            }
        }
    }

    fn findings(self) -> Vec<String> {
        let told = |Kind { first, place, increments }| match increments {
            1 => format!("{place}: {first}"),
            _ => format!("{place} and {} more: {first}", increments - 1),
        };
        self.kinds.into_iter().map(told).collect()
    }
}

/// The words before the first colon, without numbers.
fn wording(finding: &str) -> String {
    let head = finding.split(':').next().unwrap_or(finding);
    head.chars().filter(|c| !c.is_ascii_digit()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kind_of_finding_is_told_once() {
        let mut audit = Audit::default();
        audit.take(vec!["tension at 3 contact points: node 1".into()], "step 1, increment 1");
        audit
            .take(vec!["tension at 12 contact points: node 2".into(), "overlap: node 4".into()], "step 1, increment 2");
        let findings = audit.findings();
        assert_eq!(
            findings,
            [
                "step 1, increment 1 and 1 more: tension at 3 contact points: node 1",
                "step 1, increment 2: overlap: node 4"
            ]
        );
    }
}
