//! Follows a run: writes results, shows progress, carries the wish to stop.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};

use overclosure::output::{CutbackSummary, ResultWriter, StatusChangeSummary, StepSummary, status_changes};
use overclosure::simulation::{CutbackReport, IncrementReport, Simulation, Watch};

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
    sizes: Sizes,
    cutbacks: Vec<CutbackSummary>,
    status_changes: Vec<StatusChangeSummary>,
}

/// What a run has shown when it is over.
pub struct Followed {
    /// Every finding of the audit.
    pub audit: Vec<String>,
    /// Smallest and largest increment of each step.
    pub sizes: Sizes,
    /// Increments tried in vain.
    pub cutbacks: Vec<CutbackSummary>,
    /// The contact log.
    pub status_changes: Vec<StatusChangeSummary>,
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
        Self {
            writer,
            progress,
            clock,
            stop,
            time_end,
            audit: Audit::default(),
            sizes: Sizes::default(),
            cutbacks: Vec::new(),
            status_changes: Vec::new(),
        }
    }

    /// The writer, to be finished, and what was seen.
    pub fn finish(self) -> (ResultWriter, Followed) {
        let Self { writer, audit, sizes, cutbacks, status_changes, .. } = self;
        (writer, Followed { audit: audit.findings(), sizes, cutbacks, status_changes })
    }
}

impl Watch for Monitor<'_> {
    fn increment(&mut self, simulation: &Simulation, report: &IncrementReport) {
        self.sizes.take(report);
        self.status_changes.extend(status_changes(simulation.prepared(), report));
        self.audit.take(simulation.audit(), &format!("step {}, increment {}", report.step, report.increment));
        let solving = self.clock.enter(Stage::WRITE);
        self.writer.increment(simulation, report);
        self.clock.enter(solving);
        self.progress.increment(report, report.time / self.time_end);
    }

    fn cutback(&mut self, _: &Simulation, report: &CutbackReport) {
        self.cutbacks.push(report.into());
    }

    fn cancelled(&self) -> bool {
        self.stop.load(Ordering::SeqCst) || self.writer.cancelled()
    }
}

/// Smallest and largest increment by step number.
#[derive(Default)]
pub struct Sizes(BTreeMap<u32, (f64, f64)>);

impl Sizes {
    fn take(&mut self, report: &IncrementReport) {
        let size = report.increment_size;
        let (min, max) = self.0.entry(report.step).or_insert((size, size));
        *min = size.min(*min);
        *max = size.max(*max);
    }

    /// Enters them into the summaries of all steps, in order.
    pub fn enter(&self, mut steps: Vec<StepSummary>) -> Vec<StepSummary> {
        for (number, step) in (1..).zip(&mut steps) {
            (step.increment_min, step.increment_max) = self.0.get(&number).copied().unzip();
        }
        steps
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
