//! The contact log: every change of status with its point, by name and number.

use serde::Serialize;

use crate::simulation::{ContactStatus, IncrementReport, PreparedModel, StatusChange};

/// A contact point that changed status in an increment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StatusChangeSummary {
    /// Step number, from 1.
    pub step: u32,
    /// Increment in which it changed, from 1.
    pub increment: u32,
    /// Total time at the end of the increment.
    pub time: f64,
    /// Name of the contact pair.
    pub pair: String,
    /// Number of the secondary node.
    pub node: u32,
    /// Status at the start of the increment.
    pub from: ContactStatus,
    /// Status at its end.
    pub to: ContactStatus,
}

/// The changes of an increment, in the order of the contact points.
pub fn status_changes(prepared: &PreparedModel, report: &IncrementReport) -> Vec<StatusChangeSummary> {
    let model = prepared.model();
    let told = |change: &StatusChange| {
        let point = &prepared.contact_points()[change.point as usize];
        StatusChangeSummary {
            step: report.step,
            increment: report.increment,
            time: report.time,
            pair: model.pairs[point.pair as usize].name.clone(),
            node: model.mesh.node_labels[point.node.index()],
            from: change.from,
            to: change.to,
        }
    };
    report.status_changes.iter().map(told).collect()
}
