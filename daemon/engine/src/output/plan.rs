//! What the output requests of a step ask for at one increment.

use crate::model::{ContactRequest, ElementRequest, NodeRequest, OutputTarget, SetId, Step, Totals};

/// When the question is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Moment {
    /// At an increment with others to follow.
    Within,
    /// At the last increment of a step: every request is due.
    LastOfStep,
    /// After the last increment of a run that stopped: what is due at a last increment and was not due before.
    Stopped,
}

/// What to write at an increment.
#[derive(Debug, PartialEq)]
pub(super) struct Plan<'a> {
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
    /// Whether the increment ends its step, or the run.
    pub end: bool,
}

impl<'a> Plan<'a> {
    /// What `step` asks for at the increment with this number (from 1).
    pub(super) fn new(step: &'a Step, increment: u32, moment: Moment) -> Self {
        let requests = &step.output;
        let due = |frequency: u32| is_due(frequency, increment, moment);
        let fields: Vec<u32> = requests
            .nodes
            .iter()
            .map(|r| (r.target, r.frequency))
            .chain(requests.elements.iter().map(|r| (r.target, r.frequency)))
            .chain(requests.contacts.iter().map(|r| (r.target, r.frequency)))
            .filter(|(target, _)| matches!(target, OutputTarget::Field | OutputTarget::File))
            .map(|(_, frequency)| frequency)
            .collect();
        let contact_frequencies: Vec<u32> = requests.contacts.iter().map(|r| r.frequency).collect();
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
            contact_rows: any_due(&contact_frequencies, increment, moment),
            frame: any_due(&fields, increment, moment),
            node_rows,
            node_prints: nodes(OutputTarget::Print),
            element_prints: elements(OutputTarget::Print),
            contact_prints: contacts(OutputTarget::Print),
            node_files: nodes(OutputTarget::File),
            element_files: elements(OutputTarget::File),
            contact_files: contacts(OutputTarget::File),
            end: moment != Moment::Within,
        }
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

fn is_due(frequency: u32, increment: u32, moment: Moment) -> bool {
    let regular = frequency != 0 && increment.is_multiple_of(frequency);
    match moment {
        Moment::Within => regular,
        Moment::LastOfStep => frequency != 0,
        Moment::Stopped => frequency != 0 && !regular,
    }
}

/// Whether something that several requests share is due. A step that does not mention it gets it once, at its end.
fn any_due(frequencies: &[u32], increment: u32, moment: Moment) -> bool {
    let regular = frequencies.iter().any(|&f| is_due(f, increment, Moment::Within));
    let wanted = frequencies.is_empty() || frequencies.iter().any(|&f| f != 0);
    match moment {
        Moment::Within => regular,
        Moment::LastOfStep => wanted,
        Moment::Stopped => wanted && !regular,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Place;
    use crate::model::{OutputRequests, Procedure, StaticControl};

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
            boundaries: Vec::new(),
            loads: Vec::new(),
            loads_removed: Default::default(),
            contact: Default::default(),
            output,
            place: Place::nowhere(),
        }
    }

    fn nodes(target: OutputTarget, set: Option<SetId>, frequency: u32, totals: Totals) -> NodeRequest {
        NodeRequest { target, set, variables: vec!["U".into()], frequency, totals, summary: true }
    }

    #[test]
    fn a_silent_step_writes_contact_and_frame_once_at_its_end() {
        let step = step(OutputRequests::default());
        for (moment, expected) in [(Moment::Within, false), (Moment::LastOfStep, true), (Moment::Stopped, true)] {
            let plan = Plan::new(&step, 3, moment);
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
            let plan = Plan::new(&step, increment, moment);
            assert_eq!(plan.frame, expected, "{increment} {moment:?}");
            assert_eq!(plan.node_rows, if expected { vec![SetId(2)] } else { vec![] });
        }
    }

    #[test]
    fn frequency_zero_never_writes() {
        let request = nodes(OutputTarget::Field, None, 0, Totals::No);
        let step = step(OutputRequests { nodes: vec![request], ..Default::default() });
        for moment in [Moment::Within, Moment::LastOfStep, Moment::Stopped] {
            assert!(!Plan::new(&step, 1, moment).frame, "{moment:?}");
        }
    }

    #[test]
    fn totals_alone_need_no_recovery() {
        let request = nodes(OutputTarget::Print, Some(SetId(0)), 1, Totals::Only);
        let step = step(OutputRequests { nodes: vec![request], ..Default::default() });
        let plan = Plan::new(&step, 1, Moment::Within);
        assert_eq!(plan.node_prints.len(), 1);
        assert!(!plan.needs_solution());
    }
}
