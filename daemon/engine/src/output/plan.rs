//! What the output requests of a step ask for at one increment.

use super::due::{Moment, Span};
use crate::model::{ContactRequest, ElementRequest, NodeRequest, OutputTarget, Procedure, SetId, Step, Totals};
use crate::simulation::IncrementReport;

/// What to write at an increment.
#[derive(Debug, PartialEq)]
pub(super) struct Plan<'a> {
    /// Rows of the history and of the port table.
    pub history: bool,
    /// Rows of the contact table.
    pub contact_rows: bool,
    /// A frame for ParaView.
    pub frame: bool,
    /// Sets whose nodes get rows in the node table, in the order of the requests.
    pub node_rows: Vec<SetId>,
    /// Printed nodal tables.
    pub node_prints: Vec<&'a NodeRequest>,
    /// Printed stress tables.
    pub element_prints: Vec<&'a ElementRequest>,
    /// Printed contact tables.
    pub contact_prints: Vec<&'a ContactRequest>,
    /// Nodal records of the results file.
    pub node_files: Vec<&'a NodeRequest>,
    /// Element records of the results file.
    pub element_files: Vec<&'a ElementRequest>,
    /// Contact records of the results file.
    pub contact_files: Vec<&'a ContactRequest>,
    /// Whether the contact log of the increment is printed for itself. In explicit steps it stands with the tables alone.
    pub contact_log: bool,
    /// Whether the increment ends its step, or the run.
    pub end: bool,
}

impl<'a> Plan<'a> {
    /// What `step` asks for at one of its increments.
    pub(super) fn new(step: &'a Step, report: &IncrementReport, moment: Moment) -> Self {
        let requests = &step.output;
        let span = Span::of(step, report);
        let due = |frequency| span.is_due(frequency, moment);
        let of_fields =
            |(target, frequency)| matches!(target, OutputTarget::Field | OutputTarget::File).then_some(frequency);
        let fields = (requests.nodes.iter().map(|r| (r.target, r.frequency)))
            .chain(requests.elements.iter().map(|r| (r.target, r.frequency)))
            .chain(requests.contacts.iter().map(|r| (r.target, r.frequency)))
            .filter_map(of_fields);
        let explicit = matches!(step.procedure, Procedure::Explicit(_));
        let history = match explicit && !requests.history.is_empty() {
            true => moment == Moment::LastOfStep || span.any_due(requests.history.iter().copied(), moment),
            false => moment != Moment::Stopped,
        };
        let mut node_rows = Vec::new();
        for request in requests.nodes.iter().filter(|r| due(r.frequency) && r.totals != Totals::Only) {
            if let Some(set) = request.set
                && !node_rows.contains(&set)
            {
                node_rows.push(set);
            }
        }
        let nodes = |to| requests.nodes.iter().filter(|r| r.target == to && due(r.frequency)).collect();
        let elements = |to| requests.elements.iter().filter(|r| r.target == to && due(r.frequency)).collect();
        let contacts = |to| requests.contacts.iter().filter(|r| r.target == to && due(r.frequency)).collect();
        Self {
            history,
            contact_rows: span.any_due(requests.contacts.iter().map(|r| r.frequency), moment),
            frame: span.any_due(fields, moment),
            node_rows,
            node_prints: nodes(OutputTarget::Print),
            element_prints: elements(OutputTarget::Print),
            contact_prints: contacts(OutputTarget::Print),
            node_files: nodes(OutputTarget::File),
            element_files: elements(OutputTarget::File),
            contact_files: contacts(OutputTarget::File),
            contact_log: !explicit && !report.status_changes.is_empty(),
            end: moment != Moment::Within,
        }
    }

    /// Whether nothing is due.
    pub(super) fn is_empty(&self) -> bool {
        let Self { history, contact_rows, frame, node_rows, contact_log, end, .. } = self;
        let tables = [self.node_prints.len(), self.element_prints.len(), self.contact_prints.len()];
        let records = [self.node_files.len(), self.element_files.len(), self.contact_files.len()];
        let lists = tables.into_iter().chain(records).chain([node_rows.len()]).sum::<usize>();
        !history && !contact_rows && !frame && !contact_log && !end && lists == 0
    }

    /// Whether nodal values are needed.
    pub(super) fn needs_solution(&self) -> bool {
        self.needs_stress()
            || !self.node_rows.is_empty()
            || !self.node_files.is_empty()
            || self.node_prints.iter().any(|r| r.totals != Totals::Only)
    }

    /// Whether values of single elements are needed.
    pub(super) fn needs_elements(&self) -> bool {
        !self.element_prints.is_empty() || !self.element_files.is_empty()
    }

