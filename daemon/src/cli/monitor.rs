//! Follows a run: writes results, shows progress, carries the wish to stop.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};

use overclosure::model::Procedure;
use overclosure::output::{
    CutbackSummary, ResultWriter, StableIncrement, StatusChangeSummary, StepSummary, status_changes,
};
use overclosure::simulation::{CutbackReport, IncrementReport, Simulation, Watch};

use super::clock::{Clock, Stage};
use super::increments::Row;
use super::progress::Progress;

/// Most status changes that a report tells one by one: explicit contact may chatter for a million increments.
const STATUS_CHANGES_MAX: usize = 50_000;
/// In explicit steps one increment of so many is audited, and the last one.
const EXPLICIT_AUDIT: u32 = 64;

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
    status_changes_omitted: u64,
    /// The last increment, if it was not audited.
    unaudited: Option<(u32, u32)>,
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
    /// Changes that are not in it, for there were too many.
    pub status_changes_omitted: u64,
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
            status_changes_omitted: 0,
            unaudited: None,
        }
    }

    /// The writer, to be finished, and what was seen; `simulation` stands where the run ended.
    pub fn finish(mut self, simulation: &Simulation) -> (ResultWriter, Followed) {
        if let Some((step, increment)) = self.unaudited {
            self.audit.take(simulation.audit(), step, increment);
        }
        let Self { writer, audit, sizes, cutbacks, status_changes, status_changes_omitted, .. } = self;
        (writer, Followed { audit: audit.findings(), sizes, cutbacks, status_changes, status_changes_omitted })
    }

    fn log(&mut self, simulation: &Simulation, report: &IncrementReport) {
        let room = STATUS_CHANGES_MAX.saturating_sub(self.status_changes.len());
        if report.status_changes.len() <= room {
            self.status_changes.extend(status_changes(simulation.prepared(), report));
        } else {
            self.status_changes_omitted += report.status_changes.len() as u64;
        }
    }
}

impl Watch for Monitor<'_> {
    fn increment(&mut self, simulation: &Simulation, report: &IncrementReport) {
        self.sizes.take(report);
        self.log(simulation, report);
        let step = &simulation.prepared().model().steps[report.step as usize - 1];
        let audited =
            !matches!(step.procedure, Procedure::Explicit(_)) || report.increment.is_multiple_of(EXPLICIT_AUDIT);
        self.unaudited = (!audited).then_some((report.step, report.increment));
        if audited {
            self.audit.take(simulation.audit(), report.step, report.increment);
        }
        let solving = self.clock.enter(Stage::WRITE);
        self.writer.increment(simulation, report);
        self.clock.enter(solving);
        self.progress.increment(Row::new(simulation, report), report.time / self.time_end);
    }

    fn cutback(&mut self, _: &Simulation, report: &CutbackReport) {
        self.cutbacks.push(report.into());
    }

    fn cancelled(&self) -> bool {
        self.stop.load(Ordering::SeqCst) || self.writer.cancelled()
    }
}

/// Smallest and largest increment by step number, and what was stable.
#[derive(Default)]
pub struct Sizes(BTreeMap<u32, Extremes>);

struct Extremes {
    min: f64,
    max: f64,
    stable: Option<StableIncrement>,
}

impl Sizes {
    fn take(&mut self, report: &IncrementReport) {
        let size = report.increment_size;
        let seen = self.0.entry(report.step).or_insert(Extremes { min: size, max: size, stable: None });
        (seen.min, seen.max) = (size.min(seen.min), size.max(seen.max));
        if let Some(last) = report.stable_increment {
            let before = seen.stable.unwrap_or(StableIncrement { first: last, min: last, last });
            seen.stable = Some(StableIncrement { min: last.min(before.min), last, ..before });
        }
    }

    /// Enters them into the summaries of all steps, in order.
    pub fn enter(&self, mut steps: Vec<StepSummary>) -> Vec<StepSummary> {
        for (number, step) in (1..).zip(&mut steps) {
            let Some(seen) = self.0.get(&number) else { continue };
            (step.increment_min, step.increment_max) = (Some(seen.min), Some(seen.max));
            step.stable_increment = seen.stable;
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
    fn take(&mut self, findings: Vec<String>, step: u32, increment: u32) {
        for finding in findings {
            match self.kinds.iter_mut().find(|kind| wording(&kind.first) == wording(&finding)) {
                Some(kind) => kind.increments += 1,
                None => {
                    let place = format!("step {step}, increment {increment}");
                    self.kinds.push(Kind { first: finding, place, increments: 1 });
                }
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
        audit.take(vec!["tension at 3 contact points: node 1".into()], 1, 1);
        audit.take(vec!["tension at 12 contact points: node 2".into(), "overlap: node 4".into()], 1, 2);
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