    /// Whether stresses are needed.
    pub(super) fn needs_stress(&self) -> bool {
        self.frame || self.needs_elements()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Place;
    use crate::model::{ExplicitControl, ExplicitIncrements, OutputFrequency, OutputRequests, StaticControl};

    fn step(output: OutputRequests) -> Step {
        let control = StaticControl {
            increment_initial: 0.1,
            period: 1.0,
            increment_min: 1e-5,
            increment_max: 1.0,
            direct: true,
        };
        Step {
            name: "Step-1".into(),
            increments_max: 100,
            procedure: Procedure::Static(control),
            default_amplitude: Default::default(),
            boundaries: Vec::new(),
            loads: Vec::new(),
            loads_removed: Default::default(),
            contact: Default::default(),
            output,
            place: Place::nowhere(),
        }
    }

    /// An increment of a tenth of the step.
    fn tenth(increment: u32) -> IncrementReport {
        let step_time = 0.1 * f64::from(increment);
        IncrementReport { step: 1, increment, step_time, increment_size: 0.1, ..Default::default() }
    }

    fn nodes(target: OutputTarget, set: Option<SetId>, every: u32, totals: Totals) -> NodeRequest {
        let frequency = OutputFrequency::Increments(every);
        NodeRequest { target, set, variables: vec!["U".into()], frequency, totals, summary: true }
    }

    #[test]
    fn a_silent_step_writes_contact_and_frame_once_at_its_end() {
        let step = step(OutputRequests::default());
        for (moment, expected) in [(Moment::Within, false), (Moment::LastOfStep, true), (Moment::Stopped, true)] {
            let plan = Plan::new(&step, &tenth(3), moment);
            assert_eq!((plan.contact_rows, plan.frame), (expected, expected), "{moment:?}");
        }
    }

    #[test]
    fn frequency_counts_increments_and_the_last_is_always_written() {
        let request = nodes(OutputTarget::Field, Some(SetId(2)), 5, Totals::No);
        let step = step(OutputRequests { nodes: vec![request], ..Default::default() });
        for (increment, moment, expected) in [
            (4, Moment::Within, false),
            (5, Moment::Within, true),
            (7, Moment::LastOfStep, true),
            (5, Moment::Stopped, false),
            (7, Moment::Stopped, true),
        ] {
            let plan = Plan::new(&step, &tenth(increment), moment);
            assert_eq!(plan.frame, expected, "{increment} {moment:?}");
            assert_eq!(plan.node_rows, if expected { vec![SetId(2)] } else { vec![] });
        }
    }

    #[test]
    fn frequency_zero_never_writes() {
        let request = nodes(OutputTarget::Field, None, 0, Totals::No);
        let step = step(OutputRequests { nodes: vec![request], ..Default::default() });
        for moment in [Moment::Within, Moment::LastOfStep, Moment::Stopped] {
            assert!(!Plan::new(&step, &tenth(1), moment).frame, "{moment:?}");
        }
    }

    #[test]
    fn totals_alone_need_no_recovery() {
        let request = nodes(OutputTarget::Print, Some(SetId(0)), 1, Totals::Only);
        let step = step(OutputRequests { nodes: vec![request], ..Default::default() });
        let plan = Plan::new(&step, &tenth(1), Moment::Within);
        assert_eq!(plan.node_prints.len(), 1);
        assert!(!plan.needs_solution());
    }

    #[test]
    fn the_history_has_every_increment_unless_an_explicit_step_asks_for_fewer() {
        let control = ExplicitControl {
            period: 1.0,
            increments: ExplicitIncrements::Direct(0.1),
            increment_max: None,
            bulk_viscosity: [0.06, 1.2],
            mass_scaling: Vec::new(),
        };
        let rows = |procedure: Procedure, history: &[OutputFrequency]| -> Vec<u32> {
            let step = Step { procedure, ..step(OutputRequests { history: history.to_vec(), ..Default::default() }) };
            (1..=10)
                .filter(|&k| {
                    let moment = if k == 10 { Moment::LastOfStep } else { Moment::Within };
                    Plan::new(&step, &tenth(k), moment).history
                })
                .collect()
        };
        let (thirds, fourth) = (OutputFrequency::Intervals(3), OutputFrequency::Increments(4));
        let explicit = || Procedure::Explicit(control.clone());
        assert_eq!(rows(explicit(), &[]), (1..=10).collect::<Vec<_>>());
        assert_eq!(rows(explicit(), &[thirds]), [4, 7, 10]);
        assert_eq!(rows(explicit(), &[thirds, fourth]), [4, 7, 8, 10]);
        assert_eq!(rows(explicit(), &[OutputFrequency::Increments(0)]), [10]);
        let implicit = step(OutputRequests::default()).procedure;
        assert_eq!(rows(implicit, &[thirds]).len(), 10);
    }
}
